//! The joints of a finger with their limits, drivers and frames.

use crate::UrdfOptions;
use crate::fingers::{Chain, Fingers};
use crate::tree::Tree;
use regrasp_api::{JointDescription, JointKind, Mimic, Pose, PoseDescription};
use regrasp_formats::RobotFault as Fault;
use regrasp_formats::{Joint, Kind, Limit};
use std::f64::consts::PI;

/// The largest acceleration (rad/s²) of joints for which the file says none.
pub(crate) const ACCELERATION: f64 = 20.0;

/// The joints of one finger, without shapes; the first one's frame is the base's.
pub(crate) struct FingerJoints {
    pub base: PoseDescription,
    pub joints: Vec<JointDescription>,
    /// The tip link in the last joint's moved frame.
    pub X_LTip: Pose,
}

/// How long a chain of mimic joints may be.
const MOST_DRIVERS: usize = 8;

/// The joints of a chain.
pub(crate) fn joints(
    tree: &Tree<'_>,
    fingers: &Fingers,
    chain: &Chain,
    options: &UrdfOptions,
    notes: &mut Vec<String>,
) -> Result<FingerJoints, Fault> {
    let (mut joints, mut X) = (Vec::new(), Pose::identity());
    let mut base = Pose::identity();
    for &index in &chain.path {
        let joint = tree.joint(index);
        X *= joint.X_PJ;
        if joint.kind == Kind::Fixed {
            continue;
        }
        let mut origin = X;
        if joints.is_empty() {
            (base, origin) = (X, Pose::identity());
        }
        joints.push(description(tree, (fingers, chain), joint, &origin, options, notes)?);
        X = Pose::identity();
    }
    narrow(&mut joints, chain, tree, notes)?;
    Ok(FingerJoints { base: PoseDescription::from(&base), joints, X_LTip: X })
}

fn description(
    tree: &Tree<'_>,
    (fingers, chain): (&Fingers, &Chain),
    joint: &Joint,
    origin: &Pose,
    options: &UrdfOptions,
    notes: &mut Vec<String>,
) -> Result<JointDescription, Fault> {
    let mimic = mimic(tree, fingers, chain, joint)?;
    let limits = match (&mimic, joint.limit) {
        (Some(mimic), None) => driven_limits(tree, mimic, joint, options, notes)?,
        (_, limit) => own_limits(joint, limit, options, notes)?,
    };
    let still = *origin == Pose::identity();
    Ok(JointDescription {
        name: joint.name.clone(),
        kind: JointKind::Revolute,
        origin: if still { PoseDescription::default() } else { PoseDescription::from(origin) },
        axis: joint.axis.into(),
        lower: limits.lower,
        upper: limits.upper,
        velocity: limits.velocity,
        acceleration: options.acceleration.or(limits.acceleration).unwrap_or(ACCELERATION),
        effort: limits.effort,
        mimic,
        link: Vec::new(),
    })
}

struct Limits {
    lower: f64,
    upper: f64,
    velocity: f64,
    effort: f64,
    acceleration: Option<f64>,
}

/// A joint's own limits: all must be given, in the file or by the options, but for the positions of a continuous joint.
fn own_limits(
    joint: &Joint,
    limit: Option<Limit>,
    options: &UrdfOptions,
    notes: &mut Vec<String>,
) -> Result<Limits, Fault> {
    let name = &joint.name;
    let write = "<limit lower=\"…\" upper=\"…\" velocity=\"…\" effort=\"…\"/> (rad, rad/s, N·m)";
    let Some(limit) = limit.map(|limit| filled(joint, limit, options, notes)) else {
        let message = format!("joint `{name}` has no limits; write {write} into it");
        return Err(Fault::at(joint.line, message));
    };
    let need = |value: Option<f64>, what: &str| {
        value.ok_or_else(|| {
            let option = if ["velocity", "effort"].contains(&what) {
                format!(", or give `{what}` for all joints that lack it")
            } else {
                String::new()
            };
            Fault::at(
                limit.line,
                format!("joint `{name}`: its <limit> lacks `{what}`; write {write}{option}"),
            )
        })
    };
    let (lower, upper) = if joint.kind == Kind::Continuous {
        notes.push(format!("joint `{name}` is continuous: it is used from -180° to 180°"));
        (-PI, PI)
    } else {
        (need(limit.lower, "lower")?, need(limit.upper, "upper")?)
    };
    let (velocity, effort) = (need(limit.velocity, "velocity")?, need(limit.effort, "effort")?);
    for (what, value) in [("velocity", velocity), ("effort", effort)] {
        if value <= 0.0 {
            let message = format!(
                "joint `{name}`: `{what}` = {value} must be positive, or the joint could not move; correct it, or give `{what}` for all joints that lack it"
            );
            return Err(Fault::at(limit.line, message));
        }
    }
    if lower >= upper || lower.abs().max(upper.abs()) > 4.0 * PI {
        let message = format!(
            "joint `{name}`: limits from {lower} to {upper} rad; `lower` must be less than `upper`, both within two turns (are they degrees?)"
        );
        return Err(Fault::at(limit.line, message));
    }
    Ok(Limits { lower, upper, velocity, effort, acceleration: limit.acceleration.filter(|a| *a > 0.0) })
}

