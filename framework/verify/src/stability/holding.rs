//! Forces within the joints' efforts that hold the object's weight and a load, at a share of the friction: a
//! proof by arithmetic.

use super::force::{Contact, Correction, Forces, LEAST_SLACK, scaled};
use super::held::Held;
use super::load::icosahedron;
use super::response::{Response, Shares};
use super::room::share_of;
use super::socp;
use crate::hand::Chains;
use crate::touch::Touch;
use crate::track::{Frames, Leg, SAMPLES};
use crate::verdict::{Check, Gauge, Side};
use nalgebra::Vector6;
use regrasp_api::{HoldLoad, MAX_FINGERS, Vec3};
use regrasp_plan::{Claims, ConeClaim, Place};

/// Grasps of a stretch not proved to hold after which no more are looked at: the plan is refused anyway.
const MOST_FAILURES: usize = 20;
/// The part of the solver's slack below which carried forces are no longer taken.
const DWINDLED: f64 = 0.4;

/// Follows the forces that hold the object along a plan that claims that they do.
pub(crate) struct HoldingCheck {
    gauge: Gauge,
    load: HoldLoad,
    cone: ConeClaim,
    /// The claimed torsional radius (m), of which contacts drag a part.
    torsion: f64,
    weight_H: Vec3,
    center_O: Vec3,
    length: f64,
    /// What forces are divided by (N).
    unit: f64,
    /// One for each way in which the contacts may drag.
    trails: Vec<Trail>,
    failures: usize,
    last: Option<(Held, Vec3)>,
}

/// What is carried from one grasp to the next: forces, and the slack that the solver found when it was last
/// asked.
#[derive(Clone, Default)]
struct Trail {
    carried: Option<Vec<Forces>>,
    solved: f64,
}

/// A grasp with what is worked out once for all that it must hold.
struct Grasp<'h> {
    held: &'h Held,
    /// For each contact and joint behind it, see [`HoldingCheck::shares`].
    shares: Shares,
    correction: Correction,
}

impl Grasp<'_> {
    /// How fast an effort's share grows with a force, at most.
    fn steepest(&self) -> f64 {
        let each = self.shares.iter().flatten();
        each.map(|(normal, tangential, spin)| normal.abs() + tangential.norm() + spin.abs())
            .fold(0.0, f64::max)
    }
}

impl HoldingCheck {
    /// `None` where the claim has no meaning.
    pub(crate) fn new(claims: &Claims, load: &HoldLoad, weight_H: Vec3) -> Option<Self> {
        let cone = claims.contact.cone?;
        let HoldLoad {
            friction_factor, disturbance_force, disturbance_torque, max_normal_force, drag, ..
        } = *load;
        let sizes = [disturbance_force, disturbance_torque, drag, max_normal_force.unwrap_or(1.0)];
        let sound = sizes.iter().all(|x| *x >= 0.0 && x.is_finite())
            && cone.is_sound()
            && friction_factor > 0.0
            && friction_factor <= 1.0
            && claims.margin.length > 0.0
            && claims.margin.length.is_finite();
        let weight_H = if load.weight { weight_H } else { Vec3::zeros() };
        let unit = weight_H.norm().max(disturbance_force).max(disturbance_torque / claims.margin.length);
        let torsion = cone.gamma;
        let cone = cone.scaled(friction_factor);
        (sound && unit > 0.0).then(|| Self {
            gauge: Gauge::new("stability", "force", Side::Above, LEAST_SLACK),
            load: *load,
            cone,
            torsion,
            weight_H,
            center_O: claims.margin.center_O.into(),
            length: claims.margin.length,
            unit,
            trails: Vec::new(),
            failures: 0,
            last: None,
        })
    }

