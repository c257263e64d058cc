//! Kinematics and limits of the hand.

use crate::{FingerIndex, FingerJoints, Fingertip, JointKind, MAX_FINGER_JOINTS, Rotation, Vec3};
use nalgebra::SMatrix;

/// A matrix with three rows and a column for each joint; columns beyond the finger's joints are zero.
pub type TipJacobian = SMatrix<f64, 3, MAX_FINGER_JOINTS>;

/// One joint's limits.
#[derive(Clone, Debug, PartialEq)]
pub struct JointModel {
    /// The joint's name.
    pub name: String,
    /// How it moves.
    pub kind: JointKind,
    /// Lowest position (rad; m where prismatic).
    pub lower: f64,
    /// Highest position (rad; m where prismatic).
    pub upper: f64,
    /// Largest speed (rad/s; m/s).
    pub velocity: f64,
    /// Largest acceleration (rad/s²; m/s²).
    pub acceleration: f64,
    /// Largest effort (N·m; N).
    pub effort: f64,
}

/// One finger's data that never change.
#[derive(Clone, Debug, PartialEq)]
pub struct FingerModel {
    /// The finger's name.
    pub name: String,
    /// The joints, base to tip.
    pub joints: Vec<JointModel>,
    /// The joints beyond the three that inverse kinematics solves for: the sampler chooses them.
    pub spare: Vec<usize>,
    /// The posture that the finger takes when it rests free.
    pub rest: FingerJoints,
    /// A ball that holds every reachable fingertip centre: its centre in H (m) ...
    pub p_HReach: Vec3,
    /// ... and radius (m).
    pub reach: f64,
}

/// The fingertip's place and first derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct TipKinematics {
    /// Centre of the fingertip's ball in H (m).
    pub p_HF: Vec3,
    /// Orientation of the fingertip's frame in H.
    pub R_HF: Rotation,
    /// Velocity of the centre, in H, per joint speed.
    pub J_v: TipJacobian,
    /// Angular velocity of the fingertip, in H, per joint speed; zero for prismatic joints.
    pub J_w: TipJacobian,
}

/// Forward and inverse kinematics of a hand with spherical fingertips.
pub trait Hand: Send + Sync {
    /// How many fingers.
    fn finger_count(&self) -> usize;

    /// What never changes about a finger.
    fn finger(&self, finger: FingerIndex) -> &FingerModel;

    /// Radius of every fingertip's ball (m).
    fn fingertip_radius(&self) -> f64;

    /// What the fingertips do on the object in a transfer: balls roll, points stay.
    fn fingertip(&self) -> Fingertip {
        Fingertip::Ball
    }

    /// Centre of the fingertip in H (m).
    fn tip_center(&self, finger: FingerIndex, joints: &FingerJoints) -> Vec3;

    /// Centre, orientation and Jacobians of the fingertip in H.
    fn tip_kinematics(&self, finger: FingerIndex, joints: &FingerJoints) -> TipKinematics;

    /// Joint positions within the limits that bring the fingertip's centre to `p_HF` (m, in H), or `None`.
    ///
    /// Spare joints keep their positions of `near`; among several solutions the one closest to `near` is
    /// taken, so that a continuous motion of the fingertip gives a continuous motion of the joints. Exact to
    /// 1e-9 m.
    fn inverse(&self, finger: FingerIndex, p_HF: &Vec3, near: &FingerJoints) -> Option<FingerJoints>;

    /// Puts the joints that others drive (mimic joints) where those have them; nothing to do in a hand
    /// without such joints.
    ///
    /// The hand's own answers take driven joints to be there already: code that changes joints in another way
    /// than by [`Hand::inverse`] or by interpolation between two settled postures calls this before it stores
    /// them.
    fn settle(&self, _finger: FingerIndex, _joints: &mut FingerJoints) {}

    /// Whether every joint is within its limits.
    fn within_limits(&self, finger: FingerIndex, joints: &FingerJoints) -> bool {
        let models = &self.finger(finger).joints;
        joints.iter().zip(models).all(|(&q, joint)| (joint.lower..=joint.upper).contains(&q))
    }
}
const _: Option<&dyn Hand> = None; // must stay object safe
