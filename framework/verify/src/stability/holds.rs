//! What the plan's own forces hold: arithmetic on the forces that its states record.

use super::force::{Contact, Correction, Force, Forces, scaled};
use super::grip::{Cones, Grip};
use super::held::Row;
use super::load::icosahedron;
use super::room::{Room, share_of};
use crate::hand::Chains;
use crate::track::{Frames, Leg};
use crate::verdict::{Check, Gauge};
use nalgebra::Vector6;
use regrasp_api::{HoldLoad, Vec3};
use regrasp_plan::{Claims, Criterion, Extreme, Holds, HoldsAt, Place};
use std::cmp::Ordering;

/// How far forces may be from balance, of the load.
const BALANCED: f64 = 1e-6;
/// By how much forces may pass a claimed bound by rounding, of the bound.
const ROUNDING: f64 = 1e-6;
/// The friction that is written where none would do.
const NO_FRICTION_DOES: f64 = 100.0;

/// Follows the recorded forces.
pub(crate) struct HoldsCheck {
    gauge: Gauge,
    /// What the plan claims to hold, if it does.
    load: Option<HoldLoad>,
    cones: Cones,
    weight_H: Vec3,
    mass: f64,
    center_O: Vec3,
    length: f64,
    friction: Option<Extreme>,
    most_mass: Option<Extreme>,
    disturbance: Option<Extreme>,
    effort: Option<Extreme>,
    /// The state last looked at, and what was found.
    last: Option<(Here, Option<&'static str>, Figures)>,
}

/// A grasp with its forces, and the object's weight in O.
#[derive(PartialEq)]
struct Here {
    grip: Grip,
    forces: Forces,
    weight_O: Vec3,
}

/// The figures of one state.
#[derive(Clone, Copy)]
struct Figures {
    friction: f64,
    mass: f64,
    disturbance: f64,
    effort: f64,
}

impl HoldsCheck {
    /// `None` where the plan claims no cones, or none of its states holds forces; `friction` is the object's.
    pub(crate) fn new(
        claims: &Claims,
        (weight_H, mass, friction): (Vec3, f64, f64),
        has_forces: bool,
    ) -> Option<Self> {
        let cones = Cones::new(&claims.contact, friction)?;
        let load = match &claims.criterion {
            Criterion::Holding(load) => Some(*load),
            _ => None,
        };
        let length = claims.margin.length;
        (has_forces && length > 0.0 && mass > 0.0).then(|| Self {
            gauge: Gauge::faults("forces"),
            load,
            cones,
            weight_H,
            mass,
            center_O: claims.margin.center_O.into(),
            length,
            friction: None,
            most_mass: None,
            disturbance: None,
            effort: None,
            last: None,
        })
    }

    /// Takes in one of the plan's states, everything placed there.
    pub(crate) fn state(&mut self, leg: &Leg<'_>, state: usize, hand: &Chains, frames: &Frames) {
        let record = leg.states[state].record;
        let Some(recorded) = &record.forces else {
            // Soft fingers may hold by torques about the normals, which are not recorded.
            if !self.cones.have_torsion() {
                let nothing =
                    Figures { friction: NO_FRICTION_DOES, mass: 0.0, disturbance: 0.0, effort: 0.0 };
                self.take(&nothing, || leg.at(state));
            }
            return;
        };
        let place = |note: &str| Place { note: Some(note.into()), ..leg.at(state) };
        let (grip, forces) = match self.recorded(leg, state, recorded, hand, frames) {
            Ok(read) => read,
            Err(fault) => return self.gauge.fault(|| place(fault)),
        };
        let weight_O = frames.X_HO.rotation.inverse() * self.weight_H;
        let here = Here { grip, forces, weight_O };
        let (fault, figures) = self.look(here);
        if let Some(fault) = fault {
            self.gauge.fault(|| place(fault));
        }
        self.take(&figures, || leg.at(state));
    }

