//! Joints that others drive: tendons and gears that bend two joints as one.

use regrasp_api::{FingerDescription, FingerJoints, TipJacobian};

/// A driven joint of one finger: q[joint] = multiplier · q[driver] + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coupling {
    pub joint: usize,
    pub driver: usize,
    pub multiplier: f64,
    /// (rad; m where prismatic).
    pub offset: f64,
}

/// The couplings of a finger whose description was checked.
pub(super) fn couplings(finger: &FingerDescription) -> Vec<Coupling> {
    let index = |name: &str| finger.joint.iter().position(|joint| joint.name == name);
    let coupling = |(joint, mimic): (usize, &regrasp_api::Mimic)| {
        let driver = index(&mimic.joint)?;
        Some(Coupling { joint, driver, multiplier: mimic.multiplier, offset: mimic.offset })
    };
    let driven = finger.joint.iter().enumerate().filter_map(|(j, joint)| Some((j, joint.mimic.as_ref()?)));
    driven.filter_map(coupling).collect()
}

/// Puts the driven joints where their drivers have them.
#[inline]
pub(super) fn settle(couplings: &[Coupling], joints: &mut FingerJoints) {
    for coupling in couplings {
        joints[coupling.joint] = coupling.multiplier * joints[coupling.driver] + coupling.offset;
    }
}

/// Adds what the driven joints do to the columns of their drivers; their own columns become zero.
#[inline]
pub(super) fn fold(couplings: &[Coupling], J: &mut TipJacobian) {
    for coupling in couplings {
        let driven = J.column(coupling.joint) * coupling.multiplier;
        let mut driver = J.column_mut(coupling.driver);
        driver += driven;
        J.column_mut(coupling.joint).fill(0.0);
    }
}
