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
