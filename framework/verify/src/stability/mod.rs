//! Whether the fingers that hold the object hold it stably, at every sample of the plan.
//!
//! Force closure by the largest ball of wrenches: C. Ferrari, J. Canny, "Planning optimal grasps", ICRA 1992;
//! internal forces that prove it: L. Han, J. Trinkle, Z. Li, "Grasp analysis as linear matrix inequality
//! problems", IEEE T-RA 2000.

mod cones;
mod edge_hold;
mod edge_load;
mod edges;
mod force;
mod grip;
mod held;
mod holding;
mod holds;
mod load;
mod own;
mod response;
mod room;
mod six;
mod slice;
mod socp;

use crate::touch::Touch;
use crate::track::{Leg, SAMPLES};
use crate::verdict::{Check, Gauge, Side};
pub(crate) use cones::ConesCheck;
use force::{Contact, LEAST_SLACK, Proof};
pub(crate) use holding::HoldingCheck;
pub(crate) use holds::HoldsCheck;
use load::LoadCheck;
use regrasp_api::{MAX_FINGERS, Rotation, Vec3};
use regrasp_plan::{Claims, ConeClaim, Criterion, Extreme, HoldsAt, Place};

/// Grasps of a stretch not proved stable after which no more are looked at: the plan is refused anyway.
const MOST_FAILURES: usize = 20;
/// Grasps of smallest margin for which the best force is sought again: each one's bound can only rise.
const MOST_REFINEMENTS: usize = 24;
/// Where the best force raises a bound by no more than this part of it, none is sought any more.
const ENOUGH: f64 = 1e-3;

/// Grasps of smallest margin that the general solver is asked about, too.
const MOST_POLISHES: usize = 4;

/// The part of the solver's slack below which a carried force is no longer taken: the best one at this grasp
/// may be far better.
const DWINDLED: f64 = 0.4;

/// Follows the grasp along the plan.
pub(crate) struct StabilityCheck {
    gauge: Gauge,
    cone: Option<ConeClaim>,
    center_O: Vec3,
    length: f64,
    /// The last internal force of the same contacts ...
    carried: Option<Proof>,
    /// ... and the slack that the solver found when it was last asked.
    solved: f64,
    failures: usize,
    /// Margins' lower bounds at the plan's states, for refinement at the end.
    margins: Vec<Margin>,
    /// What must be held where the plan claims equilibrium, not closure.
    load: Option<LoadCheck>,
}

/// The certified margin of one grasp.
struct Margin {
    contacts: Vec<Contact>,
    lower: f64,
    /// What may prove more than `lower`, which is a rough bound as long as there are any.
    rough: Vec<Proof>,
    /// Whether the general solver has had its say.
    is_polished: bool,
    place: Place,
}

impl Margin {
    /// Makes a rough bound as good as its proofs; whether it was one.
    fn settle(&mut self) -> bool {
        let proofs = std::mem::take(&mut self.rough);
        for proof in &proofs {
            self.lower = self.lower.max(force::margin(&self.contacts, proof));
        }
        !proofs.is_empty()
    }

    /// Raises the bound by a proof of another grasp, where it proves more; roughly where `enough` is passed.
    fn sharpen(&mut self, proof: &Proof, enough: f64) {
        let Some(proof) = force::prove(&self.contacts, &proof.forces) else { return };
        self.lower = self.lower.max(force::rough_margin(&self.contacts, &proof));
        self.rough.push(proof);
        if self.lower < enough {
            self.settle();
        }
    }
}

impl StabilityCheck {
    /// For an object of this weight (N, in H).
    pub(crate) fn new(claims: &Claims, weight_H: Vec3) -> Self {
        let mut gauge = Gauge::new("stability", "force", Side::Above, LEAST_SLACK);
        let (known, load) = match &claims.criterion {
            Criterion::Closure => (true, None),
            Criterion::Equilibrium(load) => {
                let check = LoadCheck::new(load, weight_H, claims.margin.length);
                (check.is_some(), check)
            }
            // Looked at by a check of its own, which knows the joints.
            Criterion::Holding(_) => (true, None),
            _ => (false, None),
        };
        let elsewhere = matches!(claims.criterion, Criterion::Holding(_));
        if !known {
            gauge.note(f64::NAN, || Place {
                note: Some("the claimed criterion has no meaning".into()),
                ..Default::default()
            });
        }
        let cone = claims.contact.cone.filter(ConeClaim::is_sound).filter(|_| known && !elsewhere);
        if claims.contact.cone.is_none() {
            gauge.remark(
                "not independently checked: the plan claims no elliptic cone that all its contacts share, \
                    and records no cones of its contacts",
            );
        } else if cone.is_none() && known && !elsewhere {
            gauge.note(f64::NAN, || Place {
                note: Some("the claimed cone has no meaning".into()),
                ..Default::default()
            });
        }
        Self {
            gauge,
            cone,
            center_O: claims.margin.center_O.into(),
            length: claims.margin.length,
            carried: None,
            solved: 0.0,
            failures: 0,
            margins: Vec::new(),
            load,
        }
    }

