//! What the options, soft limits and odd ranges make of a robot's joints, before fingers are looked for.

use crate::options::HandOptions;
use regrasp_formats::{Geometry, Joint, Kind, Limit, Robot, RobotFault as Fault, Soft};
use std::f64::consts::PI;

/// Changes lengths and limits as the options and the file say; the names of joints that were made fixed for
/// want of a range.
pub(crate) fn prepare(
    robot: &mut Robot,
    options: &HandOptions,
    notes: &mut Vec<String>,
) -> Result<Vec<String>, Fault> {
    scale(robot, options);
    choose(robot, options, notes)?;
    let mut still = Vec::new();
    for joint in &mut robot.joints {
        match joint.kind {
            Kind::Fixed | Kind::Other => continue,
            Kind::Continuous => turn(joint, notes),
            Kind::Revolute | Kind::Prismatic => {}
        }
        if let Some(soft) = joint.soft {
            soften(joint, soft, notes);
        }
        if joint.mimic.is_none() {
            widen(joint, options, notes);
        }
        if let Some(q) = only_position(joint) {
            match joint.mimic {
                // It follows its driver; exporters write 0..0 for it.
                Some(_) => without_range(joint),
                None => {
                    still.push(joint.name.clone());
                    fix(joint, q, notes);
                }
            }
        }
    }
    Ok(still)
}

/// Lengths of the whole file, and of its meshes.
fn scale(robot: &mut Robot, options: &HandOptions) {
    let (all, meshes) = (options.scale.unwrap_or(1.0), options.mesh_scale.unwrap_or(1.0));
    if all == 1.0 && meshes == 1.0 {
        return;
    }
    for joint in &mut robot.joints {
        joint.X_PJ.translation.vector *= all;
        if joint.kind == Kind::Prismatic
            && let Some(limit) = &mut joint.limit
        {
            [&mut limit.lower, &mut limit.upper].into_iter().flatten().for_each(|x| *x *= all);
        }
    }
    for link in &mut robot.links {
        let shapes = [&mut link.collision, &mut link.visual].into_iter().flatten().flatten();
        shapes.for_each(|solid| {
            solid.X_LS.translation.vector *= all;
            solid.geometry = scaled(&solid.geometry, all, all * meshes);
        });
    }
}

fn scaled(geometry: &Geometry, all: f64, mesh: f64) -> Geometry {
    match geometry.clone() {
        Geometry::Box { size } => Geometry::Box { size: size.map(|x| x * all) },
        Geometry::Sphere { radius } => Geometry::Sphere { radius: radius * all },
        Geometry::Ellipsoid { semi_axes } => Geometry::Ellipsoid { semi_axes: semi_axes.map(|x| x * all) },
        Geometry::Cylinder { radius, length } => {
            Geometry::Cylinder { radius: radius * all, length: length * all }
        }
        Geometry::Capsule { radius, length } => {
            Geometry::Capsule { radius: radius * all, length: length * all }
        }
        Geometry::Mesh { file, scale } => Geometry::Mesh { file, scale: scale.map(|x| x * mesh) },
    }
}

/// What the options say of joints by their names.
fn choose(robot: &mut Robot, options: &HandOptions, notes: &mut Vec<String>) -> Result<(), Fault> {
    for choice in &options.joints {
        let mut count = 0;
        for joint in robot.joints.iter_mut().filter(|joint| joint.kind != Kind::Fixed) {
            if !choice.matches(&joint.name) {
                continue;
            }
            count += 1;
            let line = joint.line;
            let limit = joint.limit.get_or_insert(Limit { line, ..Limit::default() });
            if let (Some(lower), Some(upper)) = (choice.lower, choice.upper) {
                (limit.lower, limit.upper, joint.soft) = (Some(lower), Some(upper), None);
            }
            limit.velocity = choice.velocity.or(limit.velocity);
            limit.effort = choice.effort.or(limit.effort);
            limit.acceleration = choice.acceleration.or(limit.acceleration);
        }
        if count == 0 {
            let known: Vec<String> = robot
                .joints
                .iter()
                .filter(|joint| joint.kind != Kind::Fixed)
                .take(12)
                .map(|joint| format!("`{}`", joint.name))
                .collect();
            let message = format!(
                "`joint`: no joint that moves is called `{}`; there are {}",
                choice.name,
                known.join(", ")
            );
            return Err(Fault::of_key("joint", message));
        }
        if !choice.is_position_only() {
            notes.push(format!("as given: {choice} ({count} joints)"));
        }
    }
    Ok(())
}

