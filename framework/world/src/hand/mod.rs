//! Hands of fingers that are serial chains of joints: forward and inverse kinematics, limits, frames of the links.

mod chain;
mod check;
mod error;
mod inverse;
mod reach;
mod screw;

pub use chain::{LinkFrame, LinkFrames};
pub use error::HandError;

use chain::FingerChain;
use check::FingerPoses;
use inverse::{Inverse, JointRange};
use regrasp_api::{
    FingerDescription, FingerIndex, FingerJoints, FingerModel, Hand, HandDescription, JointModel,
    PlacedShape, TipKinematics, Vec3,
};

/// A hand whose fingers are serial chains.
#[derive(Clone, Debug)]
pub struct ChainHand {
    description: HandDescription,
    fingers: Vec<Finger>,
}

/// What is prepared for one finger.
#[derive(Clone, Debug)]
struct Finger {
    model: FingerModel,
    chain: FingerChain,
    inverse: Inverse,
}

impl ChainHand {
    /// Checks a description and prepares its kinematics.
    pub fn new(description: HandDescription) -> Result<Self, HandError> {
        let poses = check::check_hand(&description)?;
        let fingers = description
            .finger
            .iter()
            .zip(&poses)
            .enumerate()
            .map(|(index, (finger, poses))| Finger::new(index, finger, poses))
            .collect::<Result<_, _>>()?;
        Ok(Self { description, fingers })
    }

    /// The description that the hand was made from.
    pub fn description(&self) -> &HandDescription {
        &self.description
    }

    /// The frames X_HL of the links of a finger, base to tip: link k is the one behind joint k. The fingertip's ball belongs to the last.
    ///
    /// No allocation: `let mut room = LinkFrame::room(); let frames = hand.link_frames(finger, joints, &mut room);`
    #[inline]
    pub fn link_frames<'a>(
        &self,
        finger: FingerIndex,
        joints: &FingerJoints,
        room: &'a mut LinkFrames,
    ) -> &'a [LinkFrame] {
        self.fingers[finger.index()].chain.frames(joints, room)
    }

    /// The shapes of link `link` (0 = behind the first joint), in the link's frame; many links have none.
    pub fn link_shapes(&self, finger: FingerIndex, link: usize) -> &[PlacedShape] {
        &self.description.finger[finger.index()].joint[link].link
    }

    /// How many links a finger has: as many as joints.
    pub fn link_count(&self, finger: FingerIndex) -> usize {
        self.description.finger[finger.index()].joint.len()
    }

    /// Whether the inverse kinematics of a finger is in closed form (otherwise Levenberg-Marquardt).
    pub fn is_closed_form(&self, finger: FingerIndex) -> bool {
        self.fingers[finger.index()].inverse.is_closed_form()
    }

    /// The shapes of the palm, in the hand's frame.
    pub fn palm_shapes(&self) -> &[PlacedShape] {
        &self.description.palm
    }

    /// Whether two links of one finger meet at a joint: no link with a shape lies between them.
    pub fn consecutive(&self, finger: FingerIndex, a: usize, b: usize) -> bool {
        let (low, high) = (a.min(b), a.max(b));
        (low + 1..high).all(|between| self.link_shapes(finger, between).is_empty())
    }
}

impl Finger {
    fn new(index: usize, finger: &FingerDescription, poses: &FingerPoses) -> Result<Self, HandError> {
        let chain = FingerChain::new(finger, &poses.X_HB, &poses.origins);
        let ranges: Vec<_> =
            finger.joint.iter().map(|joint| JointRange::new(joint.lower, joint.upper)).collect();
        let rest = FingerJoints::from_slice(&finger.rest);
        let inverse = Inverse::new(&chain, &ranges, &rest).map_err(|conditioning| {
            HandError::TooFewIndependentJoints {
                finger: finger.name.clone(),
                key: format!("finger[{index}]"),
                independent: conditioning.independent,
            }
        })?;
        let (p_HReach, reach) = reach::reach_ball(&chain.screws, &chain.p_HF0, &ranges);
        let model = FingerModel {
            name: finger.name.clone(),
            joints: finger.joint.iter().map(joint_model).collect(),
            spare: (0..ranges.len()).filter(|joint| !inverse.solved().contains(joint)).collect(),
            rest,
            p_HReach,
            reach,
        };
        Ok(Self { model, chain, inverse })
    }
}

fn joint_model(joint: &regrasp_api::JointDescription) -> JointModel {
    JointModel {
        name: joint.name.clone(),
        kind: joint.kind,
        lower: joint.lower,
        upper: joint.upper,
        velocity: joint.velocity,
        acceleration: joint.acceleration,
        effort: joint.effort,
    }
}

impl Hand for ChainHand {
    fn finger_count(&self) -> usize {
        self.fingers.len()
    }

    fn finger(&self, finger: FingerIndex) -> &FingerModel {
        &self.fingers[finger.index()].model
    }

    fn fingertip_radius(&self) -> f64 {
        self.description.fingertip_radius
    }

    fn tip_center(&self, finger: FingerIndex, joints: &FingerJoints) -> Vec3 {
        self.fingers[finger.index()].chain.tip_center(joints)
    }

    fn tip_kinematics(&self, finger: FingerIndex, joints: &FingerJoints) -> TipKinematics {
        self.fingers[finger.index()].chain.tip_kinematics(joints)
    }

    fn inverse(&self, finger: FingerIndex, p_HF: &Vec3, near: &FingerJoints) -> Option<FingerJoints> {
        let Finger { chain, inverse, .. } = &self.fingers[finger.index()];
        inverse.solve(chain, p_HF, near)
    }
}