    /// Takes in one sample, with where everything is and where the fingers touch.
    pub(crate) fn sample(
        &mut self,
        (leg, state, sample): (&Leg<'_>, usize, usize),
        hand: &Chains,
        frames: &Frames,
        touches: &[Option<Touch>; MAX_FINGERS],
    ) {
        if self.failures >= MOST_FAILURES {
            return;
        }
        let held = self.held(leg, hand, frames, touches);
        let weight_O = frames.X_HO.rotation.inverse() * self.weight_H;
        let here = (held, weight_O);
        if self.last.as_ref() == Some(&here) {
            return; // In a regrasp all that holds rests.
        }
        let found = self.prove_all(leg, &here.0, &weight_O);
        self.last = Some(here);
        self.failures += usize::from(found.is_err());
        let place = || leg.between(state, sample as f64 / SAMPLES as f64);
        self.gauge.note(found.unwrap_or_else(|slack| slack), place);
    }

    /// The slack with which one grasp is proved to hold the load, `Err` what could not be proved; forces (N,
    /// in O) that hold the weight, where some are known, save the solver.
    pub(crate) fn figure(
        &mut self,
        leg: &Leg<'_>,
        hand: &Chains,
        frames: &Frames,
        touches: &[Option<Touch>; MAX_FINGERS],
        forces_O: &[Vec3],
    ) -> Result<f64, f64> {
        let held = self.held(leg, hand, frames, touches);
        let weight_O = frames.X_HO.rotation.inverse() * self.weight_H;
        (self.trails, self.last) = (Vec::new(), None);
        let is_known = forces_O.len() == held.contacts.len() && self.cone.least() > 0.0;
        let known = is_known.then(|| {
            let given: Vec<Vec3> = forces_O.iter().map(|force| force / self.unit).collect();
            scaled(&held.contacts, &given)
        });
        self.prove(0, &held, &weight_O, known.as_ref())
    }

    fn held(
        &self,
        leg: &Leg<'_>,
        hand: &Chains,
        frames: &Frames,
        touches: &[Option<Touch>; MAX_FINGERS],
    ) -> Held {
        let mut held = Held::default();
        // Contacts may spin in a transfer, and a spinning contact transmits no torsion.
        let cone = self.cone.cone();
        let cone = if leg.moving.is_some() { cone } else { cone.without_torsion() };
        for (finger, touch) in touches.iter().enumerate() {
            let Some(touch) = touch.filter(|_| leg.moving != Some(finger)) else { continue };
            let n = -touch.n_O;
            let r = (touch.p_OC - self.center_O) / self.length;
            held.contacts.extend(Contact::new(r, n, &cone, self.length));
            held.rows.push(hand.rows(finger, frames, &touch.p_OC, &n));
        }
        held
    }

    /// The least slack over the ways in which the contacts may drag: the contacts of a transfer may spin, and
    /// each then drags by what is claimed, one way or the other. What is held both ways is held for every
    /// drag between, by a blend of the two forces.
    fn prove_all(&mut self, leg: &Leg<'_>, held: &Held, weight_O: &Vec3) -> Result<f64, f64> {
        let drag = self.load.drag * self.torsion / self.length;
        if leg.moving.is_some() || drag == 0.0 {
            return self.prove(0, held, weight_O, None);
        }
        let mut dragged = held.clone();
        let mut least = f64::INFINITY;
        for way in 0..1_usize << held.contacts.len() {
            for (i, contact) in dragged.contacts.iter_mut().enumerate() {
                contact.drag = if way >> i & 1 == 0 { drag } else { -drag };
            }
            least = least.min(self.prove(way, &dragged, weight_O, None)?);
        }
        Ok(least)
    }

    /// The slack with which the grasp is proved to hold the load; `Err` gives what could not be proved.
    /// Forces that are known to hold the weight may hold more. `way` numbers the trail.
    fn prove(
        &mut self,
        way: usize,
        held: &Held,
        weight_O: &Vec3,
        known: Option<&Forces>,
    ) -> Result<f64, f64> {
        let grasp = Grasp {
            held,
            shares: self.shares(held),
            correction: Correction::new(&held.contacts).ok_or(f64::NEG_INFINITY)?,
        };
        let wanted = self.wanted(weight_O);
        if self.trails.len() <= way {
            self.trails.resize(way + 1, Trail::default());
        }
        let trail = &self.trails[way];
        let before = trail.carried.as_ref().and_then(|carried| carried.first()).or(known);
        let answer = before.and_then(|before| self.respond(&grasp, (before, &wanted[0]), trail.solved));
        if let Some((slack, base)) = answer {
            self.trails[way].carried.iter_mut().for_each(|carried| carried[0] = base);
            return Ok(slack);
        }
        let Trail { carried, solved } = std::mem::take(&mut self.trails[way]);
        if let Some(carried) = carried
            && let Ok((slack, carried)) = self.check(&grasp, carried, &wanted)
            && slack > DWINDLED * solved
        {
            self.trails[way] = Trail { carried: Some(carried), solved };
            return Ok(slack);
        }
        let forces = self.solve(&grasp, &wanted, known)?;
        let (slack, forces) = self.check(&grasp, forces, &wanted)?;
        self.trails[way] = Trail { carried: Some(forces), solved: slack };
        Ok(slack)
    }

    /// The slack that forces near to those `before`, for the weight alone, prove, and these forces; `None`
    /// where it is not enough.
    fn respond(
        &self,
        grasp: &Grasp<'_>,
        before: (&Forces, &Vector6<f64>),
        solved: f64,
    ) -> Option<(f64, Forces)> {
        // The corners of the disturbances' icosahedra.
        let corner = icosahedron()[0].norm();
        let sizes = [self.force_size(), self.torque_size()].map(|size| size * corner);
        let Grasp { held, correction, .. } = grasp;
        let response = Response::new(held, correction, before, sizes);
        let slack = response.slack(&grasp.shares, self.load.max_normal_force.map(|most| most / self.unit));
        let is_proved = self.is_proved(grasp, response.residual, slack) && slack > DWINDLED * solved;
        is_proved.then_some((slack, response.base))
    }

    /// Whether what balances a residual exactly, smaller than residual/singular, leaves neither cones nor
    /// efforts.
    fn is_proved(&self, grasp: &Grasp<'_>, residual: f64, slack: f64) -> bool {
        let steepest = 1.0 + grasp.steepest();
        slack >= LEAST_SLACK && residual * steepest <= 0.5 * grasp.correction.singular * slack
    }

    /// The size of the disturbing force over the unit.
    fn force_size(&self) -> f64 {
        self.load.disturbance_force / self.unit
    }

    /// The size of the disturbing torque over unit and length.
    fn torque_size(&self) -> f64 {
        self.load.disturbance_torque / (self.unit * self.length)
    }

    /// Forces for each of the wanted wrenches, near to the best ones: those that the solver found for one
    /// often hold another one too, brought to its wrench.
    fn solve(
        &self,
        grasp: &Grasp<'_>,
        wanted: &[Vector6<f64>],
        known: Option<&Forces>,
    ) -> Result<Vec<Forces>, f64> {
        let Grasp { held, correction, .. } = grasp;
        let most = self.load.max_normal_force.map(|most| most / self.unit);
        // Known ones are taken as they are: they were not chosen for their slack.
        let mut solved: Vec<(Forces, f64)> = known.map(|forces| (*forces, 0.0)).into_iter().collect();
        let mut all = Vec::with_capacity(wanted.len());
        for wanted in wanted {
            let enough = solved.iter().map(|(_, slack)| DWINDLED * slack).fold(f64::INFINITY, f64::min);
            let enough = enough.max(LEAST_SLACK);
            let brought = |(forces, _): &(Forces, f64)| correction.towards(&held.contacts, forces, wanted);
            let mut known = solved.iter().rev().map(brought);
            all.push(match known.find(|forces| self.least_slack(grasp, forces) > enough) {
                Some(forces) => forces,
                None => {
                    let best = socp::best_within(held, self.length, self.unit, most, wanted);
                    let (forces, slack) = best.ok_or(f64::NEG_INFINITY)?;
                    solved.push((forces, slack));
                    forces
                }
            });
        }
        Ok(all)
    }

    fn least_slack(&self, grasp: &Grasp<'_>, forces: &Forces) -> f64 {
        let count = grasp.held.contacts.len();
        (0..count).map(|i| self.slack(grasp, i, forces)).fold(f64::INFINITY, f64::min)
    }

    /// The wrenches that the contacts must give, over the unit.
    fn wanted(&self, weight_O: &Vec3) -> Vec<Vector6<f64>> {
        let f = -weight_O / self.unit;
        let weight = Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0);
        let (force, torque) = (self.force_size(), self.torque_size());
        let mut wanted = Vec::with_capacity(1 + 2 * icosahedron().len());
        wanted.push(weight);
        if force > 0.0 || torque > 0.0 {
            for v in icosahedron() {
                wanted.push(weight + Vector6::new(v.x, v.y, v.z, 0.0, 0.0, 0.0) * force);
                wanted.push(weight + Vector6::new(0.0, 0.0, 0.0, v.x, v.y, v.z) * torque);
            }
        }
        wanted
    }

