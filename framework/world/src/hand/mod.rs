//! Hands of fingers that are serial chains of joints: forward and inverse kinematics, limits, frames of the
//! links.
//!
//! [`ChainHand::new`] checks a [`HandDescription`] (what a file under `scenarios/hands` holds) and prepares
//! it; the hand then answers the planner through [`Hand`] and the clearance through
//! [`ChainHand::link_frames`] and its siblings. A bad description is refused with a [`HandError`] that names
//! the key.
//!
//! | question | file |
//! |---|---|
//! | Where is the tip, where are the links, how do they move? | `chain.rs` (a joint's motion: `screw.rs`) |
//! | ... for many postures at once? | `batch.rs`, vector arithmetic in `lanes.rs` |
//! | Which joints put the tip there? | `inverse/mod.rs` |
//! | ... for abduction and two flexions, in closed form | `inverse/parallel.rs` |
//! | ... for any three joints, numerically | `inverse/numeric.rs` |
//! | Which joints do others drive? | `coupling.rs` |
//! | Which three joints are solved for, which are spare? | `inverse/spare.rs` |
//! | What remains of a finger while its spare joints stand still? | `inverse/triple.rs` |
//! | Does an angle fit a joint's limits? | `inverse/range.rs` |
//! | Which ball holds all places that the tip can reach? | `reach.rs` |
//! | Is the description sound? | `check.rs`, messages in `error.rs` |
//!
//! # Frames
//! H is the hand (palm, fixed in the world), B a finger's base, L the link behind a joint. Link k's frame is
//! the moved frame of joint k: X_HLₖ(q) = X_HB · origin₀ · motion₀(q₀) ⋯ originₖ · motionₖ(qₖ). The
//! fingertip's ball F is centred at the description's `tip` in the last link's frame, and turns with it.
//!
//! # Inverse kinematics
//! Three joints of each finger are solved for. With more, the best conditioned three are chosen, those with a
//! closed form first (the rule in full: `spare::choose`); the others are the model's `spare` and stay where
//! `near` has them.
//!
//! - Three revolute joints, the last two or the first two parallel: closed form. All solutions are found (up
//!   to four); the axes may meet or not and stand at any angle.
//! - Three prismatic joints: closed form; the solution is unique.
//! - A finger with a joint that another drives, and anything else: Levenberg-Marquardt from `near`, then from
//!   ten fixed other starts. It may miss a solution, never invent one.
//!
//! A solution within 1e-10 (rad; m) of a limit is moved onto it. "Closest to `near`" means the smallest sum
//! of squared differences over the three joints; the numeric method takes the solution that continues from
//! `near` if there is one.

mod batch;
mod chain;
mod check;
mod coupling;
mod error;
mod inverse;
mod lanes;
mod reach;
mod screw;

pub use batch::Columns;
pub use chain::{LinkFrame, LinkFrames};
pub use error::HandError;

use chain::FingerChain;
use check::FingerPoses;
use inverse::{Inverse, JointRange};
use nalgebra::Point3;
use regrasp_api::{
    Body, BodyPair, FingerDescription, FingerIndex, FingerJoints, FingerModel, Hand, HandDescription,
    JointDescription, JointModel, PlacedShape, TipKinematics, Vec3,
};

/// A hand whose fingers are serial chains of revolute or prismatic joints.
///
/// ```
/// use regrasp_api::{FingerIndex, Hand, HandDescription};
/// use regrasp_world::ChainHand;
///
/// # let text = include_str!("../../../../scenarios/hands/four-finger.toml");
/// let description: HandDescription = toml::from_str(text)?; // scenarios/hands/four-finger.toml
/// let hand = ChainHand::new(description)?;
/// let finger = FingerIndex(0);
/// let rest = hand.finger(finger).rest;
/// let mut p_HF = hand.tip_center(finger, &rest);
/// p_HF.z += 0.005;
/// let raised = hand.inverse(finger, &p_HF, &rest).expect("5 mm higher is within reach");
/// assert!((hand.tip_center(finger, &raised) - p_HF).norm() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ChainHand {
    description: HandDescription,
    fingers: Vec<Finger>,
    /// Pairs that touch by construction.
    touching: Vec<BodyPair>,
}

/// What is prepared for one finger.
#[derive(Clone, Debug)]
struct Finger {
    model: FingerModel,
    chain: FingerChain,
    inverse: Inverse,
}

impl ChainHand {
    /// Checks a description and prepares its kinematics (about half a millisecond for each kind of finger).
    pub fn new(description: HandDescription) -> Result<Self, HandError> {
        let poses = check::check_hand(&description)?;
        let mut fingers: Vec<Finger> = Vec::with_capacity(poses.len());
        for (index, (finger, pose)) in description.finger.iter().zip(&poses).enumerate() {
            // Hands have the same finger several times: what it can reach is looked for once.
            let alike = (0..index).find(|&other| is_alike(&description.finger[other], finger));
            let known = alike.map(|other| {
                let (model, X_HHOther) = (&fingers[other].model, pose.X_HB * poses[other].X_HB.inverse());
                ((X_HHOther * Point3::from(model.p_HReach)).coords, model.reach)
            });
            fingers.push(Finger::new(index, finger, pose, known)?);
        }
        let touching = check::check_touching(&description)?;
        Ok(Self { description, fingers, touching })
    }

