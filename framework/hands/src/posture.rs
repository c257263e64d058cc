//! Where the joints stand that no finger has: at zero or as near as they can, or where the options say;
//! driven ones where their drivers have them.

use crate::options::HandOptions;
use crate::tree::Tree;
use regrasp_api::{Pose, Rotation};
use regrasp_formats::{Joint, Kind, Mimic, RobotFault as Fault};

/// A position for every joint of a robot.
#[derive(Debug)]
pub(crate) struct Posture {
    /// (rad; m), in the tree's order of joints.
    positions: Vec<f64>,
}

impl Posture {
    /// Refused are joints that mimic what there is not, or in the end themselves.
    pub fn new(tree: &Tree<'_>, options: &HandOptions) -> Result<Self, Fault> {
        let joints = tree.model.joints.iter();
        let own = joints.map(|joint| start(joint, options)).collect::<Vec<f64>>();
        let mut positions = own.clone();
        for (index, joint) in tree.model.joints.iter().enumerate() {
            if let Some(drive) = drive(tree, joint)? {
                positions[index] = drive.multiplier * own[drive.joint] + drive.offset;
            }
        }
        Ok(Self { positions })
    }

    /// Where a joint stands (rad; m).
    pub fn position(&self, joint: usize) -> f64 {
        self.positions[joint]
    }

    /// The pose of a joint's child link in its parent link.
    pub fn pose(&self, tree: &Tree<'_>, joint: usize) -> Pose {
        moved(tree.joint(joint), self.positions[joint])
    }
}

/// The pose of a joint's child link in its parent link at a position (rad; m).
pub(crate) fn moved(joint: &Joint, q: f64) -> Pose {
    match joint.kind {
        Kind::Revolute | Kind::Continuous => joint.X_PJ * Rotation::from_scaled_axis(joint.axis * q),
        Kind::Prismatic => joint.X_PJ * nalgebra::Translation3::from(joint.axis * q),
        Kind::Fixed | Kind::Other => joint.X_PJ,
    }
}

/// The chosen position, or the one nearest to 0 within the limits.
fn start(joint: &Joint, options: &HandOptions) -> f64 {
    let chosen = options.joints.iter().rev().filter(|choice| choice.matches(&joint.name));
    if let Some(q) = chosen.filter_map(|choice| choice.position).next() {
        return q;
    }
    let limit = joint.limit.unwrap_or_default();
    let (low, high) = (limit.lower.unwrap_or(f64::MIN), limit.upper.unwrap_or(f64::MAX));
    if low <= high { 0_f64.clamp(low, high) } else { 0.0 }
}

/// What drives a joint in the end: q = multiplier · q of `joint` + offset.
pub(crate) struct Drive {
    pub joint: usize,
    pub multiplier: f64,
    pub offset: f64,
}

/// What drives a joint, through whatever chain of mimic joints; `None` where it moves by itself.
pub(crate) fn drive(tree: &Tree<'_>, joint: &Joint) -> Result<Option<Drive>, Fault> {
    let Some(first) = &joint.mimic else { return Ok(None) };
    let (mut multiplier, mut offset, mut next) = (1.0, 0.0, first);
    for _ in 0..tree.model.joints.len() {
        offset += multiplier * next.offset;
        multiplier *= next.multiplier;
        let driver = tree.joint_named(&next.joint).ok_or_else(|| no_driver(joint, next))?;
        match &tree.joint(driver).mimic {
            Some(further) => next = further,
            None => return Ok(Some(Drive { joint: driver, multiplier, offset })),
        }
    }
    let message =
        format!("joint `{}` mimics a joint that in the end mimics it; remove one <mimic>", joint.name);
    Err(Fault::at(first.line, message))
}

fn no_driver(joint: &Joint, mimic: &Mimic) -> Fault {
    let message = format!("joint `{}` mimics `{}`, which the file does not have", joint.name, mimic.joint);
    Fault::at(mimic.line, message)
}
