//! Checks of a hand's description, each with the path of its key.

use super::HandError;
use crate::shape::{check_direction, check_shape};
use regrasp_api::{
    BodyPair, Departure, FingerDescription, Form, HandDescription, JointDescription, JointKind,
    MAX_FINGER_JOINTS, MAX_FINGERS, Mimic, PlacedShape, Pose, PoseDescription, Shape, check_described,
    check_field,
};

/// Largest absolute limit of a revolute joint (rad): two turns.
const MAX_TURN: f64 = 4.0 * std::f64::consts::PI;
/// Largest absolute limit of a prismatic joint, and half the size of a shape (m).
const MAX_TRAVEL: f64 = 10.0;
const MILLIMETRES: &str = "; lengths are in metres";
const DEGREES: &str = "; angles are in radians, lengths in metres";

/// The poses of a finger whose description is sound.
#[derive(Clone, Debug)]
pub(super) struct FingerPoses {
    /// The base in H.
    pub X_HB: Pose,
    /// Each joint's frame at position 0, in the frame of the link before.
    pub origins: Vec<Pose>,
}

/// Checks every number and name; the poses of each finger.
pub(super) fn check_hand(hand: &HandDescription) -> Result<Vec<FingerPoses>, HandError> {
    check_name(&hand.name, "name")?;
    let key = "fingertip_radius";
    check_field::<HandDescription>(key, &hand.fingertip_radius, key).map_err(hinted(MILLIMETRES))?;
    check_shapes("palm", &hand.palm)?;
    check_count("finger", hand.finger.len(), 1, MAX_FINGERS)?;
    let poses = hand
        .finger
        .iter()
        .enumerate()
        .map(|(index, finger)| check_finger(&format!("finger[{index}]"), finger))
        .collect::<Result<_, _>>()?;
    check_unique(hand)?;
    Ok(poses)
}

fn check_finger(key: &str, finger: &FingerDescription) -> Result<FingerPoses, HandError> {
    check_name(&finger.name, &format!("{key}.name"))?;
    let X_HB = check_pose(format!("{key}.base"), &finger.base)?;
    check_count(&format!("{key}.joint"), finger.joint.len(), 1, MAX_FINGER_JOINTS)?;
    let origins = finger
        .joint
        .iter()
        .enumerate()
        .map(|(index, joint)| check_joint(&format!("{key}.joint[{index}]"), joint))
        .collect::<Result<_, _>>()?;
    if !finger.tip.iter().all(|x| x.is_finite()) {
        return Err(HandError::NotFinite { key: format!("{key}.tip"), value: finger.tip });
    }
    check_rest(key, finger)?;
    for (index, joint) in finger.joint.iter().enumerate() {
        if let Some(mimic) = &joint.mimic {
            check_mimic(&format!("{key}.joint[{index}]"), mimic, joint, finger)?;
            let expected = mimic_position(mimic, finger, &finger.rest);
            check_driven(&format!("{key}.rest[{index}]"), finger.rest[index], expected)?;
        }
    }
    Ok(FingerPoses { X_HB, origins })
}

fn check_joint(key: &str, joint: &JointDescription) -> Result<Pose, HandError> {
    check_name(&joint.name, &format!("{key}.name"))?;
    let origin = check_pose(format!("{key}.origin"), &joint.origin)?;
    check_direction(&joint.axis, format!("{key}.axis"))?;
    let most = match joint.kind {
        JointKind::Revolute => MAX_TURN,
        JointKind::Prismatic => MAX_TRAVEL,
    };
    check_range(&format!("{key}.lower"), joint.lower, (-most, most), DEGREES)?;
    check_range(&format!("{key}.upper"), joint.upper, (-most, most), DEGREES)?;
    if joint.lower >= joint.upper {
        return Err(HandError::EmptyLimits { key: key.into(), lower: joint.lower, upper: joint.upper });
    }
    let rates =
        [("velocity", joint.velocity), ("acceleration", joint.acceleration), ("effort", joint.effort)];
    for (name, value) in rates {
        check_field::<JointDescription>(name, &value, &format!("{key}.{name}"))
            .map_err(hinted("; it must be positive"))?;
    }
    check_shapes(&format!("{key}.link"), &joint.link)?;
    Ok(origin)
}

fn check_rest(key: &str, finger: &FingerDescription) -> Result<(), HandError> {
    let (given, wanted) = (finger.rest.len(), finger.joint.len());
    if given != wanted {
        return Err(HandError::RestCount { key: format!("{key}.rest"), given, wanted });
    }
    for (index, (&q, joint)) in finger.rest.iter().zip(&finger.joint).enumerate() {
        let hint = "; the rest posture must lie within the joint's limits";
        check_range(&format!("{key}.rest[{index}]"), q, (joint.lower, joint.upper), hint)?;
    }
    Ok(())
}

/// How far (rad; m) a driven joint may be from where its driver has it, and beyond its limits.
const DRIVEN: f64 = 1e-9;

