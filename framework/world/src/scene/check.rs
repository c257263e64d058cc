//! What can be told to be wrong with a problem without planning it.

use crate::error::WorldError;
use crate::hand::ChainHand;
use regrasp_api::{
    FingerGrasp, Hand, Limits, ObjectModel, ObjectShape, ObstacleDescription, Pose, Problem, Workspace,
    check_described, check_field,
};
use std::collections::BTreeMap;

/// An object this many times larger than the hand's fingers reach, or smaller, has probably another unit of
/// length.
const TOO_LARGE: f64 = 50.0;
const TOO_SMALL: f64 = 1.0 / 200.0;

/// Refuses what can be told to be wrong from the description alone: numbers out of range, goals that
/// coincide, grasps that do not fit the hand, obstacles of one name. Hand, object and meshes are checked
/// where they are built.
pub fn check_problem(problem: &Problem) -> Result<(), WorldError> {
    check_limits(&problem.limits)?;
    check_field::<Problem>("gravity", &problem.gravity, "gravity")?;
    problem.workspace.as_ref().map_or(Ok(()), check_workspace)?;
    obstacle_names(&problem.obstacle)?;
    poses(problem)?;
    check_grasps(problem)
}

/// Refuses tolerances, steps and budgets outside their ranges.
pub fn check_limits(limits: &Limits) -> Result<(), WorldError> {
    check_described(limits, "limits")?;
    match limits.budget.time_limit {
        // The check above cannot tell it from none.
        Some(limit) if !limit.is_finite() => {
            Err(WorldError::value("limits.budget.time_limit", "it must be a finite number (s)"))
        }
        _ => Ok(()),
    }
}

fn check_workspace(given: &Workspace) -> Result<(), WorldError> {
    check_described(given, "workspace")?;
    for (axis, (&lower, &upper)) in given.lower.iter().zip(&given.upper).enumerate() {
        if upper < lower {
            let range = format!("{lower}.. m, above `workspace.lower[{axis}]`");
            return Err(WorldError::range(format!("workspace.upper[{axis}]"), upper, range));
        }
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

/// The poses of the start and the goals, in turn; no goals are refused.
pub(super) fn poses(problem: &Problem) -> Result<Vec<Pose>, WorldError> {
    let poses = problem.poses()?;
    if poses.len() > 1 {
        return Ok(poses);
    }
    Err(WorldError::value("goal", "there is no goal; give at least one `[[goal]]` with its `pose`"))
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