    /// Starts a segment: the contacts change, so no force is carried over.
    pub(crate) fn start(&mut self) {
        self.carried = None;
        self.load.iter_mut().for_each(LoadCheck::start);
    }

    /// Takes in one sample, with the object's orientation and where the fingers touch that hold in this
    /// segment.
    ///
    /// `moving` does not hold at all while it is lifted, its contacts at both ends included.
    pub(crate) fn sample(
        &mut self,
        leg: &Leg<'_>,
        state: usize,
        sample: usize,
        R_HO: &Rotation,
        touches: &[Option<Touch>; MAX_FINGERS],
    ) {
        let Some(cone) = self.cone else { return };
        if self.failures >= MOST_FAILURES {
            return;
        }
        let contacts = self.contacts(leg, &cone, touches);
        if self.load.is_some() {
            return self.sample_load(&contacts, R_HO, || leg.between(state, sample as f64 / SAMPLES as f64));
        }
        if leg.moving.is_some() && self.margins.last().is_some_and(|last| last.contacts == contacts) {
            return; // The others rest: the grasp is the one just looked at.
        }
        let place = || leg.between(state, sample as f64 / SAMPLES as f64);
        match self.prove(&contacts) {
            Ok(proof) => {
                self.carried = Some(proof);
                self.gauge.note(proof.slack, place);
                if sample.is_multiple_of(SAMPLES) {
                    let (lower, rough) = (force::rough_margin(&contacts, &proof), vec![proof]);
                    let place = leg.at(state + sample / SAMPLES);
                    self.margins.push(Margin { contacts, lower, rough, is_polished: false, place });
                }
            }
            Err(slack) => {
                self.carried = None;
                self.failures += 1;
                self.gauge.note(slack, place);
                let place = place();
                let (contacts, rough) = (vec![], vec![]);
                self.margins.push(Margin { contacts, lower: 0.0, rough, is_polished: true, place });
            }
        }
    }

    /// Whether the contacts hold the claimed load; closure margins do not apply.
    fn sample_load(&mut self, contacts: &[Contact], R_HO: &Rotation, place: impl FnOnce() -> Place) {
        let Some(load) = &mut self.load else { return };
        let found = load.prove(contacts, R_HO);
        self.failures += usize::from(found.is_err());
        self.gauge.note(found.unwrap_or_else(|slack| slack), place);
    }

    /// The contacts of the fingers that hold.
    fn contacts(
        &self,
        leg: &Leg<'_>,
        cone: &ConeClaim,
        touches: &[Option<Touch>; MAX_FINGERS],
    ) -> Vec<Contact> {
        // Contacts may spin in a transfer, and a spinning contact transmits no torsion.
        let cone = if leg.moving.is_some() { cone.cone() } else { cone.cone().without_torsion() };
        let holding = touches.iter().enumerate().filter(|&(finger, _)| leg.moving != Some(finger));
        let contact = |touch: Touch| {
            let r = (touch.p_OC - self.center_O) / self.length;
            Contact::new(r, -touch.n_O, &cone, self.length)
        };
        holding.filter_map(|(_, touch)| contact((*touch)?)).collect()
    }

    /// A proof for the grasp from the carried force, else (or where its slack has dwindled) from the
    /// solver's; `Err` gives the slack that the solver could not bring above the least one.
    fn prove(&mut self, contacts: &[Contact]) -> Result<Proof, f64> {
        let carried = self.carried.as_ref().and_then(|carried| force::prove(contacts, &carried.forces));
        if let Some(proof) = carried
            && proof.slack > DWINDLED * self.solved
        {
            return Ok(proof);
        }
        let solved = best(contacts).or_else(|slack| carried.ok_or(slack))?;
        self.solved = solved.slack;
        Ok(solved)
    }