    /// What is wrong with the forces of a state, and its figures. In a regrasp all that holds rests: the
    /// state is often the one just looked at.
    fn look(&mut self, here: Here) -> (Option<&'static str>, Figures) {
        if let Some((last, fault, figures)) = &self.last
            && *last == here
        {
            return (*fault, *figures);
        }
        let fault = self.fault(&here.grip, &here.forces, &here.weight_O);
        let figures = self.figures(&here.grip, &here.forces, &here.weight_O);
        self.last = Some((here, fault, figures));
        (fault, figures)
    }

    /// The forces that one state records, by themselves: the friction and the largest share of an effort that
    /// they take; `Err` says what is wrong with them, `None` where there are none.
    pub(crate) fn alone(
        &self,
        leg: &Leg<'_>,
        state: usize,
        hand: &Chains,
        frames: &Frames,
    ) -> Option<Result<(f64, f64), &'static str>> {
        let recorded = leg.states[state].record.forces.as_ref()?;
        Some(self.recorded(leg, state, recorded, hand, frames).and_then(|(grip, forces)| {
            let weight_O = frames.X_HO.rotation.inverse() * self.weight_H;
            match self.fault(&grip, &forces, &weight_O) {
                Some(fault) => Err(fault),
                None => Ok(self.needs(&grip, &forces)),
            }
        }))
    }