/// The range of a continuous joint: half a turn to both sides, or less where the file has limits for it.
fn turn(joint: &mut Joint, notes: &mut Vec<String>) {
    let name = joint.name.clone();
    let line = joint.line;
    let limit = joint.limit.get_or_insert(Limit { line, ..Limit::default() });
    let whole = "it is used from -180° to 180°";
    let (lower, upper) = match (limit.lower, limit.upper) {
        (None, None) => {
            notes.push(format!("joint `{name}` is continuous: {whole}"));
            (-PI, PI)
        }
        (lower, upper) => {
            let (low, high) = (lower.unwrap_or(-PI).max(-PI), upper.unwrap_or(PI).min(PI));
            let said = format!(
                "joint `{name}` is continuous, and its file has the limits {}..{} rad",
                lower.map_or("".into(), |x| x.to_string()),
                upper.map_or("".into(), |x| x.to_string())
            );
            if low < high {
                notes.push(format!(
                    "{said}: they are kept ({:.1}° to {:.1}°)",
                    low.to_degrees(),
                    high.to_degrees()
                ));
                (low, high)
            } else {
                notes.push(format!("{said}, which leave it no range: they are dropped, {whole}"));
                (-PI, PI)
            }
        }
    };
    (limit.lower, limit.upper) = (Some(lower), Some(upper));
}

/// The narrower of a joint's limits and its controller's.
fn soften(joint: &mut Joint, soft: Soft, notes: &mut Vec<String>) {
    let name = joint.name.clone();
    let Some(limit) = &mut joint.limit else { return };
    let (Some(lower), Some(upper)) = (limit.lower, limit.upper) else { return };
    if soft.lower.is_none() && soft.upper.is_none() {
        return;
    }
    let (low, high) = (soft.lower.unwrap_or(lower).max(lower), soft.upper.unwrap_or(upper).min(upper));
    if low >= high {
        notes.push(format!(
            "joint `{name}`: its <safety_controller> (line {}) leaves it no range and is not used",
            soft.line
        ));
    } else if (low, high) != (lower, upper) {
        notes.push(format!(
            "joint `{name}`: its <safety_controller> (line {}) narrows {lower}..{upper} to {low}..{high}, \
             which is used",
            soft.line
        ));
        (limit.lower, limit.upper) = (Some(low), Some(high));
    }
}

/// The range that is given for joints without one.
fn widen(joint: &mut Joint, options: &HandOptions, notes: &mut Vec<String>) {
    let Some([lower, upper]) = options.limits else { return };
    let line = joint.line;
    let name = joint.name.clone();
    let limit = joint.limit.get_or_insert(Limit { line, ..Limit::default() });
    if limit.lower.is_none() && limit.upper.is_none() || limit.lower == limit.upper {
        (limit.lower, limit.upper) = (Some(lower), Some(upper));
        notes
            .push(format!("joint `{name}`: the file gives it no range; {lower}..{upper} is taken, as given"));
    }
}

/// The position of a joint whose limits are one number.
fn only_position(joint: &Joint) -> Option<f64> {
    let limit = joint.limit?;
    limit.lower.filter(|lower| Some(*lower) == limit.upper)
}

fn without_range(joint: &mut Joint) {
    if let Some(limit) = &mut joint.limit {
        (limit.lower, limit.upper) = (None, None);
    }
}

fn fix(joint: &mut Joint, q: f64, notes: &mut Vec<String>) {
    notes.push(format!(
        "joint `{}` has the limits {q}..{q}: it is taken as fixed there; `--limits` gives it a range",
        joint.name
    ));
    joint.X_PJ = crate::posture::moved(joint, q);
    joint.kind = Kind::Fixed;
}