/// With what the options say of joints whose file says no velocity or effort, or zero, as some exporters write for "unknown".
fn filled(joint: &Joint, limit: Limit, options: &UrdfOptions, notes: &mut Vec<String>) -> Limit {
    let mut fill = |what: &str, own: Option<f64>, given: Option<f64>| match (own, given) {
        (None | Some(0.0), Some(given)) => {
            notes
                .push(format!("joint `{}`: the file says no {what}; {given} is taken, as given", joint.name));
            Some(given)
        }
        (own, _) => own,
    };
    let velocity = fill("velocity", limit.velocity, options.velocity);
    Limit { velocity, effort: fill("effort", limit.effort, options.effort), ..limit }
}

/// The limits of a driven joint for which the file gives none: those of its driver, multiplied.
fn driven_limits(
    tree: &Tree<'_>,
    mimic: &Mimic,
    joint: &Joint,
    options: &UrdfOptions,
    notes: &mut Vec<String>,
) -> Result<Limits, Fault> {
    let driver = tree.joint(tree.joint_named(&mimic.joint).expect("the driver was looked up before"));
    let of_driver = own_limits(driver, driver.limit, options, &mut Vec::new())?;
    let at = |q: f64| mimic.multiplier * q + mimic.offset;
    let (a, b) = (at(of_driver.lower), at(of_driver.upper));
    notes.push(format!(
        "joint `{}` has no limits of its own: those of `{}`, which drives it, are taken",
        joint.name, mimic.joint
    ));
    let times = mimic.multiplier.abs().max(1e-3);
    Ok(Limits {
        lower: a.min(b) - 1e-9,
        upper: a.max(b) + 1e-9,
        velocity: of_driver.velocity * times,
        effort: of_driver.effort / times,
        acceleration: of_driver.acceleration.map(|acceleration| acceleration * times),
    })
}

/// Which joint of the same finger drives this one in the end, through whatever chain of mimic joints.
fn mimic(tree: &Tree<'_>, fingers: &Fingers, chain: &Chain, joint: &Joint) -> Result<Option<Mimic>, Fault> {
    let Some(first) = &joint.mimic else { return Ok(None) };
    let (mut multiplier, mut offset, mut next) = (1.0, 0.0, first);
    for _ in 0..MOST_DRIVERS {
        offset += multiplier * next.offset;
        multiplier *= next.multiplier;
        let Some(driver) = tree.joint_named(&next.joint) else {
            let message =
                format!("joint `{}` mimics `{}`, which the file does not have", joint.name, next.joint);
            return Err(Fault::at(next.line, message));
        };
        if !chain.moving.contains(&driver) {
            let whose = if fingers.owner(driver).is_some() { "another finger" } else { "no finger" };
            let message = format!(
                "joint `{}` mimics `{}`, a joint of {whose}; fingers must move on their own: remove the <mimic>, or make the joint fixed",
                joint.name, next.joint
            );
            return Err(Fault::at(next.line, message));
        }
        match &tree.joint(driver).mimic {
            Some(further) => next = further,
            None => return Ok(Some(Mimic { joint: next.joint.clone(), multiplier, offset })),
        }
    }
    Err(Fault::at(
        first.line,
        format!("joint `{}` mimics a joint that in the end mimics it; remove one <mimic>", joint.name),
    ))
}

/// Narrows drivers whose range would push a driven joint beyond its limits.
fn narrow(
    joints: &mut [JointDescription],
    chain: &Chain,
    tree: &Tree<'_>,
    notes: &mut Vec<String>,
) -> Result<(), Fault> {
    for driven in 0..joints.len() {
        let Some(mimic) = joints[driven].mimic.clone() else { continue };
        let (name, ends) = (joints[driven].name.clone(), [joints[driven].lower, joints[driven].upper]);
        if mimic.multiplier == 0.0 {
            continue;
        }
        let driver =
            joints.iter_mut().find(|joint| joint.name == mimic.joint).expect("the driver is in the chain");
        let wanted = ends.map(|end| (end - mimic.offset) / mimic.multiplier);
        let (low, high) = (wanted[0].min(wanted[1]), wanted[0].max(wanted[1]));
        if low > driver.lower + 1e-9 || high < driver.upper - 1e-9 {
            (driver.lower, driver.upper) = (driver.lower.max(low), driver.upper.min(high));
            notes.push(format!(
                "the limits of joint `{}` are narrowed to {:.4}..={:.4} rad, so that `{name}`, which it drives, keeps its own",
                driver.name, driver.lower, driver.upper
            ));
        }
        if driver.lower >= driver.upper {
            let line = tree.joint(chain.moving[driven]).line;
            let message =
                format!("joint `{name}` cannot follow `{}` anywhere within its limits", driver.name);
            return Err(Fault::at(line, message));
        }
    }
    Ok(())
}
