//! Forces for all disturbances from those for the weight alone: the quick half of the proof that a grasp
//! holds its load.
//!
//! What a disturbance adds is met by the smallest forces that have its wrench. These are linear in it, so six
//! of them tell how far any disturbance of a size takes each force, at most.

use super::force::{Correction, Force, Forces};
use super::held::Held;
use super::room::share_of;
use nalgebra::Vector6;
use regrasp_api::{MAX_FINGERS, Vec3};

/// What a joint's effort, over its limit, is of each part of the force at its contact.
pub(super) type Shares = Vec<Vec<(f64, Vec3, f64)>>;

/// Forces for the weight, and what is added for a disturbance along each axis: three forces, three torques.
pub(super) struct Response {
    pub(super) base: Forces,
    added: [Forces; 6],
    /// How far the wrench of the forces for any of the disturbances is from the wanted one, at most.
    pub(super) residual: f64,
}

impl Response {
    /// The forces near to `before` that hold `weight`, with those for disturbances of the sizes `force` and
    /// `torque`.
    pub(super) fn new(
        held: &Held,
        correction: &Correction,
        (before, weight): (&Forces, &Vector6<f64>),
        [force, torque]: [f64; 2],
    ) -> Self {
        let contacts = &held.contacts;
        let wanted = |axis: usize| {
            let mut wanted = Vector6::zeros();
            wanted[axis] = if axis < 3 { force } else { torque };
            wanted
        };
        let rest = [Force::default(); MAX_FINGERS];
        let base = correction.towards(contacts, before, weight);
        let added = std::array::from_fn(|axis| correction.towards(contacts, &rest, &wanted(axis)));
        let off = |forces: &Forces, wanted: &Vector6<f64>| {
            let wrenches = contacts.iter().zip(forces).map(|(contact, force)| contact.wrench(force));
            (wrenches.sum::<Vector6<f64>>() - wanted).norm()
        };
        let each = added.iter().enumerate().map(|(axis, forces)| off(forces, &wanted(axis)));
        Self { base, residual: off(&base, weight) + each.sum::<f64>(), added }
    }

    /// The least room of any force, under any of the disturbances, to its cone, to the largest normal force
    /// and to its joints' efforts (of the limit): a lower bound.
    pub(super) fn slack(&self, shares: &Shares, most: Option<f64>) -> f64 {
        let mut least = f64::INFINITY;
        for (i, shares) in shares.iter().enumerate() {
            let force = &self.base[i];
            for axes in [0..3, 3..6] {
                let added = || self.added[axes.clone()].iter().map(|forces| &forces[i]);
                let normal = added().map(|more| more.normal * more.normal).sum::<f64>().sqrt();
                let across = added().map(|more| more.tangential.norm_squared() + more.spin * more.spin);
                least = least.min(force.slack() - normal - across.sum::<f64>().sqrt());
                if let Some(most) = most {
                    least = least.min(most - force.normal - normal);
                }
                for share in shares {
                    let more = added().map(|more| share_of(share, more).powi(2)).sum::<f64>().sqrt();
                    least = least.min(1.0 - share_of(share, force).abs() - more);
                }
            }
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::super::force::Contact;
    use super::super::held::Row;
    use super::super::load::icosahedron;
    use super::*;
    use regrasp_api::{Cone, Random};

    /// Four contacts on a ball, two joints behind each.
    fn grasp(random: &mut Random) -> Held {
        let mut held = Held::default();
        for _ in 0..4 {
            let n = random.direction();
            let contact = Contact::new(-n, n, &Cone::Elliptic { mu: 0.8, gamma: 0.01 }, 0.03);
            held.contacts.extend(contact);
            let row = |random: &mut Random| Row {
                column_O: random.direction() * 0.05,
                spin: random.range(-1.0, 1.0),
                limit: random.range(0.2, 2.0),
            };
            held.rows.push(vec![row(random), row(random)]);
        }
        held
    }

    #[test]
    fn no_disturbance_leaves_less_room_than_is_said() {
        let mut random = Random::from_key(8, 0, 0, 0);
        let (mut looked, mut tightest) = (0, f64::INFINITY);
        for _ in 0..100 {
            let held = grasp(&mut random);
            let contacts = &held.contacts;
            let Some(correction) = Correction::new(contacts) else { continue };
            let behind = |(contact, rows): (&Contact, &Vec<Row>)| {
                rows.iter().map(|row| row.of(contact, 0.03, 1.0)).collect::<Vec<_>>()
            };
            let shares: Shares = contacts.iter().zip(&held.rows).map(behind).collect();
            let weight = Vector6::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
            let pressing = [Force { normal: 3.0, ..Default::default() }; MAX_FINGERS];
            let response = Response::new(&held, &correction, (&pressing, &weight), [0.3, 0.2]);
            assert!(response.residual < 1e-9, "{}", response.residual);
            let said = response.slack(&shares, Some(10.0));
            let corners = icosahedron().iter().map(|v| v.normalize());
            for v in corners.flat_map(|v| {
                [Vector6::new(v.x, v.y, v.z, 0.0, 0.0, 0.0) * 0.3, {
                    Vector6::new(0.0, 0.0, 0.0, v.x, v.y, v.z) * 0.2
                }]
            }) {
                let forces = correction.towards(contacts, &response.base, &(weight + v));
                let room = |i: usize| {
                    let efforts = shares[i].iter().map(|share| 1.0 - share_of(share, &forces[i]).abs());
                    let cone = forces[i].slack().min(10.0 - forces[i].normal);
                    efforts.fold(cone, f64::min)
                };
                let least = (0..contacts.len()).map(room).fold(f64::INFINITY, f64::min);
                assert!(least >= said - 1e-9, "{least} where {said} is said");
                (looked, tightest) = (looked + 1, tightest.min(least - said));
            }
        }
        // A bound that says nothing would pass, too.
        assert!(looked > 1000 && tightest < 0.2, "{looked} {tightest}");
    }
}
