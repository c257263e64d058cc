//! The verifier's own forward kinematics, straight from the hand's description.

use nalgebra::{Translation3, Unit};
use regrasp_api::{
    FingerDescription, HandDescription, JointDescription, JointKind, MAX_FINGER_JOINTS, MAX_FINGERS, Pose,
    Rotation, Vec3,
};
use std::ops::Range;

/// All fingers; joints and links are counted through, finger after finger.
#[derive(Debug)]
pub(crate) struct Chains {
    pub(crate) fingers: Vec<Chain>,
    pub(crate) tip_radius: f64,
    /// How many joints the hand has.
    pub(crate) joint_count: usize,
}

/// One finger.
#[derive(Debug)]
pub(crate) struct Chain {
    pub(crate) joints: Vec<Joint>,
    /// Centre of the fingertip's ball in the last link's frame (m).
    pub(crate) p_LTip: Vec3,
    /// Index of its first joint among all joints.
    pub(crate) first: usize,
    /// The joints that others drive.
    pub(crate) driven: Vec<Driven>,
}

/// A joint that another one of its finger drives: q[joint] = multiplier · q[driver] + offset.
#[derive(Debug)]
pub(crate) struct Driven {
    pub(crate) joint: usize,
    pub(crate) driver: usize,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

/// One joint and its limits.
#[derive(Debug)]
pub(crate) struct Joint {
    pub(crate) kind: JointKind,
    X_PJ: Pose,
    /// Whether X_PJ turns, and whether it shifts at all: most joints do one alone.
    does_turn: bool,
    does_shift: bool,
    pub(crate) axis: Unit<Vec3>,
    pub(crate) lower: f64,
    pub(crate) upper: f64,
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
    pub(crate) effort: f64,
}

impl Chains {
    /// The chains of a description; `Err` says what makes no sense in it.
    pub(crate) fn new(hand: &HandDescription) -> Result<Self, String> {
        let count = hand.finger.len();
        if !(1..=MAX_FINGERS).contains(&count) {
            return Err(format!("the hand has {count} fingers, 1 to {MAX_FINGERS} are possible"));
        }
        if !(hand.fingertip_radius > 0.0 && hand.fingertip_radius < 1e3) {
            return Err(format!("the fingertip radius {} m is not positive", hand.fingertip_radius));
        }
        let (mut fingers, mut first) = (Vec::new(), 0);
        for finger in &hand.finger {
            fingers.push(Chain::new(finger, first).map_err(|e| format!("finger `{}`: {e}", finger.name))?);
            first += finger.joint.len();
        }
        Ok(Self { fingers, tip_radius: hand.fingertip_radius, joint_count: first })
    }

    /// Which finger and joint of it the joint counted through is.
    pub(crate) fn owner(&self, joint: usize) -> (usize, usize) {
        let finger = self.fingers.iter().rposition(|chain| chain.first <= joint).unwrap_or(0);
        (finger, joint - self.fingers[finger].first)
    }

    /// Every joint, counted through.
    pub(crate) fn joints(&self) -> impl Iterator<Item = &Joint> {
        self.fingers.iter().flat_map(|chain| &chain.joints)
    }
}

impl Chain {
    fn new(finger: &FingerDescription, first: usize) -> Result<Self, String> {
        let count = finger.joint.len();
        if !(1..=MAX_FINGER_JOINTS).contains(&count) {
            return Err(format!("{count} joints, 1 to {MAX_FINGER_JOINTS} are possible"));
        }
        let X_HBase = finger.base.pose().map_err(|error| error.to_string())?;
        let p_LTip = Vec3::from(finger.tip);
        if !p_LTip.iter().all(|x| x.is_finite()) {
            return Err("`tip` is not finite".into());
        }
        let mut joints = finger.joint.iter().map(Joint::new).collect::<Result<Vec<_>, _>>()?;
        let X_HJ = X_HBase * joints[0].X_PJ;
        joints[0].set_origin(X_HJ);
        let driven = driven(finger)?;
        Ok(Self { joints, p_LTip, first, driven })
    }

    /// Its joints among all joints.
    pub(crate) fn range(&self) -> Range<usize> {
        self.first..self.first + self.joints.len()
    }

    /// The frames of all links in H, base to tip.
    pub(crate) fn frames(&self, joints: &[f64], frames: &mut [Pose]) {
        let mut X_HP = Pose::identity();
        for ((joint, &q), frame) in self.joints.iter().zip(joints).zip(frames) {
            if joint.does_shift {
                X_HP.translation.vector += X_HP.rotation * joint.X_PJ.translation.vector;
            }
            if joint.does_turn {
                X_HP.rotation *= joint.X_PJ.rotation;
            }
            match joint.kind {
                JointKind::Revolute => X_HP.rotation *= Rotation::from_axis_angle(&joint.axis, q),
                JointKind::Prismatic => X_HP *= Translation3::from(joint.axis.into_inner() * q),
            }
            *frame = X_HP;
        }
    }

