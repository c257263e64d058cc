//! What stays the same during one transfer.

use crate::common::Levers;
use crate::transfer::Motion;
use regrasp_api::{FingerSet, Pose, Task, Vec3};

/// What stays the same during one transfer.
pub(crate) struct Roller<'a> {
    pub task: &'a Task<'a>,
    pub levers: &'a Levers,
    pub motion: Motion,
    pub holding: FingerSet,
    pub is_convex: bool,
    /// Fingertip radius (m).
    pub radius: f64,
    /// Largest closure residual (m) between states.
    pub closure: f64,
    /// Largest net slip (m).
    pub slip: f64,
    /// Largest spin (rad) of a contact; infinite where contacts carry no torsion.
    pub spin: f64,
    /// The most (m) that a fingertip's centre moves over the object in one step.
    pub reach: f64,
    /// The most (m) that a finger travels in one step.
    pub travel: f64,
}

pub(crate) fn to_object(X_HO: &Pose, p_H: &Vec3) -> Vec3 {
    X_HO.rotation.inverse_transform_vector(&(p_H - X_HO.translation.vector))
}

pub(crate) fn to_hand(X_HO: &Pose, p_O: &Vec3) -> Vec3 {
    X_HO.rotation * p_O + X_HO.translation.vector
}