    /// The figure of one grasp by itself: the certified margin of the solver's best force; the slack of the
    /// solver's best forces where the plan claims that they hold a load. 0 or less where the grasp is not
    /// proved stable, `None` where stability is not checked.
    pub(crate) fn figure(
        &mut self,
        leg: &Leg<'_>,
        R_HO: &Rotation,
        touches: &[Option<Touch>; MAX_FINGERS],
    ) -> Option<f64> {
        let contacts = self.contacts(leg, &self.cone?, touches);
        if let Some(load) = &mut self.load {
            return Some(load.prove(&contacts, R_HO).unwrap_or_else(|slack| slack.min(0.0)));
        }
        if let Some(last) = self.margins.last().filter(|last| last.contacts == contacts) {
            return Some(last.lower);
        }
        let lower = best(&contacts).map_or(0.0, |proof| force::margin(&contacts, &proof));
        let (rough, place) = (vec![], Place::default());
        self.margins.push(Margin { contacts, lower, rough, is_polished: false, place });
        Some(lower)
    }

    /// [`Self::figure`] of a grasp at rest of which forces (N, in O) are known that hold the object: where
    /// they prove closure, no solver is asked.
    pub(crate) fn figure_from(
        &mut self,
        leg: &Leg<'_>,
        R_HO: &Rotation,
        touches: &[Option<Touch>; MAX_FINGERS],
        forces_O: &[Vec3],
    ) -> Option<f64> {
        let cone = self.cone.filter(|cone| self.load.is_none() && cone.least() > 0.0);
        let proved = cone.and_then(|cone| {
            let contacts = self.contacts(leg, &cone, touches);
            let proof = force::prove(&contacts, &force::scaled(&contacts, forces_O))?;
            Some(force::margin(&contacts, &proof))
        });
        proved.or_else(|| self.figure(leg, R_HO, touches))
    }

    /// The smallest margin, for the certificate: bounds that a carried force left loose are sharpened with
    /// the best one, which is often nearly the best of grasps close by.
    pub(crate) fn extreme(&mut self) -> Option<Extreme> {
        for _ in 0..MOST_REFINEMENTS {
            let worst = smallest(&mut self.margins)?;
            let before = worst.lower;
            let Ok(proof) = best(&worst.contacts) else { break };
            worst.lower = before.max(force::margin(&worst.contacts, &proof));
            let refined = worst.lower;
            if refined <= before * (1.0 + ENOUGH) {
                break;
            }
            for other in self.margins.iter_mut().filter(|other| other.lower < refined) {
                other.sharpen(&proof, refined);
            }
        }
        // Two good forces differ in what they prove by the root of the solvers' precision: the better counts.
        for _ in 0..MOST_POLISHES {
            let worst = smallest(&mut self.margins)?;
            if std::mem::replace(&mut worst.is_polished, true) {
                break;
            }
            if let Ok(proof) = solved(&worst.contacts) {
                worst.lower = worst.lower.max(force::margin(&worst.contacts, &proof));
            }
        }
        let worst = smallest(&mut self.margins)?;
        Some(Extreme::new(worst.lower, worst.place.clone(), HoldsAt::EveryState))
    }

    /// Takes in what was gathered later in the plan.
    pub(crate) fn join(&mut self, mut later: Self) {
        self.gauge.join(later.gauge);
        self.margins.append(&mut later.margins);
    }

    pub(crate) fn check(self) -> Check {
        self.gauge.check()
    }
}

/// The margin of the smallest bound, which is no rough one.
fn smallest(margins: &mut [Margin]) -> Option<&mut Margin> {
    let order = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
    loop {
        let (k, _) = margins.iter().enumerate().map(|(k, margin)| (k, margin.lower)).min_by(order)?;
        if !margins[k].settle() {
            return Some(&mut margins[k]);
        }
    }
}

/// The best force, checked: where the quick search proves closure, the solver is not asked.
fn best(contacts: &[Contact]) -> Result<Proof, f64> {
    let quick = own::best_forces(contacts);
    if let Some(proof) = quick.and_then(|forces| force::prove(contacts, &forces)) {
        return Ok(proof);
    }
    solved(contacts)
}

/// The solver's best force, checked.
fn solved(contacts: &[Contact]) -> Result<Proof, f64> {
    let Some((forces, slack)) = socp::best_forces(contacts) else { return Err(f64::NEG_INFINITY) };
    // What the solver claims beyond what can be proved counts as nothing.
    force::prove(contacts, &forces).ok_or(slack.min(0.0))
}

#[cfg(test)]
mod tests;