    /// The description that the hand was made from.
    pub fn description(&self) -> &HandDescription {
        &self.description
    }

    /// The frames X_HL of the links of a finger, base to tip: link k is the one behind joint k. The
    /// fingertip's ball belongs to the last.
    ///
    /// No allocation: `let mut room = LinkFrame::room(); let frames = hand.link_frames(finger, joints, &mut
    /// room);`
    #[inline]
    pub fn link_frames<'a>(
        &self,
        finger: FingerIndex,
        joints: &FingerJoints,
        room: &'a mut LinkFrames,
    ) -> &'a [LinkFrame] {
        self.fingers[finger.index()].chain.frames(joints, room)
    }

    /// The fingertip's centre in H (m), as [`Hand::tip_center`] has it, for each row of joint positions of
    /// the finger, into three columns.
    ///
    /// Some 5 ns a joint.
    pub fn tip_centers(
        &self,
        finger: FingerIndex,
        joints: &Columns<&[f64]>,
        centers: &mut Columns<&mut [f64]>,
    ) {
        self.fingers[finger.index()].chain.tip_centers(joints, centers);
    }

    /// The Jacobian J_v of [`Hand::tip_kinematics`] for each row of joint positions of the finger: its three
    /// rows, each of a column a joint, one after the other.
    pub fn tip_jacobians(
        &self,
        finger: FingerIndex,
        joints: &Columns<&[f64]>,
        jacobians: &mut Columns<&mut [f64]>,
    ) {
        self.fingers[finger.index()].chain.tip_jacobians(joints, jacobians);
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

    /// Whether the description says that two bodies of the hand touch by construction.
    pub fn touching(&self, a: Body, b: Body) -> bool {
        self.touching.contains(&(a, b)) || self.touching.contains(&(b, a))
    }

    /// Whether some body of the finger touches one of another finger by construction.
    pub(crate) fn touches_other_finger(&self, finger: FingerIndex) -> bool {
        let owner = |body: Body| match body {
            Body::Link(finger, _) | Body::Fingertip(finger) => Some(finger),
            _ => None,
        };
        let ends = self.touching.iter().map(|&(a, b)| (owner(a), owner(b)));
        ends.filter(|(a, b)| a.is_some() && b.is_some() && a != b)
            .any(|(a, b)| a == Some(finger) || b == Some(finger))
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
    /// `known` is the ball of what it can reach, where it is known.
    fn new(
        index: usize,
        finger: &FingerDescription,
        poses: &FingerPoses,
        known: Option<(Vec3, f64)>,
    ) -> Result<Self, HandError> {
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
        let (p_HReach, reach) =
            known.unwrap_or_else(|| reach::reach_ball(&chain.screws, &chain.p_HF0, &ranges));
        let is_spare =
            |joint: usize| !inverse.solved().contains(&joint) && finger.joint[joint].mimic.is_none();
        let model = FingerModel {
            name: finger.name.clone(),
            joints: finger.joint.iter().map(joint_model).collect(),
            spare: (0..ranges.len()).filter(|&joint| is_spare(joint)).collect(),
            rest,
            p_HReach,
            reach,
        };
        Ok(Self { model, chain, inverse })
    }
}

/// Whether two fingers move alike, wherever their bases are.
fn is_alike(a: &FingerDescription, b: &FingerDescription) -> bool {
    let is_same = |(a, b): (&JointDescription, &JointDescription)| {
        let (origin, axis, kind) = (a.origin == b.origin, a.axis == b.axis, a.kind == b.kind);
        origin && axis && kind && a.lower == b.lower && a.upper == b.upper
    };
    a.tip == b.tip && a.joint.len() == b.joint.len() && a.joint.iter().zip(&b.joint).all(is_same)
}

fn joint_model(joint: &JointDescription) -> JointModel {
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

    fn fingertip(&self) -> regrasp_api::Fingertip {
        self.description.fingertip
    }

    fn tip_center(&self, finger: FingerIndex, joints: &FingerJoints) -> Vec3 {
        self.fingers[finger.index()].chain.tip_center(joints)
    }

    fn tip_kinematics(&self, finger: FingerIndex, joints: &FingerJoints) -> TipKinematics {
        self.fingers[finger.index()].chain.tip_kinematics(joints)
    }

    fn inverse(&self, finger: FingerIndex, p_HF: &Vec3, near: &FingerJoints) -> Option<FingerJoints> {
        let Finger { model, chain, inverse } = &self.fingers[finger.index()];
        if (p_HF - model.p_HReach).norm_squared() > model.reach * model.reach {
            return None;
        }
        inverse.solve(chain, p_HF, near)
    }

    fn settle(&self, finger: FingerIndex, joints: &mut FingerJoints) {
        coupling::settle(&self.fingers[finger.index()].chain.couplings, joints);
    }
}
