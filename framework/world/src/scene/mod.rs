//! A whole problem, checked and prepared: hand, object, clearance, start and goals.

mod check;
mod embed;

pub use embed::embed_problem;

use crate::clearance::SceneClearance;
use crate::error::WorldError;
use crate::hand::ChainHand;
use crate::object::load_object;
use regrasp_api::{ObjectModel, Pose, Problem, Vec3};
use std::path::Path;
use std::sync::Arc;

/// How far beyond start and goals the object may be sampled where the problem does not say (m).
const WORKSPACE_MARGIN: f64 = 0.015;

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
    /// Checks a problem and prepares it; mesh files are looked for relative to the folder `base`.
    ///
    /// Only what can be told without planning is checked: whether a given grasp holds, or a start collides, is not.
    pub fn new(problem: &Problem, base: &Path) -> Result<Self, WorldError> {
        check::check_limits(&problem.limits)?;
        let obstacle_names = check::obstacle_names(&problem.obstacle)?;
        let hand = Arc::new(ChainHand::new(problem.hand.clone())?);
        let object = load_object(&problem.object, base)?;
        check::check_units(&hand, &object, &problem.object.shape)?;
        let (start, goals) = check::poses(problem)?;
        check::check_grasps(problem)?;
        let clear = problem.limits.tolerances.clearance + problem.limits.resolution.clearance;
        let clearance = SceneClearance::new(hand.clone(), &object, &problem.obstacle, clear, base)?;
        let workspace = match &problem.workspace {
            Some(given) => check::workspace(given)?,
            None => around(&start, &goals),
        };
        let g_H = check::gravity(problem.gravity)?;
        Ok(Self { hand, object, clearance, obstacle_names, start, goals, g_H, workspace })
    }
}

/// A box about the positions of start and goals.
fn around(start: &Pose, goals: &[Pose]) -> (Vec3, Vec3) {
    let margin = Vec3::repeat(WORKSPACE_MARGIN);
    let first = start.translation.vector;
    let (lower, upper) = goals
        .iter()
        .map(|goal| goal.translation.vector)
        .fold((first, first), |(lower, upper), p| (lower.inf(&p), upper.sup(&p)));
    (lower - margin, upper + margin)
}

#[cfg(test)]
mod tests;
