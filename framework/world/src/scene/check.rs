//! What can be told to be wrong with a problem without planning it.

use crate::error::{WorldError, check_range};
use crate::hand::ChainHand;
use regrasp_api::{
    FingerGrasp, Hand, Limits, ObjectModel, ObjectShape, ObstacleDescription, Pose, PoseDescription, Problem,
    Resolution, Tolerances, Vec3, Workspace, angle_between,
};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// An object this many times larger than the hand's fingers reach, or smaller, has probably another unit of length.
const TOO_LARGE: f64 = 50.0;
const TOO_SMALL: f64 = 1.0 / 200.0;

/// Refuses tolerances, steps and budgets outside their ranges.
pub(super) fn check_limits(limits: &Limits) -> Result<(), WorldError> {
    let Tolerances { closure, slip, normal, clearance, goal_position, goal_angle } = limits.tolerances;
    let tolerance = |key, value, low, high, unit| {
        check_range(&format!("limits.tolerances.{key}"), value, low, high, unit)
    };
    tolerance("closure", closure, 1e-9, 1e-2, " m")?;
    tolerance("slip", slip, 1e-9, 1e-1, " m")?;
    tolerance("normal", normal, 1e-9, PI, " rad")?;
    tolerance("clearance", clearance, 0.0, 1e-1, " m")?;
    tolerance("goal_position", goal_position, 0.0, 1e-1, " m")?;
    tolerance("goal_angle", goal_angle, 0.0, PI, " rad")?;
    check_resolution(&limits.resolution)?;
    if let Some(time) = limits.budget.time_limit {
        check_range("limits.budget.time_limit", time, 0.0, 1e9, " s")?;
    }
    match limits.budget.max_nodes {
        0 => Err(WorldError::range("limits.budget.max_nodes", 0, "at least 1")),
        _ => Ok(()),
    }
}

fn check_resolution(resolution: &Resolution) -> Result<(), WorldError> {
    let Resolution {
        grasp_step,
        grasp_turn,
        transfer_step,
        transfer_turn,
        regrasp_step,
        lift,
        retreat,
        clearance,
        edge_margin,
        friction_margin,
    } = *resolution;
    let check = |key: &str, value, low, high, unit| {
        check_range(&format!("limits.resolution.{key}"), value, low, high, unit)
    };
    for (key, step) in
        [("grasp_step", grasp_step), ("transfer_step", transfer_step), ("regrasp_step", regrasp_step)]
    {
        check(key, step, 1e-6, 1.0, " m")?;
    }
    for (key, turn) in [("grasp_turn", grasp_turn), ("transfer_turn", transfer_turn)] {
        check(key, turn, 1e-5, PI / 2.0, " rad")?;
    }
    check("lift", lift, 1e-5, 1.0, " m")?;
    check("retreat[0]", retreat[0], 0.0, 1.0, " m")?;
    check("retreat[1]", retreat[1], 0.0, 1.0, " m")?;
    check("clearance", clearance, 0.0, 0.1, " m")?;
    check("edge_margin", edge_margin, 0.0, 1.0, " m")?;
    check("friction_margin", friction_margin, 1e-3, 1.0, "")
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

/// Refuses an object that is far too large or too small for the hand: its unit of length is probably mistaken.
pub(super) fn check_units(
    hand: &ChainHand,
    object: &ObjectModel,
    shape: &ObjectShape,
) -> Result<(), WorldError> {
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
        "the object reaches {size:.3e} m from its origin, the fingers {reach:.3e} m from their bases: too {how} by far; \
         lengths are in metres, so try {fix}"
    );
    Err(WorldError::value("object.shape", reason))
}

/// The poses of start and goals; no goals, and consecutive goals that coincide, are refused.
pub(super) fn poses(problem: &Problem) -> Result<(Pose, Vec<Pose>), WorldError> {
    let read =
        |pose: &PoseDescription, key: String| pose.pose().map_err(|reason| WorldError::value(key, reason));
    let start = read(&problem.start.pose, "start.pose".into())?;
    if problem.goal.is_empty() {
        return Err(WorldError::value("goal", "at least one goal is needed"));
    }
    let goals = problem.goal.iter().enumerate().map(|(i, goal)| read(&goal.pose, format!("goal[{i}].pose")));
    let goals = goals.collect::<Result<Vec<_>, _>>()?;
    let tolerances = &problem.limits.tolerances;
    for (i, pair) in goals.windows(2).enumerate() {
        let moved = (pair[1].translation.vector - pair[0].translation.vector).norm();
        let turned = angle_between(&pair[0].rotation, &pair[1].rotation);
        let same_grasp = problem.goal[i].grasp == problem.goal[i + 1].grasp;
        if moved <= tolerances.goal_position && turned <= tolerances.goal_angle && same_grasp {
            let reason = format!("it coincides with `goal[{i}]`; remove one of the two");
            return Err(WorldError::value(format!("goal[{}]", i + 1), reason));
        }
    }
    Ok((start, goals))
}

/// Refuses given grasps that do not fit the hand.
pub(super) fn check_grasps(problem: &Problem) -> Result<(), WorldError> {
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

/// The given box of positions.
pub(super) fn workspace(given: &Workspace) -> Result<(Vec3, Vec3), WorldError> {
    for axis in 0..3 {
        check_range(&format!("workspace.lower[{axis}]"), given.lower[axis], -1e3, 1e3, " m")?;
        check_range(&format!("workspace.upper[{axis}]"), given.upper[axis], given.lower[axis], 1e3, " m")?;
    }
    Ok((given.lower.into(), given.upper.into()))
}

/// The acceleration of gravity.
pub(super) fn gravity(given: [f64; 3]) -> Result<Vec3, WorldError> {
    for (axis, &g) in given.iter().enumerate() {
        check_range(&format!("gravity[{axis}]"), g, -1e3, 1e3, " m/s²")?;
    }
    Ok(given.into())
}