/// Where the driver, if the finger has it, puts a driven joint.
fn mimic_position(mimic: &Mimic, finger: &FingerDescription, joints: &[f64]) -> f64 {
    let driver = finger.joint.iter().position(|joint| joint.name == mimic.joint);
    mimic.multiplier * driver.map_or(0.0, |driver| joints[driver]) + mimic.offset
}

fn check_driven(key: &str, value: f64, expected: f64) -> Result<(), HandError> {
    let hint = "; the joint has a `mimic` and rests where its driver has it";
    check_range(key, value, (expected - DRIVEN, expected + DRIVEN), hint)
}

/// The driver must be another joint of the finger that moves by itself, and may not push the driven joint
/// beyond its limits.
fn check_mimic(
    key: &str,
    mimic: &Mimic,
    joint: &JointDescription,
    finger: &FingerDescription,
) -> Result<(), HandError> {
    let driver = finger.joint.iter().find(|driver| driver.name == mimic.joint && driver.mimic.is_none());
    let Some(driver) = driver else {
        let name = mimic.joint.clone();
        return Err(HandError::Driver { key: format!("{key}.mimic.joint"), name });
    };
    check_described(mimic, &format!("{key}.mimic")).map_err(hinted(DEGREES))?;
    let range = (joint.lower - DRIVEN, joint.upper + DRIVEN);
    for (end, position) in [("lower", driver.lower), ("upper", driver.upper)] {
        let driven = mimic.multiplier * position + mimic.offset;
        if !(range.0..=range.1).contains(&driven) {
            let (key, driver) = (key.into(), driver.name.clone());
            let limits = (joint.lower, joint.upper);
            return Err(HandError::DrivenTooFar { key, driver, end, driven, limits });
        }
    }
    Ok(())
}

/// The bodies that touch by construction; each name must be that of one body.
pub(super) fn check_touching(hand: &HandDescription) -> Result<Vec<BodyPair>, HandError> {
    let body = |pair: usize, side: usize| {
        let name = &hand.touching[pair][side];
        let unknown =
            || HandError::NoSuchBody { key: format!("touching[{pair}][{side}]"), name: name.clone() };
        hand.body_named(name).ok_or_else(unknown)
    };
    (0..hand.touching.len()).map(|pair| Ok((body(pair, 0)?, body(pair, 1)?))).collect()
}

/// Fingers' names must differ among each other, joints' names over the whole hand (exports need that).
fn check_unique(hand: &HandDescription) -> Result<(), HandError> {
    let fingers =
        hand.finger.iter().enumerate().map(|(f, finger)| (&finger.name, format!("finger[{f}].name")));
    let joints = hand.finger.iter().enumerate().flat_map(|(f, finger)| {
        let key = move |j| format!("finger[{f}].joint[{j}].name");
        finger.joint.iter().enumerate().map(move |(j, joint)| (&joint.name, key(j)))
    });
    first_duplicate(fingers.collect())?;
    first_duplicate(joints.collect())
}

fn first_duplicate(names: Vec<(&String, String)>) -> Result<(), HandError> {
    for (index, (name, key)) in names.iter().enumerate() {
        if let Some((_, first)) = names[..index].iter().find(|(earlier, _)| earlier == name) {
            let (key, first) = (key.clone(), first.clone());
            return Err(HandError::DuplicateName { key, name: (*name).clone(), first });
        }
    }
    Ok(())
}

fn check_shapes(key: &str, shapes: &[PlacedShape]) -> Result<(), HandError> {
    for (index, placed) in shapes.iter().enumerate() {
        let key = format!("{key}[{index}]");
        check_pose(format!("{key}.pose"), &placed.pose)?;
        check_link_shape(&format!("{key}.shape"), &placed.shape)?;
    }
    Ok(())
}

/// A shape by itself, and that it is no larger than a hand can be.
fn check_link_shape(key: &str, shape: &Shape) -> Result<(), HandError> {
    check_shape(shape, key)?;
    let Form::Primitive(primitive, _) = shape.form() else { return Ok(()) };
    check_range(key, primitive.half_size().max(), (0.0, MAX_TRAVEL), MILLIMETRES)
}

fn check_pose(key: String, pose: &PoseDescription) -> Result<Pose, HandError> {
    pose.pose().map_err(|error| HandError::Pose { key, error })
}

fn check_name(name: &str, key: &str) -> Result<(), HandError> {
    if name.trim().is_empty() {
        return Err(HandError::EmptyName { key: key.into() });
    }
    Ok(())
}

fn check_count(key: &str, given: usize, least: usize, most: usize) -> Result<(), HandError> {
    if (least..=most).contains(&given) {
        return Ok(());
    }
    Err(HandError::Count { key: key.into(), given, range: format!("{least}..={most}") })
}

fn check_range(key: &str, value: f64, (low, high): (f64, f64), hint: &'static str) -> Result<(), HandError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(HandError::Range { key: key.into(), value, range: format!("{low}..={high}"), hint })
}

/// A departure from the schema, with what is probably wrong.
fn hinted(hint: &'static str) -> impl Fn(Departure) -> HandError {
    move |departure| HandError::Departs { departure: Box::new(departure), hint }
}
