//! One finger as a chain of joints: forward kinematics, frames of the links, Jacobians.

use super::coupling::{self, Coupling};
use super::screw::Screw;
use nalgebra::{Isometry3, Rotation3, Translation3};
use regrasp_api::{
    FingerDescription, FingerJoints, JointKind, MAX_FINGER_JOINTS, Mat3, Pose, Rotation, TipJacobian,
    TipKinematics, Vec3, cross_matrix,
};

/// The frame of a link L in the hand's frame H, with the rotation as a matrix: cheaper to apply to points
/// than a [`Pose`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkFrame {
    /// Orientation of L in H.
    pub R_HL: Mat3,
    /// Origin of L in H (m).
    pub p_HL: Vec3,
}

/// Room for the frames of one finger's links: make one on the stack with [`LinkFrame::room`].
pub type LinkFrames = [LinkFrame; MAX_FINGER_JOINTS];

impl LinkFrame {
    /// The hand's frame itself.
    pub const IDENTITY: Self =
        Self { R_HL: Mat3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), p_HL: Vec3::new(0.0, 0.0, 0.0) };

    /// Room for the frames of one finger.
    pub const fn room() -> LinkFrames {
        [Self::IDENTITY; MAX_FINGER_JOINTS]
    }

    /// A point of the link, given in L (m), in the hand's frame (m).
    #[inline]
    pub fn point(&self, p_LP: &Vec3) -> Vec3 {
        self.R_HL * p_LP + self.p_HL
    }

    /// The frame as a pose.
    pub fn pose(&self) -> Pose {
        Isometry3::from_parts(Translation3::from(self.p_HL), rotation(&self.R_HL))
    }
}

impl From<&Pose> for LinkFrame {
    fn from(X_HL: &Pose) -> Self {
        Self { R_HL: X_HL.rotation.to_rotation_matrix().into_inner(), p_HL: X_HL.translation.vector }
    }
}

fn rotation(R: &Mat3) -> Rotation {
    Rotation::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*R))
}

/// The step from the frame of the link before (P) to the frame of the joint's own link (L).
///
/// Revolute: R_PL(q) = R0 + sin q · R0 K + (1 - cos q) · R0 K², K = [a]× (Rodrigues). Prismatic: p_PL(q) = p0
/// + q R0 a.
#[derive(Clone, Debug)]
struct LinkStep {
    kind: JointKind,
    /// The unit axis, in L.
    axis_L: Vec3,
    /// The unit axis, in P.
    axis_P: Vec3,
    R0: Mat3,
    R0_K: Mat3,
    R0_KK: Mat3,
    p0: Vec3,
}

impl LinkStep {
    fn new(kind: JointKind, X_PL0: &Pose, axis_L: Vec3) -> Self {
        let LinkFrame { R_HL: R0, p_HL: p0 } = X_PL0.into();
        let K = cross_matrix(&axis_L);
        Self { kind, axis_L, axis_P: R0 * axis_L, R0, R0_K: R0 * K, R0_KK: R0 * K * K, p0 }
    }

    #[inline]
    fn frame(&self, X_HP: &LinkFrame, q: f64) -> LinkFrame {
        let (R_PL, p_PL) = match self.kind {
            JointKind::Revolute => {
                let (sin, cos) = q.sin_cos();
                (self.R0 + self.R0_K * sin + self.R0_KK * (1.0 - cos), self.p0)
            }
            JointKind::Prismatic => (self.R0, self.p0 + self.axis_P * q),
        };
        LinkFrame { R_HL: X_HP.R_HL * R_PL, p_HL: X_HP.point(&p_PL) }
    }
}

/// A finger's geometry, in two forms: link after link, and as screws in H (product of exponentials).
///
/// The second needs no matrices to place the tip alone (Brockett, "Robotic manipulators and the product of
/// exponentials formula", MTNS 1983): p_HF = e₁(q₁) … eₙ(qₙ) p_HF(0).
#[derive(Clone, Debug)]
pub(super) struct FingerChain {
    X_HB: LinkFrame,
    steps: Vec<LinkStep>,
    p_LF: Vec3,
    /// The joints' screws in H, all joints at 0.
    pub screws: Vec<Screw>,
    /// The fingertip's centre in H, all joints at 0 (m).
    pub p_HF0: Vec3,
    /// The joints that others drive; whatever positions they are given, they are taken to be where their
    /// drivers have them.
    pub couplings: Vec<Coupling>,
}