    /// Brings forces to exactly the wanted wrenches, and checks cones and efforts; `Err`
    /// gives the slack that is too little.
    fn check(
        &self,
        grasp: &Grasp<'_>,
        mut forces: Vec<Forces>,
        wanted: &[Vector6<f64>],
    ) -> Result<(f64, Vec<Forces>), f64> {
        let Grasp { held, correction, .. } = grasp;
        let mut least = f64::INFINITY;
        for (forces, wanted) in forces.iter_mut().zip(wanted) {
            *forces = correction.towards(&held.contacts, forces, wanted);
            let mut residual = -wanted;
            let mut slack = f64::INFINITY;
            for (i, contact) in held.contacts.iter().enumerate() {
                residual += contact.wrench(&forces[i]);
                slack = slack.min(self.slack(grasp, i, forces));
            }
            if !self.is_proved(grasp, residual.norm(), slack) {
                return Err(slack.min(0.0));
            }
            least = least.min(slack);
        }
        Ok((least, forces))
    }

    /// What a joint's effort, over its limit, is of each part of the force at its contact.
    fn shares(&self, held: &Held) -> Shares {
        let each = held.contacts.iter().zip(&held.rows);
        each.map(|(contact, rows)| rows.iter().map(|row| row.of(contact, self.length, self.unit)).collect())
            .collect()
    }

    /// The room of one contact's force: to its cone, to the largest normal force, and of its joints' efforts
    /// (of the limit).
    #[inline]
    fn slack(&self, grasp: &Grasp<'_>, i: usize, forces: &Forces) -> f64 {
        let force = &forces[i];
        let mut slack = force.slack();
        if let Some(most) = self.load.max_normal_force {
            slack = slack.min(most / self.unit - force.normal);
        }
        for share in &grasp.shares[i] {
            slack = slack.min(1.0 - share_of(share, force).abs());
        }
        slack
    }

    /// Takes in what was gathered later in the plan.
    pub(crate) fn join(&mut self, later: Self) {
        self.gauge.join(later.gauge);
    }

    pub(crate) fn check_made(self) -> Check {
        self.gauge.check()
    }

    /// The check of a claim without meaning.
    pub(crate) fn no_meaning() -> Check {
        let mut gauge = Gauge::new("stability", "force", Side::Above, LEAST_SLACK);
        let note = Some("the claimed criterion has no meaning".into());
        gauge.note(f64::NAN, || Place { note, ..Default::default() });
        gauge.check()
    }
}
