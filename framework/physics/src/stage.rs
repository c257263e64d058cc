//! The segments of a motion, as forces and simulations see them.

use crate::force::Friction;
use regrasp_api::{Configuration, FingerIndex, FingerSet, PerFinger, Vec3};

/// One segment of a motion.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// The states; consecutive stages share their end states.
    pub states: &'a [Configuration],
    /// The time of each state (s), from whatever start.
    pub times: &'a [f64],
    /// The finger that moves in a regrasp; `None` in a transfer.
    pub moving: Option<FingerIndex>,
    /// For each state the force of each finger on the object, in O (N), where it was chosen before; may be
    /// empty, or shorter than the states.
    pub forces: &'a [Option<PerFinger<Option<Vec3>>>],
}

impl Stage<'_> {
    /// The fingers that hold the object in this stage's state `q`: in a regrasp all that touch but the one
    /// that moves.
    pub fn holding(&self, q: &Configuration) -> FingerSet {
        self.moving.map_or(q.holding(), |finger| q.holding().without(finger))
    }

    /// The friction that forces may rely on: contacts may spin in a transfer and then carry no torque about
    /// their normals.
    pub fn friction(&self, friction: Friction) -> Friction {
        if self.moving.is_some() { friction } else { friction.without_torsion() }
    }
}
