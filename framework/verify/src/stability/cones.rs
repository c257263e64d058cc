//! Closure, equilibrium, or holding within efforts, of contacts whose cones the plan records one by one:
//! elliptic ones as they are where all of a grasp are elliptic, otherwise cones of edges, and elliptic ones
//! by edges inside them; holding is always looked at by edges.
//!
//! The edges' wrenches span all of space positively, which is closure, exactly if they have rank 6 and some
//! positive combination of all of them is zero (A. J. Goldman, A. W. Tucker, "Polyhedral convex cones",
//! 1956). Such a combination is a proof that arithmetic can check, whoever found it.

use super::edge_hold::EdgeHold;
use super::edges::{Edges, exerted};
use super::force::{self, Contact};
use super::held::Row;
use super::load::LoadCheck;
use super::{edge_load, socp};
use crate::hand::Chains;
use crate::touch::Touch;
use crate::track::{Frames, Leg};
use crate::verdict::{Check, Gauge, Side};
use nalgebra::{Cholesky, DVector, Matrix6, Vector6};
use regrasp_api::{Cone, MAX_FINGERS, Rotation, Vec3};
use regrasp_plan::{Claims, ConeRecord, Criterion, Extreme, HoldsAt, Place};

/// The least share of an edge in a proof, the shares of all summing to 1.
const LEAST_SHARE: f64 = 1e-8;
/// The least singular value of the edges' wrenches that counts as rank 6.
const LEAST_SINGULAR: f64 = 1e-6;
/// The part of the solver's least share below which carried shares are no longer taken.
const DWINDLED: f64 = 0.4;
/// Grasps of a stretch not proved stable after which no more are looked at: the plan is refused anyway.
const MOST_FAILURES: usize = 20;

/// Follows the grasp along the plan, state by state: between two of them no cones are recorded.
pub(crate) struct ConesCheck {
    gauge: Gauge,
    cones: Vec<Cone<'static>>,
    center_O: Vec3,
    length: f64,
    /// The last shares, and the least of those that the solver found when it was last asked.
    carried: Option<(Vec<f64>, f64)>,
    /// The same where all cones of the grasp are round.
    carried_round: Option<(force::Proof, f64)>,
    /// The smallest margin.
    worst: Option<Extreme>,
    failures: usize,
    /// What must be held where the plan claims equilibrium, not closure.
    load: Option<LoadCheck>,
    /// What must be held within the joints' efforts where the plan claims that.
    hold: Option<EdgeHold>,
}

impl ConesCheck {
    /// `None` where the plan records no cones; for an object of this weight (N, in H).
    pub(crate) fn new(claims: &Claims, weight_H: Vec3) -> Option<Self> {
        let cones = &claims.contact.cones;
        if claims.contact.cone.is_some() || cones.is_empty() {
            return None;
        }
        let mut gauge = Gauge::new("stability", "share", Side::Above, LEAST_SHARE);
        let (mut load, mut hold, length) = (None, None, claims.margin.length);
        match &claims.criterion {
            Criterion::Closure => {}
            Criterion::Equilibrium(claimed) => load = Some(LoadCheck::new(claimed, weight_H, length)?),
            Criterion::Holding(claimed) => {
                hold = EdgeHold::new(claimed, weight_H, length);
                if hold.is_none() {
                    let note = Some("the claimed criterion has no meaning".into());
                    gauge.note(f64::NAN, || Place { note, ..Default::default() });
                }
            }
            _ => return None,
        }
        Some(Self {
            gauge,
            cones: cones.iter().map(ConeRecord::cone).collect(),
            center_O: claims.margin.center_O.into(),
            length: claims.margin.length,
            carried: None,
            carried_round: None,
            worst: None,
            failures: 0,
            load,
            hold,
        })
    }

