//! What can be told to be wrong with a problem without planning it.

use crate::error::{WorldError, check_range};
use crate::hand::ChainHand;
use regrasp_api::{
    Budget, FingerGrasp, Hand, Limits, ObjectModel, ObjectShape, ObstacleDescription, Pose, PoseDescription,
    Problem, Resolution, Tolerances, Workspace, angle_between,
};
use std::collections::BTreeMap;

/// An object this many times larger than the hand's fingers reach, or smaller, has probably another unit of
/// length.
const TOO_LARGE: f64 = 50.0;
const TOO_SMALL: f64 = 1.0 / 200.0;

/// Allowed numbers: key, value, lowest, highest, unit.
type Bound = (&'static str, f64, f64, f64, &'static str);

/// Refuses what can be told to be wrong from the description alone: numbers out of range, goals that
/// coincide, grasps that do not fit the hand, obstacles of one name. Hand, object and meshes are checked
/// where they are built.
pub fn check_problem(problem: &Problem) -> Result<(), WorldError> {
    check_limits(&problem.limits)?;
    for (key, g) in ["gravity[0]", "gravity[1]", "gravity[2]"].into_iter().zip(problem.gravity) {
        check_range(key, g, -1e3, 1e3, " m/s²")?;
    }
    problem.workspace.as_ref().map_or(Ok(()), check_workspace)?;
    obstacle_names(&problem.obstacle)?;
    poses(problem)?;
    check_grasps(problem)
}

/// Refuses tolerances, steps and budgets outside their ranges.
pub fn check_limits(limits: &Limits) -> Result<(), WorldError> {
    let bounds = tolerance_bounds(&limits.tolerances)
        .into_iter()
        .chain(resolution_bounds(&limits.resolution))
        .chain(budget_bounds(&limits.budget));
    for (key, value, low, high, unit) in bounds {
        check_range(key, value, low, high, unit)?;
    }
    Ok(())
}

fn tolerance_bounds(tolerances: &Tolerances) -> [Bound; 6] {
    let Tolerances { closure, slip, normal, clearance, goal_position, goal_angle } = *tolerances;
    [
        ("limits.tolerances.closure", closure, 1e-7, 1e-2, " m"),
        ("limits.tolerances.slip", slip, 1e-7, 1e-2, " m"),
        ("limits.tolerances.normal", normal, 1e-6, 0.5, " rad"),
        ("limits.tolerances.clearance", clearance, 0.0, 0.1, " m"),
        ("limits.tolerances.goal_position", goal_position, 1e-9, 0.1, " m"),
        ("limits.tolerances.goal_angle", goal_angle, 1e-9, 1.0, " rad"),
    ]
}