impl FingerChain {
    /// The chain of a finger whose description was checked; `X_HB` and `origins` are its poses.
    pub fn new(finger: &FingerDescription, X_HB: &Pose, origins: &[Pose]) -> Self {
        let steps: Vec<_> = finger
            .joint
            .iter()
            .zip(origins)
            .map(|(joint, X_PL0)| LinkStep::new(joint.kind, X_PL0, Vec3::from(joint.axis).normalize()))
            .collect();
        let mut chain = Self {
            X_HB: X_HB.into(),
            steps,
            p_LF: finger.tip.into(),
            screws: Vec::new(),
            p_HF0: Vec3::zeros(),
            couplings: Vec::new(),
        };
        let zero = FingerJoints::zeros(chain.steps.len());
        let mut room = LinkFrame::room();
        let frames = chain.frames(&zero, &mut room);
        let screws = frames
            .iter()
            .zip(&chain.steps)
            .map(|(X_HL, step)| Screw::new(step.kind, X_HL.R_HL * step.axis_L, X_HL.p_HL))
            .collect();
        chain.p_HF0 = frames.last().unwrap_or(&chain.X_HB).point(&chain.p_LF);
        chain.screws = screws;
        // Only now: the screws are those of joints that all stand at 0.
        chain.couplings = coupling::couplings(finger);
        chain
    }

    /// The frames of all links, base to tip.
    #[inline]
    pub fn frames<'a>(&self, joints: &FingerJoints, room: &'a mut LinkFrames) -> &'a [LinkFrame] {
        let joints = &self.settled(joints);
        let mut X_HL = self.X_HB;
        for ((step, &q), frame) in self.steps.iter().zip(joints.iter()).zip(room.iter_mut()) {
            X_HL = step.frame(&X_HL, q);
            *frame = X_HL;
        }
        &room[..self.steps.len()]
    }

    /// The fingertip's centre in H (m).
    #[inline]
    pub fn tip_center(&self, joints: &FingerJoints) -> Vec3 {
        let joints = &self.settled(joints);
        self.screws.iter().zip(joints.iter()).rev().fold(self.p_HF0, |p, (screw, &q)| screw.move_point(&p, q))
    }

    /// The joints, with the driven ones where their drivers have them.
    #[inline]
    fn settled(&self, joints: &FingerJoints) -> FingerJoints {
        let mut joints = *joints;
        coupling::settle(&self.couplings, &mut joints);
        joints
    }

    /// Centre, orientation and Jacobians of the fingertip; the columns of driven joints are zero, their
    /// drivers' hold what both do.
    pub fn tip_kinematics(&self, joints: &FingerJoints) -> TipKinematics {
        let mut room = LinkFrame::room();
        let frames = self.frames(joints, &mut room);
        let X_HL = frames.last().copied().unwrap_or(self.X_HB);
        let p_HF = X_HL.point(&self.p_LF);
        let (mut J_v, mut J_w) = (TipJacobian::zeros(), TipJacobian::zeros());
        for (k, (frame, step)) in frames.iter().zip(&self.steps).enumerate() {
            let axis_H = frame.R_HL * step.axis_L;
            match step.kind {
                JointKind::Revolute => {
                    J_v.set_column(k, &axis_H.cross(&(p_HF - frame.p_HL)));
                    J_w.set_column(k, &axis_H);
                }
                JointKind::Prismatic => J_v.set_column(k, &axis_H),
            }
        }
        coupling::fold(&self.couplings, &mut J_v);
        coupling::fold(&self.couplings, &mut J_w);
        TipKinematics { p_HF, R_HF: rotation(&X_HL.R_HL), J_v, J_w }
    }
}