    /// For each joint up to the one of `link`: how far (m) a point of that link can move for one unit of the
    /// joint, if it is within `reach` (m) of the link's origin and prismatic joint j within `travel[j]` (m)
    /// of its zero.
    pub(crate) fn levers(&self, link: usize, reach: f64, travel: &[f64]) -> [f64; MAX_FINGER_JOINTS] {
        let mut levers = [0.0; MAX_FINGER_JOINTS];
        let mut distance = reach;
        for j in (0..=link).rev() {
            let joint = &self.joints[j];
            levers[j] = match joint.kind {
                JointKind::Revolute => distance,
                JointKind::Prismatic => 1.0,
            };
            distance += joint.X_PJ.translation.vector.norm();
            if joint.kind == JointKind::Prismatic {
                distance += travel[j];
            }
        }
        levers
    }
}

fn driven(finger: &FingerDescription) -> Result<Vec<Driven>, String> {
    let mut driven = Vec::new();
    for (joint, description) in finger.joint.iter().enumerate() {
        let Some(mimic) = &description.mimic else { continue };
        let driver = finger.joint.iter().position(|other| other.name == mimic.joint && other.mimic.is_none());
        let (multiplier, offset) = (mimic.multiplier, mimic.offset);
        match driver {
            Some(driver) if multiplier.is_finite() && offset.is_finite() => {
                driven.push(Driven { joint, driver, multiplier, offset });
            }
            _ => return Err(format!("joint `{}`: its `mimic` makes no sense", description.name)),
        }
    }
    Ok(driven)
}

impl Joint {
    fn new(joint: &JointDescription) -> Result<Self, String> {
        let named = |what: &str| format!("joint `{}`: {what}", joint.name);
        let X_PJ = joint.origin.pose().map_err(|error| named(&error.to_string()))?;
        let axis = Vec3::from(joint.axis);
        if !(axis.norm().is_finite() && axis.norm() > 1e-9) {
            return Err(named("`axis` must be finite and not zero"));
        }
        let limits = [joint.lower, joint.upper, joint.velocity, joint.acceleration, joint.effort];
        let positive = joint.velocity > 0.0 && joint.acceleration > 0.0 && joint.effort > 0.0;
        if !(limits.iter().all(|x| x.is_finite()) && positive && joint.lower <= joint.upper) {
            return Err(named("its limits must be finite, in order, and positive for the rates"));
        }
        let (velocity, acceleration) = (joint.velocity, joint.acceleration);
        let (lower, upper) = (joint.lower, joint.upper);
        let axis = Unit::new_normalize(axis);
        let effort = joint.effort;
        let (does_turn, does_shift) = (true, true);
        let mut made = Self {
            kind: joint.kind,
            X_PJ,
            does_turn,
            does_shift,
            axis,
            lower,
            upper,
            velocity,
            acceleration,
            effort,
        };
        made.set_origin(X_PJ);
        Ok(made)
    }

    fn set_origin(&mut self, X_PJ: Pose) {
        self.X_PJ = X_PJ;
        self.does_turn = X_PJ.rotation != Rotation::identity();
        self.does_shift = X_PJ.translation.vector != Vec3::zeros();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A base turned by 90° about z, a revolute joint about y, a prismatic one along x, one link of 0.3 m.
    fn finger() -> FingerDescription {
        let text = r#"{
            "name": "f", "tip": [0.3, 0, 0], "rest": [0, 0],
            "base": {"position": [1, 2, 3], "axis": [0, 0, 1], "angle_deg": 90},
            "joint": [
                {"name": "a", "axis": [0, 2, 0], "lower": -2, "upper": 2},
                {"name": "b", "kind": "prismatic", "origin": {"position": [0.5, 0, 0]}, "axis": [1, 0, 0], "lower": -0.1, "upper": 0.1}
            ]
        }"#;
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn frames_follow_the_chain() {
        let chain = Chain::new(&finger(), 0).unwrap();
        let mut frames = [Pose::identity(); 2];
        chain.frames(&[std::f64::consts::FRAC_PI_2, 0.1], &mut frames);
        // About y by 90°, x becomes -z; the base turns the rest: 0.5 + 0.1 + 0.3 m straight down from the
        // base.
        let tip = frames[1] * nalgebra::Point3::from(chain.p_LTip);
        assert!((tip.coords - Vec3::new(1.0, 2.0, 3.0 - 0.9)).norm() < 1e-12, "{tip}");
    }

    #[test]
    fn levers_bound_every_motion() {
        let chain = Chain::new(&finger(), 0).unwrap();
        let levers = chain.levers(1, 0.3, &[2.0, 0.1]);
        assert!((levers[0] - 0.9).abs() < 1e-12 && levers[1] == 1.0, "{levers:?}");
        assert_eq!(levers[2..], [0.0; MAX_FINGER_JOINTS - 2]);
    }

    #[test]
    fn chains_without_sense_are_refused() {
        let mut finger = finger();
        finger.joint[1].axis = [0.0; 3];
        assert!(Chain::new(&finger, 0).unwrap_err().contains("`b`"));
        finger.joint.clear();
        assert!(Chain::new(&finger, 0).is_err());
    }
}
