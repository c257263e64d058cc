//! What the plan's own forces hold: arithmetic on the forces that its states record.

use super::force::{Contact, Correction, Force, Forces, scaled};
use super::held::{Held, Row};
use super::load::icosahedron;
use crate::hand::Chains;
use crate::track::{Frames, Leg};
use crate::verdict::{Check, Gauge};
use nalgebra::{Matrix3, Vector6};
use regrasp_api::{HoldLoad, MAX_FINGERS, Vec3};
use regrasp_plan::{Claims, ConeClaim, Criterion, Extreme, Holds, HoldsAt, Place};
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
    cone: ConeClaim,
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
    held: Held,
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
    /// `None` where the plan claims no cone, or none of its states holds forces.
    pub(crate) fn new(claims: &Claims, weight_H: Vec3, mass: f64, has_forces: bool) -> Option<Self> {
        let cone = claims.contact.cone.filter(|cone| cone.least() > 0.0 && cone.most().is_finite())?;
        let load = match &claims.criterion {
            Criterion::Holding(load) => Some(*load),
            _ => None,
        };
        let length = claims.margin.length;
        (has_forces && length > 0.0 && mass > 0.0).then(|| Self {
            gauge: Gauge::faults("forces"),
            load,
            cone,
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
            if self.cone.gamma == 0.0 {
                let nothing =
                    Figures { friction: NO_FRICTION_DOES, mass: 0.0, disturbance: 0.0, effort: 0.0 };
                self.take(&nothing, || leg.at(state));
            }
            return;
        };
        let place = |note: &str| Place { note: Some(note.into()), ..leg.at(state) };
        let (held, forces) = match self.recorded(leg, state, recorded, hand, frames) {
            Ok(read) => read,
            Err(fault) => return self.gauge.fault(|| place(fault)),
        };
        let weight_O = frames.X_HO.rotation.inverse() * self.weight_H;
        let here = Here { held, forces, weight_O };
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
        let fault = self.fault(&here.held, &here.forces, &here.weight_O);
        let figures = self.figures(&here.held, &here.forces, &here.weight_O);
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
        Some(self.recorded(leg, state, recorded, hand, frames).and_then(|(held, forces)| {
            let weight_O = frames.X_HO.rotation.inverse() * self.weight_H;
            match self.fault(&held, &forces, &weight_O) {
                Some(fault) => Err(fault),
                None => Ok(self.needs(&held, &forces)),
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
    ) -> Result<(Held, Forces), &'static str> {
        let (mut held, mut given) = (Held::default(), Vec::new());
        let cone = self.cone.cone().without_torsion();
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
            held.contacts.extend(Contact::new(r, n, &cone, self.length));
            held.rows.push(hand.rows(finger, frames, &p_OC, &n));
            given.push(Vec3::from(force));
        }
        if !given.iter().flatten().all(|x| x.abs() < 1e9) {
            return Err("a force that is not finite, or beyond any hand");
        }
        let forces = scaled(&held.contacts, &given);
        Ok((held, forces))
    }

    /// What is wrong with the forces of one state.
    fn fault(&self, held: &Held, forces: &Forces, weight_O: &Vec3) -> Option<&'static str> {
        let mut residual = Vector6::new(weight_O.x, weight_O.y, weight_O.z, 0.0, 0.0, 0.0);
        let mut largest = residual.norm();
        for (contact, force) in held.contacts.iter().zip(forces) {
            let wrench = contact.wrench(force);
            residual += wrench;
            largest = largest.max(wrench.norm());
        }
        if residual.norm() > BALANCED * largest {
            return Some("the forces do not balance the object's weight");
        }
        let load = self.load.as_ref()?;
        for (i, force) in forces.iter().enumerate().take(held.contacts.len()) {
            if friction_of(force) > load.friction_factor * (1.0 + ROUNDING) {
                return Some("a force relies on more friction than the plan claims");
            }
            if effort_of(held, i, force, self.length) > 1.0 + ROUNDING {
                return Some("a force takes more than a joint's effort");
            }
            if load.max_normal_force.is_some_and(|most| force.normal > most * (1.0 + ROUNDING)) {
                return Some("a force presses harder than the plan claims");
            }
        }
        None
    }

    /// The friction (with a grain the larger coefficient at the share that forces take), and the largest
    /// share of an effort, that forces take.
    fn needs(&self, held: &Held, forces: &Forces) -> (f64, f64) {
        let each = || (0..held.contacts.len()).map(|i| (i, &forces[i]));
        let friction = each().map(|(_, force)| friction_of(force)).fold(0.0, f64::max) * self.cone.most();
        (friction, each().map(|(i, force)| effort_of(held, i, force, self.length)).fold(0.0, f64::max))
    }

    fn figures(&self, held: &Held, forces: &Forces, weight_O: &Vec3) -> Figures {
        let (friction, effort) = self.needs(held, forces);
        let mut figures =
            Figures { friction: friction.min(NO_FRICTION_DOES), mass: 0.0, disturbance: 0.0, effort };
        let Some(correction) = Correction::new(&held.contacts) else { return figures };
        let room = Room::new(held, forces, &correction, self.length);
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

/// How far forces may grow within cones and efforts: what is worked out once for all pushes.
///
/// What contacts give on top of their forces is linear in the push, the smallest forces that have its wrench:
/// so a cone's boundary is a quadratic in the multiple whose coefficients are linear and quadratic in the
/// push, and an effort's share is linear in it.
struct Room {
    cones: [ConeRoom; MAX_FINGERS],
    count: usize,
    /// Of each joint: how its share of an effort grows along each axis of O, and the share now.
    rows: Vec<(Vec3, f64)>,
}

/// The room of one contact's force in its cone.
#[derive(Clone, Copy, Default)]
struct ConeRoom {
    is_outside: bool,
    /// normal² - |tangential|² of the force ...
    form: f64,
    /// ... how twice that of the force and its change grows along each axis of O ...
    slope: Vec3,
    /// ... and that of the change, along two axes.
    curve: Matrix3<f64>,
}

impl Room {
    fn new(held: &Held, forces: &Forces, correction: &Correction, length: f64) -> Self {
        let contacts = &held.contacts[..];
        let unit = |axis: usize| {
            let mut wanted = Vector6::zeros();
            wanted[axis] = 1.0;
            correction.towards(contacts, &[Force::default(); MAX_FINGERS], &wanted)
        };
        let units: [Forces; 3] = std::array::from_fn(unit);
        let mut cones = [ConeRoom::default(); MAX_FINGERS];
        for (i, cone) in cones.iter_mut().enumerate().take(contacts.len()) {
            let (force, unit) = (&forces[i], |axis: usize| &units[axis][i]);
            cone.form = form(force, force);
            cone.is_outside = cone.form <= 0.0 || force.normal <= 0.0;
            cone.slope = Vec3::from_fn(|axis, _| 2.0 * form(force, unit(axis)));
            cone.curve = Matrix3::from_fn(|a, b| form(unit(a), unit(b)));
        }
        let mut rows = Vec::with_capacity(held.rows.iter().map(Vec::len).sum());
        for (i, (contact, behind)) in contacts.iter().zip(&held.rows).enumerate() {
            rows.extend(behind.iter().map(|row| {
                let parts = row.of(contact, length, 1.0);
                (Vec3::from_fn(|axis, _| share_of(&parts, &units[axis][i])), share_of(&parts, &forces[i]))
            }));
        }
        Self { cones, count: contacts.len(), rows }
    }

    /// The largest multiple of a force on the object (in O) that the contacts can give on top; 0 where the
    /// forces are outside already.
    fn reach(&self, push_O: &Vec3) -> f64 {
        let cones = self.cones[..self.count].iter().map(|cone| cone.reach(push_O));
        let efforts = self.rows.iter().map(|(rates, now)| {
            let rate = rates.dot(push_O);
            if rate == 0.0 { f64::INFINITY } else { ((rate.signum() - now) / rate).max(0.0) }
        });
        cones.chain(efforts).fold(1e6, f64::min)
    }
}

/// A cone's form: positive inside, for a force and itself.
fn form(a: &Force, b: &Force) -> f64 {
    a.normal * b.normal - a.tangential.dot(&b.tangential)
}

impl ConeRoom {
    /// The smallest λ > 0 at which force + λ more leaves the cone normal ≥ |tangential|.
    fn reach(&self, push_O: &Vec3) -> f64 {
        if self.is_outside {
            return 0.0;
        }
        let (slope, curve) = (self.slope.dot(push_O), push_O.dot(&(self.curve * push_O)));
        let root = (slope * slope - 4.0 * curve * self.form).max(0.0).sqrt();
        if root > slope { 2.0 * self.form / (root - slope) } else { f64::INFINITY }
    }
}

/// The share of the friction that a force needs.
fn friction_of(force: &Force) -> f64 {
    if force.normal > 0.0 { force.tangential.norm() / force.normal } else { f64::INFINITY }
}

fn share(row: &Row, contact: &Contact, force: &Force, length: f64) -> f64 {
    share_of(&row.of(contact, length, 1.0), force)
}

fn share_of((normal, tangential, spin): &(f64, Vec3, f64), force: &Force) -> f64 {
    normal * force.normal + tangential.dot(&force.tangential) + spin * force.spin
}

/// The largest share of an effort limit behind the contact with this number.
fn effort_of(held: &Held, i: usize, force: &Force, length: f64) -> f64 {
    held.rows[i].iter().map(|row| share(row, &held.contacts[i], force, length).abs()).fold(0.0, f64::max)
}
