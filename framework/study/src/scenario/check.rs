//! Ranges and sense of what a scenario says, beyond its form.

use super::document::{Document, key_path};
use super::{Place, ScenarioError};
use regrasp_api::{FingerIndex, Hand, ObjectModel, Pose, PoseDescription, Problem, angle_between};
use regrasp_world::ChainHand;

/// Allowed numbers: key, value, lowest, highest, unit.
type Bound = (&'static str, f64, f64, f64, &'static str);

pub(super) fn check_problem(document: &Document, problem: &Problem) -> Result<(), ScenarioError> {
    check_limits(document, problem)?;
    check_workspace(document, problem)?;
    check_goals(document, problem)
}

fn check_limits(document: &Document, problem: &Problem) -> Result<(), ScenarioError> {
    let bounds =
        tolerance_bounds(problem).into_iter().chain(resolution_bounds(problem)).chain(other_bounds(problem));
    for (key, value, low, high, unit) in bounds {
        if !(low..=high).contains(&value) {
            return Err(out_of_range(
                document.place(&key_path(key)),
                value,
                &format!("{low}..={high}{unit}"),
            ));
        }
    }
    Ok(())
}

fn tolerance_bounds(problem: &Problem) -> [Bound; 6] {
    let tolerances = &problem.limits.tolerances;
    [
        ("limits.tolerances.closure", tolerances.closure, 1e-7, 1e-2, " m"),
        ("limits.tolerances.slip", tolerances.slip, 1e-7, 1e-2, " m"),
        ("limits.tolerances.normal", tolerances.normal, 1e-6, 0.5, " rad"),
        ("limits.tolerances.clearance", tolerances.clearance, 0.0, 0.1, " m"),
        ("limits.tolerances.goal_position", tolerances.goal_position, 1e-9, 0.1, " m"),
        ("limits.tolerances.goal_angle", tolerances.goal_angle, 1e-9, 1.0, " rad"),
    ]
}

fn resolution_bounds(problem: &Problem) -> [Bound; 11] {
    let resolution = &problem.limits.resolution;
    [
        ("limits.resolution.grasp_step", resolution.grasp_step, 1e-5, 0.1, " m"),
        ("limits.resolution.grasp_turn", resolution.grasp_turn, 1e-4, 1.0, " rad"),
        ("limits.resolution.transfer_step", resolution.transfer_step, 1e-5, 0.1, " m"),
        ("limits.resolution.transfer_turn", resolution.transfer_turn, 1e-4, 1.0, " rad"),
        ("limits.resolution.regrasp_step", resolution.regrasp_step, 1e-5, 0.1, " m"),
        ("limits.resolution.lift", resolution.lift, 1e-4, 0.2, " m"),
        ("limits.resolution.retreat[0]", resolution.retreat[0], 0.0, 0.2, " m"),
        ("limits.resolution.retreat[1]", resolution.retreat[1], 0.0, 0.2, " m"),
        ("limits.resolution.clearance", resolution.clearance, 0.0, 0.05, " m"),
        ("limits.resolution.edge_margin", resolution.edge_margin, 0.0, 0.1, " m"),
        ("limits.resolution.friction_margin", resolution.friction_margin, 0.01, 1.0, ""),
    ]
}

fn other_bounds(problem: &Problem) -> [Bound; 6] {
    let budget = &problem.limits.budget;
    let [x, y, z] = problem.gravity;
    [
        ("limits.budget.max_nodes", budget.max_nodes as f64, 1.0, 1e7, ""),
        ("limits.budget.smoothing", budget.smoothing as f64, 0.0, 1e6, ""),
        ("limits.budget.time_limit", budget.time_limit.unwrap_or(1.0), 0.001, 1e7, " s"),
        ("gravity[0]", x, -1000.0, 1000.0, " m/s²"),
        ("gravity[1]", y, -1000.0, 1000.0, " m/s²"),
        ("gravity[2]", z, -1000.0, 1000.0, " m/s²"),
    ]
}

fn check_workspace(document: &Document, problem: &Problem) -> Result<(), ScenarioError> {
    let Some(workspace) = problem.workspace else { return Ok(()) };
    match (0..3).find(|&i| workspace.lower[i] > workspace.upper[i]) {
        Some(axis) => {
            let (low, high) = (workspace.lower[axis], workspace.upper[axis]);
            let message = format!("`lower` = {low} m is above `upper` = {high} m along axis {axis}");
            Err(document.refuse(&key_path("workspace"), message))
        }
        None => Ok(()),
    }
}

fn check_goals(document: &Document, problem: &Problem) -> Result<(), ScenarioError> {
    if problem.goal.is_empty() {
        let message = "there is no goal; give at least one `[[goal]]` with its `pose`".to_owned();
        return Err(document.refuse(&key_path("goal"), message));
    }
    let start = &problem.start;
    let mut before =
        ("the start".to_owned(), pose(document, "start.pose", &start.pose)?, start.grasp.as_ref());
    for (i, goal) in problem.goal.iter().enumerate() {
        let X_HG = pose(document, &format!("goal[{i}].pose"), &goal.pose)?;
        let same_grasp = goal.grasp.is_none() || goal.grasp.as_ref() == before.2;
        if same_grasp && coincide(problem, &before.1, &X_HG) {
            return Err(coincidence(document, i, &before.0));
        }
        before = (format!("`goal[{i}]`"), X_HG, goal.grasp.as_ref());
    }
    Ok(())
}

fn coincide(problem: &Problem, X_HA: &Pose, X_HB: &Pose) -> bool {
    let tolerances = &problem.limits.tolerances;
    let apart = (X_HA.translation.vector - X_HB.translation.vector).norm();
    apart <= tolerances.goal_position
        && angle_between(&X_HA.rotation, &X_HB.rotation) <= tolerances.goal_angle
}

fn coincidence(document: &Document, goal: usize, before: &str) -> ScenarioError {
    let message = format!(
        "`goal[{goal}]` coincides with {before}: there is nothing to do; a full turn is given as several goals, for example four quarters"
    );
    document.refuse(&key_path(&format!("goal[{goal}].pose")), message)
}

fn pose(document: &Document, key: &str, pose: &PoseDescription) -> Result<Pose, ScenarioError> {
    pose.pose().map_err(|message| document.refuse(&key_path(key), message))
}

/// Refuses an object that no hand of this size could hold: most often a mesh in millimetres.
pub(super) fn check_sizes(
    document: &Document,
    hand: &ChainHand,
    object: &ObjectModel,
) -> Result<(), ScenarioError> {
    let reach = (0..hand.finger_count() as u8).map(|i| hand.finger(FingerIndex(i)).reach).fold(0.0, f64::max);
    let size = 2.0 * object.mesh.radius();
    let ratio = size / (2.0 * reach);
    if (1e-4..=20.0).contains(&ratio) {
        return Ok(());
    }
    let message = format!(
        "the object is {size:.3e} m across, while a fingertip of this hand reaches {:.3e} m: are the lengths in metres? A mesh in millimetres \
         needs `scale = 0.001`",
        2.0 * reach
    );
    Err(document.refuse(&key_path("object.shape"), message))
}

fn out_of_range(place: Box<Place>, value: f64, range: &str) -> ScenarioError {
    ScenarioError::Range { place, value: value.to_string(), range: range.to_owned() }
}