    /// The grasp and the forces that a state records.
    fn recorded(
        &self,
        leg: &Leg<'_>,
        state: usize,
        recorded: &[Option<[f64; 3]>],
        hand: &Chains,
        frames: &Frames,
    ) -> Result<(Grip, Forces), &'static str> {
        let (mut grip, mut given) = (Grip::default(), Vec::new());
        let numbers = leg.states[state].record.cones.as_deref().unwrap_or_default();
        for (finger, contact) in leg.states[state].record.contacts.iter().enumerate() {
            let force = recorded.get(finger).copied().flatten();
            let holds = contact.filter(|_| leg.moving != Some(finger));
            let (Some(contact), Some(force)) = (holds, force) else {
                if force.is_some() || holds.is_some() {
                    return Err("forces belong to the fingers that hold, and to all of them");
                }
                continue;
            };
            let (p_OC, n) = (Vec3::from(contact.point_O), -Vec3::from(contact.normal_O));
            let r = (p_OC - self.center_O) / self.length;
            let rows = hand.rows(finger, frames, &p_OC, &n);
            let number = numbers.get(finger).copied().flatten();
            if !self.cones.add(number, (r, n, self.length), rows, &mut grip) {
                return Err("a force at a contact without a recorded cone");
            }
            given.push(Vec3::from(force));
        }
        if !given.iter().flatten().all(|x| x.abs() < 1e9) {
            return Err("a force that is not finite, or beyond any hand");
        }
        let forces = scaled(&grip.held.contacts, &given);
        Ok((grip, forces))
    }

    /// What is wrong with the forces of one state.
    fn fault(&self, grip: &Grip, forces: &Forces, weight_O: &Vec3) -> Option<&'static str> {
        let mut residual = Vector6::new(weight_O.x, weight_O.y, weight_O.z, 0.0, 0.0, 0.0);
        let mut largest = residual.norm();
        for (contact, force) in grip.held.contacts.iter().zip(forces) {
            let wrench = contact.wrench(force);
            residual += wrench;
            largest = largest.max(wrench.norm());
        }
        if residual.norm() > BALANCED * largest {
            return Some("the forces do not balance the object's weight");
        }
        let load = self.load.as_ref()?;
        for (i, force) in forces.iter().enumerate().take(grip.held.contacts.len()) {
            if grip.friction_of(i, force) > load.friction_factor * (1.0 + ROUNDING) {
                return Some("a force relies on more friction than the plan claims");
            }
            if effort_of(grip, i, force, self.length) > 1.0 + ROUNDING {
                return Some("a force takes more than a joint's effort");
            }
            if load.max_normal_force.is_some_and(|most| force.normal > most * (1.0 + ROUNDING)) {
                return Some("a force presses harder than the plan claims");
            }
        }
        None
    }

    /// The friction (with a grain the larger coefficient at the share that forces take, with cones of their
    /// own the object's at that share), and the largest share of an effort, that forces take.
    fn needs(&self, grip: &Grip, forces: &Forces) -> (f64, f64) {
        let each = || (0..grip.held.contacts.len()).map(|i| (i, &forces[i]));
        let share = each().map(|(i, force)| grip.friction_of(i, force)).fold(0.0, f64::max);
        let effort = each().map(|(i, force)| effort_of(grip, i, force, self.length)).fold(0.0, f64::max);
        (share * self.cones.most(), effort)
    }

    fn figures(&self, grip: &Grip, forces: &Forces, weight_O: &Vec3) -> Figures {
        let (friction, effort) = self.needs(grip, forces);
        let mut figures =
            Figures { friction: friction.min(NO_FRICTION_DOES), mass: 0.0, disturbance: 0.0, effort };
        let Some(correction) = Correction::new(&grip.held.contacts) else { return figures };
        let room = Room::new(grip, forces, &correction, self.length);
        figures.mass = if weight_O.norm() > 0.0 { self.mass * (1.0 + room.reach(&-weight_O)) } else { 0.0 };
        figures.disturbance = icosahedron().iter().map(|push| room.reach(push)).fold(f64::INFINITY, f64::min);
        figures
    }

    fn take(&mut self, figures: &Figures, place: impl Fn() -> Place) {
        let extreme = |value: f64| Some(Extreme::new(value, place(), HoldsAt::EveryState));
        let [friction, effort, mass, disturbance] = self.kept();
        for (kept, value, order) in [
            (friction, figures.friction, LARGEST),
            (effort, figures.effort, LARGEST),
            (mass, figures.mass, SMALLEST),
            (disturbance, figures.disturbance, SMALLEST),
        ] {
            if value.is_finite() && is_worse(kept, value, order) {
                *kept = extreme(value);
            }
        }
    }

    /// Takes in what was gathered later in the plan.
    pub(crate) fn join(&mut self, mut later: Self) {
        let orders = [LARGEST, LARGEST, SMALLEST, SMALLEST];
        for ((kept, later), order) in self.kept().into_iter().zip(later.kept()).zip(orders) {
            if later.as_ref().is_some_and(|later| is_worse(kept, later.value, order)) {
                *kept = later.take();
            }
        }
        self.gauge.join(later.gauge);
    }

    /// Friction, effort, mass and disturbance.
    fn kept(&mut self) -> [&mut Option<Extreme>; 4] {
        [&mut self.friction, &mut self.effort, &mut self.most_mass, &mut self.disturbance]
    }

    /// The figures for the certificate.
    pub(crate) fn holds(&self) -> Option<Holds> {
        Some(Holds {
            friction: self.friction.clone()?,
            mass: self.most_mass.clone()?,
            disturbance: self.disturbance.clone()?,
            effort: self.effort.clone(),
        })
    }

    pub(crate) fn check(self) -> Check {
        self.gauge.check()
    }
}

/// Of which figures the largest, and of which the smallest counts.
const LARGEST: Ordering = Ordering::Greater;
const SMALLEST: Ordering = Ordering::Less;

/// Whether a value is worse than the one kept.
fn is_worse(kept: &Option<Extreme>, value: f64, worse: Ordering) -> bool {
    kept.as_ref().is_none_or(|kept| value.partial_cmp(&kept.value) == Some(worse))
}

fn share(row: &Row, contact: &Contact, force: &Force, length: f64) -> f64 {
    share_of(&row.of(contact, length, 1.0), force)
}

/// The largest share of an effort limit behind the contact with this number.
fn effort_of(grip: &Grip, i: usize, force: &Force, length: f64) -> f64 {
    let held = &grip.held;
    held.rows[i].iter().map(|row| share(row, &held.contacts[i], force, length).abs()).fold(0.0, f64::max)
}
