//! How much more than their load recorded forces can hold.

use super::force::{Correction, Force, Forces};
use super::grip::Grip;
use nalgebra::{Matrix3, Vector6};
use regrasp_api::{MAX_FINGERS, Vec3};

/// How far forces may grow within cones and efforts: what is worked out once for all pushes.
///
/// What contacts give on top of their forces is linear in the push, the smallest forces that have its wrench:
/// so a round cone's boundary is a quadratic in the multiple whose coefficients are linear and quadratic in
/// the push, and an effort's share is linear in it, as is the room to a side of a cone with edges.
pub(super) struct Room {
    /// Of each contact with a round cone.
    cones: [ConeRoom; MAX_FINGERS],
    count: usize,
    /// Of each side of each other contact's cone: the room, and how it grows along each axis of O.
    sides: Vec<(f64, Vec3)>,
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
    pub(super) fn new(grip: &Grip, forces: &Forces, correction: &Correction, length: f64) -> Self {
        let (held, contacts) = (&grip.held, &grip.held.contacts[..]);
        let unit = |axis: usize| {
            let mut wanted = Vector6::zeros();
            wanted[axis] = 1.0;
            correction.towards(contacts, &[Force::default(); MAX_FINGERS], &wanted)
        };
        let units: [Forces; 3] = std::array::from_fn(unit);
        let (mut cones, mut count, mut sides) = ([ConeRoom::default(); MAX_FINGERS], 0, Vec::new());
        for (i, contact) in contacts.iter().enumerate() {
            let (force, unit) = (&forces[i], |axis: usize| &units[axis][i]);
            if let Some(slice) = grip.slice(i) {
                sides.extend(slice.rooms(contact, force, [unit(0), unit(1), unit(2)]));
                continue;
            }
            let cone = &mut cones[count];
            count += 1;
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
        Self { cones, count, sides, rows }
    }

    /// The largest multiple of a force on the object (in O) that the contacts can give on top; 0 where the
    /// forces are outside already.
    pub(super) fn reach(&self, push_O: &Vec3) -> f64 {
        let cones = self.cones[..self.count].iter().map(|cone| cone.reach(push_O));
        let efforts = self.rows.iter().map(|(rates, now)| {
            let rate = rates.dot(push_O);
            if rate == 0.0 { f64::INFINITY } else { ((rate.signum() - now) / rate).max(0.0) }
        });
        let sides = self.sides.iter().map(|(room, rates)| match (*room, rates.dot(push_O)) {
            (room, rate) if room > 0.0 && rate < 0.0 => room / -rate,
            (room, _) if room > 0.0 => f64::INFINITY,
            _ => 0.0,
        });
        cones.chain(efforts).chain(sides).fold(1e6, f64::min)
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

/// The share of an effort that a force takes; see [`super::held::Row::of`].
pub(super) fn share_of((normal, tangential, spin): &(f64, Vec3, f64), force: &Force) -> f64 {
    normal * force.normal + tangential.dot(&force.tangential) + spin * force.spin
}
