//! A whole problem, checked and prepared: hand, object, clearance, start and goals.

mod check;
mod size;

pub use check::{check_limits, check_problem, check_units};
pub use size::check_size;

use crate::clearance::SceneClearance;
use crate::error::WorldError;
use crate::hand::ChainHand;
use crate::object::load_object;
use regrasp_api::{ObjectModel, Pose, Problem, Vec3};
use std::sync::Arc;

/// Everything that a problem describes, checked and prepared for planning.
pub struct World {
    /// Kinematics and limits of the hand.
    pub hand: Arc<ChainHand>,
    /// The object.
    pub object: ObjectModel,
    /// Collision and distance; its `*_free` calls keep the tolerance and the planner's clearance together.
    pub clearance: SceneClearance,
    /// What reports call the obstacles, in their order; `obstacle 1` for the first without a name.
    pub obstacle_names: Vec<String>,
    /// The object's pose at the start.
    pub start: Pose,
    /// The object's poses at the goals.
    pub goals: Vec<Pose>,
    /// Acceleration of gravity in H (m/s²).
    pub g_H: Vec3,
    /// Lowest and highest coordinates of the object's origin in H (m) for samples.
    pub workspace: (Vec3, Vec3),
}

impl World {
    /// Checks a problem and prepares it; its meshes are given in place.
    ///
    /// Only what can be told without planning is checked: whether a given grasp holds, or a start collides,
    /// is not.
    pub fn new(problem: &Problem) -> Result<Self, WorldError> {
        check_problem(problem)?;
        let hand = Arc::new(ChainHand::new(problem.hand.clone())?);
        let object = load_object(&problem.object)?;
        check_units(&hand, &object, &problem.object.shape)?;
        check_size(&hand, &object, &problem.object.shape)?;
        let mut poses = check::poses(problem)?;
        let workspace = problem.sampling_box(&poses);
        let start = poses.remove(0);
        let clear = problem.limits.tolerances.clearance + problem.limits.resolution.clearance;
        let clearance = SceneClearance::new(hand.clone(), &object, &problem.obstacle, clear)?;
        let obstacle_names = check::obstacle_names(&problem.obstacle)?;
        let g_H = problem.gravity.into();
        Ok(Self { hand, object, clearance, obstacle_names, start, goals: poses, g_H, workspace })
    }
}

#[cfg(test)]
mod tests;