fn resolution_bounds(resolution: &Resolution) -> [Bound; 11] {
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

fn budget_bounds(budget: &Budget) -> [Bound; 3] {
    [
        ("limits.budget.max_nodes", budget.max_nodes as f64, 1.0, 1e7, ""),
        ("limits.budget.smoothing", budget.smoothing as f64, 0.0, 1e6, ""),
        ("limits.budget.time_limit", budget.time_limit.unwrap_or(1.0), 0.001, 1e7, " s"),
    ]
}

fn check_workspace(given: &Workspace) -> Result<(), WorldError> {
    const LOWER: [&str; 3] = ["workspace.lower[0]", "workspace.lower[1]", "workspace.lower[2]"];
    const UPPER: [&str; 3] = ["workspace.upper[0]", "workspace.upper[1]", "workspace.upper[2]"];
    for axis in 0..3 {
        check_range(LOWER[axis], given.lower[axis], -1e3, 1e3, " m")?;
        check_range(UPPER[axis], given.upper[axis], given.lower[axis], 1e3, " m")?;
    }
    Ok(())
}

/// The obstacles' names, `obstacle 1` for the first without one; two equal names are refused.
pub(super) fn obstacle_names(obstacles: &[ObstacleDescription]) -> Result<Vec<String>, WorldError> {
    if obstacles.len() > usize::from(u16::MAX) {
        return Err(WorldError::range("obstacle", obstacles.len(), format!("0..={} entries", u16::MAX)));
    }
    let mut first = BTreeMap::new();
    let mut names = Vec::with_capacity(obstacles.len());
    for (i, obstacle) in obstacles.iter().enumerate() {
        let given = obstacle.name.trim();
        let name = if given.is_empty() { format!("obstacle {}", i + 1) } else { given.to_owned() };
        if let Some(other) = first.insert(name.clone(), i) {
            let reason = format!("\"{name}\" is the name of `obstacle[{other}]` too; names must differ");
            return Err(WorldError::value(format!("obstacle[{i}].name"), reason));
        }
        names.push(name);
    }
    Ok(names)
}

/// Refuses an object that is far too large or too small for the hand: its unit of length is probably
/// mistaken.
pub fn check_units(hand: &ChainHand, object: &ObjectModel, shape: &ObjectShape) -> Result<(), WorldError> {
    let fingers = (0..hand.finger_count() as u8).map(regrasp_api::FingerIndex);
    let reach = fingers.map(|finger| hand.finger(finger).reach).fold(0.0, f64::max);
    let size = object.mesh.radius();
    let ratio = size / reach;
    if (TOO_SMALL..=TOO_LARGE).contains(&ratio) {
        return Ok(());
    }
    let (how, factor) = if ratio > 1.0 { ("large", 0.001) } else { ("small", 1000.0) };
    let fix = match shape {
        ObjectShape::Mesh(source) => format!("`scale = {}`", factor * source.scale.unwrap_or(1.0)),
        _ => format!("lengths multiplied by {factor}"),
    };
    let reason = format!(
        "the object reaches {size:.3e} m from its origin, the fingers {reach:.3e} m from their bases: too \
            {how} by far; \
         are the lengths in metres? Try {fix}"
    );
    Err(WorldError::value("object.shape", reason))
}

/// The poses of the start and the goals, in turn; no goals, and consecutive ones that coincide, are refused.
pub(super) fn poses(problem: &Problem) -> Result<Vec<Pose>, WorldError> {
    let read =
        |pose: &PoseDescription, key: String| pose.pose().map_err(|error| WorldError::Pose { key, error });
    let mut poses = vec![read(&problem.start.pose, "start.pose".into())?];
    if problem.goal.is_empty() {
        return Err(WorldError::value(
            "goal",
            "there is no goal; give at least one `[[goal]]` with its `pose`",
        ));
    }
    let mut before = ("the start".to_owned(), problem.start.grasp.as_ref());
    for (i, goal) in problem.goal.iter().enumerate() {
        let X_HG = read(&goal.pose, format!("goal[{i}].pose"))?;
        let same_grasp = goal.grasp.is_none() || goal.grasp.as_ref() == before.1;
        if same_grasp && coincide(&problem.limits.tolerances, &poses[i], &X_HG) {
            return Err(coincidence(i, &before.0));
        }
        before = (format!("`goal[{i}]`"), goal.grasp.as_ref());
        poses.push(X_HG);
    }
    Ok(poses)
}

fn coincide(tolerances: &Tolerances, X_HA: &Pose, X_HB: &Pose) -> bool {
    let apart = (X_HA.translation.vector - X_HB.translation.vector).norm();
    apart <= tolerances.goal_position
        && angle_between(&X_HA.rotation, &X_HB.rotation) <= tolerances.goal_angle
}

fn coincidence(goal: usize, before: &str) -> WorldError {
    let reason = format!(
        "`goal[{goal}]` coincides with {before}: there is nothing to do; a full turn is given as several \
            goals, for example four quarters"
    );
    WorldError::value(format!("goal[{goal}].pose"), reason)
}

/// Refuses given grasps that do not fit the hand.
fn check_grasps(problem: &Problem) -> Result<(), WorldError> {
    check_grasp(problem, problem.start.grasp.as_deref(), "start.grasp")?;
    let goals = problem.goal.iter().enumerate();
    goals
        .into_iter()
        .try_for_each(|(i, goal)| check_grasp(problem, goal.grasp.as_deref(), &format!("goal[{i}].grasp")))
}

fn check_grasp(problem: &Problem, grasp: Option<&[FingerGrasp]>, key: &str) -> Result<(), WorldError> {
    let Some(grasp) = grasp else { return Ok(()) };
    let fingers = &problem.hand.finger;
    if grasp.len() != fingers.len() {
        let reason = format!("{} entries, but the hand has {} fingers", grasp.len(), fingers.len());
        return Err(WorldError::value(key, reason));
    }
    for (i, (entry, finger)) in grasp.iter().zip(fingers).enumerate() {
        if entry.contact.is_some_and(|p| p.iter().any(|x| !x.is_finite())) {
            return Err(WorldError::value(format!("{key}[{i}].contact"), "it must be three finite numbers"));
        }
        let Some(joints) = &entry.joints else { continue };
        if joints.len() != finger.joint.len() || joints.iter().any(|q| !q.is_finite()) {
            let reason = format!("finger \"{}\" needs {} finite numbers", finger.name, finger.joint.len());
            return Err(WorldError::value(format!("{key}[{i}].joints"), reason));
        }
    }
    Ok(())
}