    /// Takes in a state with where everything is and the contacts of the fingers that hold there.
    pub(crate) fn state(
        &mut self,
        (leg, state): (&Leg<'_>, usize),
        hand: &Chains,
        frames: &Frames,
        touches: &[Option<Touch>; MAX_FINGERS],
    ) {
        let R_HO = &frames.X_HO.rotation;
        if self.failures >= MOST_FAILURES {
            return;
        }
        let Some(held) = self.held(leg, state, touches) else {
            let note = Some("a contact without a recorded cone".into());
            return self.gauge.note(f64::NAN, || Place { note, ..leg.at(state) });
        };
        if self.load.is_some() {
            return self.state_load(leg, state, R_HO, &held);
        }
        if let Some(share) = self.hold.as_ref().map(EdgeHold::friction_factor) {
            let edges = self.edges(&held, share, hand, frames);
            let found = self.hold.as_mut().map_or(Err(0.0), |hold| hold.prove(&edges, R_HO));
            self.failures += usize::from(found.is_err());
            return self.gauge.note(found.unwrap_or_else(|slack| slack), || leg.at(state));
        }
        let found = match self.round(&held) {
            Some(contacts) => self.prove_round(&contacts),
            None => self.prove(&self.columns(&held).concat()).map(|proof| (proof.least, proof.margin())),
        };
        match found {
            Some((room, margin)) => {
                self.gauge.note(room, || leg.at(state));
                if self.worst.as_ref().is_none_or(|worst| margin < worst.value) {
                    self.worst = Some(Extreme::new(margin, leg.at(state), HoldsAt::EveryState));
                }
            }
            None => {
                self.failures += 1;
                self.gauge.note(0.0, || leg.at(state));
                self.worst = Some(Extreme::new(0.0, leg.at(state), HoldsAt::EveryState));
            }
        }
    }

    /// Whether the contacts hold the claimed load; closure margins do not apply.
    fn state_load(
        &mut self,
        leg: &Leg<'_>,
        state: usize,
        R_HO: &Rotation,
        held: &[(usize, Touch, Cone<'_>)],
    ) {
        let (round, columns) = (self.round(held), self.columns(held));
        let Some(load) = &mut self.load else { return };
        let found = match round {
            Some(contacts) => load.prove(&contacts, R_HO),
            None => edge_load::prove(&columns, load, R_HO),
        };
        self.failures += usize::from(found.is_err());
        self.gauge.note(found.unwrap_or_else(|slack| slack), || leg.at(state));
    }

    /// The fingers that hold, with contacts and cones; `None` where one has no cone.
    fn held(
        &self,
        leg: &Leg<'_>,
        state: usize,
        touches: &[Option<Touch>; MAX_FINGERS],
    ) -> Option<Vec<(usize, Touch, Cone<'static>)>> {
        let numbers = leg.states[state].record.cones.as_ref()?;
        let holding = touches.iter().enumerate().filter(|&(finger, _)| leg.moving != Some(finger));
        let with_cone = |(finger, touch): (usize, Touch)| {
            let cone = self.cones.get((*numbers.get(finger)?)?)?;
            // Contacts may spin in a transfer, and a spinning contact transmits no torsion.
            let cone = if leg.moving.is_some() { cone.clone() } else { cone.without_torsion() };
            Some((finger, touch, cone))
        };
        holding.filter_map(|(finger, touch)| Some((finger, (*touch)?))).map(with_cone).collect()
    }

    /// The contacts, where all their cones are round.
    fn round(&self, held: &[(usize, Touch, Cone<'_>)]) -> Option<Vec<Contact>> {
        let contact = |(_, touch, cone): &(usize, Touch, Cone<'_>)| {
            Contact::new((touch.p_OC - self.center_O) / self.length, -touch.n_O, cone, self.length)
        };
        held.iter().map(contact).collect()
    }

    /// Slack and margin of round contacts, from the carried force, else (or where its slack has dwindled)
    /// from the solver's.
    fn prove_round(&mut self, contacts: &[Contact]) -> Option<(f64, f64)> {
        let carried = self.carried_round.take().and_then(|(proof, solved)| {
            let proof = force::prove(contacts, &proof.forces)?;
            (proof.slack > DWINDLED * solved).then_some((proof, solved))
        });
        let (proof, solved) = match carried {
            Some(carried) => carried,
            None => super::best(contacts).map(|proof| (proof, proof.slack)).ok()?,
        };
        self.carried_round = Some((proof, solved));
        Some((proof.slack, force::margin(contacts, &proof)))
    }

    /// The wrenches of each contact's edges, torques over the length.
    fn columns(&self, held: &[(usize, Touch, Cone<'_>)]) -> Vec<Vec<Vector6<f64>>> {
        let columns = |(_, touch, cone): &(usize, Touch, Cone<'_>)| {
            exerted(touch, cone, 1.0).iter().map(|edge| self.wrench(touch, edge)).collect()
        };
        held.iter().map(columns).collect()
    }

    /// The wrench of a force and a torque about the inward normal at a contact, torques over the length.
    fn wrench(&self, touch: &Touch, (f, torsion): &(Vec3, f64)) -> Vector6<f64> {
        let r = (touch.p_OC - self.center_O) / self.length;
        let m = r.cross(f) - touch.n_O * (torsion / self.length);
        Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
    }

    /// Each contact's edges at this share of the friction, with the joints behind it.
    fn edges(
        &self,
        held: &[(usize, Touch, Cone<'_>)],
        share: f64,
        hand: &Chains,
        frames: &Frames,
    ) -> Vec<Edges> {
        let contact = |(finger, touch, cone): &(usize, Touch, Cone<'_>)| {
            let edges = exerted(touch, cone, share);
            let rows = hand.rows(*finger, frames, &touch.p_OC, &-touch.n_O);
            let effort = |row: &Row| {
                let of = |(f, torsion): &(Vec3, f64)| (row.column_O.dot(f) + row.spin * torsion) / row.limit;
                DVector::from_iterator(edges.len(), edges.iter().map(of))
            };
            let columns = edges.iter().map(|edge| self.wrench(touch, edge)).collect();
            Edges { columns, efforts: rows.iter().map(effort).collect() }
        };
        held.iter().map(contact).collect()
    }

    /// A proof from the carried shares, else (or where they have dwindled) from the solver's.
    fn prove(&mut self, columns: &[Vector6<f64>]) -> Option<Proof> {
        if let Some((shares, solved)) = &self.carried
            && let Some(proof) = prove(columns, shares)
            && proof.least > DWINDLED * solved
        {
            self.carried = Some((proof.shares.clone(), *solved));
            return Some(proof);
        }
        self.carried = None;
        let proof = prove(columns, &socp::best_shares(columns)?)?;
        self.carried = Some((proof.shares.clone(), proof.least));
        Some(proof)
    }

    /// Takes in what was gathered later in the plan.
    pub(crate) fn join(&mut self, later: Self) {
        self.gauge.join(later.gauge);
        let is_worse = |later: &Extreme| self.worst.as_ref().is_none_or(|worst| later.value < worst.value);
        if later.worst.as_ref().is_some_and(is_worse) {
            self.worst = later.worst;
        }
    }

    /// The smallest margin, for the certificate.
    pub(crate) fn extreme(&self) -> Option<Extreme> {
        self.worst.clone()
    }

    pub(crate) fn check(self) -> Check {
        self.gauge.check()
    }
}

/// Shares of the edges, which balance.
struct Proof {
    shares: Vec<f64>,
    least: f64,
    /// A lower bound of the wrenches' smallest singular value.
    singular: f64,
}

impl Proof {
    /// A lower bound of the closure margin Q1 = min over |w| = 1 of the largest power a_j = w·W_j of an edge.
    ///
    /// The shares λ balance, so the powers above zero, weighted, sum to as much as those below, and that is
    /// at most max a_j: Σ λ |a| ≤ 2 max a. And Σ λ |a| ≥ min λ · |Wᵀw| ≥ min λ · σ_min(W).
    fn margin(&self) -> f64 {
        0.5 * self.least * self.singular
    }
}

/// Brings shares to balance by the smallest correction, and checks them.
fn prove(columns: &[Vector6<f64>], shares: &[f64]) -> Option<Proof> {
    if shares.len() != columns.len() {
        return None;
    }
    let gram: Matrix6<f64> = columns.iter().map(|column| column * column.transpose()).sum();
    let factor = Cholesky::new(gram)?;
    let singular = 1.0 / factor.inverse().norm().sqrt();
    let sum_of = |shares: &[f64]| -> Vector6<f64> {
        columns.iter().zip(shares).map(|(column, share)| column * *share).sum()
    };
    let correction = factor.solve(&sum_of(shares));
    let mut shares: Vec<f64> =
        columns.iter().zip(shares).map(|(column, share)| share - column.dot(&correction)).collect();
    let total: f64 = shares.iter().sum();
    if !(singular >= LEAST_SINGULAR && total > 0.0 && total.is_finite()) {
        return None;
    }
    shares.iter_mut().for_each(|share| *share /= total);
    let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
    // What balances the residual exactly is smaller than residual/singular, and must leave no share at zero.
    let proved = least >= LEAST_SHARE && sum_of(&shares).norm() <= 0.5 * singular * least;
    proved.then_some(Proof { shares, least, singular })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::edges::edges;
    use regrasp_api::tangents;

    /// Contacts round the equator of a unit ball, each with a cone of this grain.
    fn columns(count: usize, mu: [f64; 2]) -> Vec<Vector6<f64>> {
        let contact = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
            let n_O = Vec3::new(cos, sin, 0.0);
            let cone = Cone::grained(&Vec3::z(), mu, 0.0);
            let [t1, t2] = tangents(&-n_O);
            edges(&cone, &-n_O)
                .into_iter()
                .map(move |edge| {
                    let f = -n_O + t1 * edge.tangential[0] + t2 * edge.tangential[1];
                    let m = n_O.cross(&f);
                    Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
                })
                .collect::<Vec<_>>()
        };
        (0..count).flat_map(contact).collect()
    }

    fn closes(columns: &[Vector6<f64>]) -> Option<f64> {
        Some(prove(columns, &socp::best_shares(columns)?)?.margin())
    }

    #[test]
    fn a_ball_is_held_where_friction_holds_it_along_and_across_the_equator() {
        let margin = closes(&columns(3, [0.6, 0.4])).expect("three fingers close a ball");
        // No margin exceeds the power of any one wrench.
        assert!(margin > 0.0 && margin < 1.0, "{margin}");
        // Without friction along the axis nothing pushes the ball up, without the other nothing turns it.
        assert!(closes(&columns(3, [0.0, 0.4])).is_none());
        assert!(closes(&columns(3, [0.6, 0.0])).is_none());
        assert!(closes(&columns(1, [0.6, 0.4])).is_none());
    }

    #[test]
    fn a_grain_is_taken_exactly() {
        let contacts = |mu: [f64; 2]| -> Vec<Contact> {
            let contact = |k: usize| {
                let (sin, cos) = (std::f64::consts::TAU * k as f64 / 3.0).sin_cos();
                let n_O = Vec3::new(cos, sin, 0.0);
                Contact::new(n_O, -n_O, &Cone::grained(&Vec3::z(), mu, 0.0), 1.0)
            };
            (0..3).filter_map(contact).collect()
        };
        for mu in [[0.6, 0.4], [0.4, 0.6], [0.5, 0.5]] {
            let contacts = contacts(mu);
            let proof = super::super::best(&contacts).expect("three fingers close a ball");
            let exact = force::margin(&contacts, &proof);
            let inside = closes(&columns(3, mu)).expect("so do edges inside");
            assert!(exact >= 0.9 * inside && exact > 0.0, "{exact} {inside}");
            // Each force is within the ellipse.
            for (contact, force) in contacts.iter().zip(&proof.forces) {
                let f = contact.stretch(&force.tangential);
                let share = (f.z / mu[0]).hypot((f - Vec3::z() * f.z).norm() / mu[1]);
                assert!(share <= force.normal + 1e-12, "{share} {}", force.normal);
            }
        }
        assert!(super::super::best(&contacts([0.6, 0.0])).is_err());
        assert!(super::super::best(&contacts([0.0, 0.6])).is_err());
    }

    #[test]
    fn the_margin_is_below_every_sampled_power() {
        let columns = columns(4, [0.7, 0.3]);
        let margin = closes(&columns).expect("four fingers close a ball");
        let mut random = regrasp_api::Random::from_key(1, 0, 0, 0);
        for _ in 0..2000 {
            let (a, b) = (random.direction(), random.direction());
            let w = Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z) / std::f64::consts::SQRT_2;
            let power = columns.iter().map(|column| column.dot(&w)).fold(f64::NEG_INFINITY, f64::max);
            assert!(power >= margin, "{power} {margin}");
        }
    }

    #[test]
    fn shares_that_do_not_balance_prove_nothing() {
        let columns = columns(2, [0.6, 0.4]);
        // Two fingers alone leave the ball free to turn about the line between them.
        assert!(closes(&columns).is_none());
        assert!(prove(&columns, &vec![1.0; columns.len() - 1]).is_none());
    }
}
