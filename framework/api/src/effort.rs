//! What the joints of a finger can do at its contact: plain data that a grasp may carry.

use crate::{FingerIndex, FingerJoints, Hand, MAX_FINGER_JOINTS, Pose, Vec3};

/// One joint's part in what its finger exerts: effort = column · f + spin · m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointBound {
    /// Velocity, in O, of the fingertip's material point at the contact per joint speed (m/rad; no unit where
    /// prismatic).
    pub column_O: Vec3,
    /// Angular velocity of the fingertip about the contact's *outward* normal per joint speed (no unit; 0
    /// where prismatic).
    pub spin: f64,
    /// The largest effort of the joint, either way (N·m; N where prismatic).
    pub limit: f64,
}

/// The joints of one finger at its contact: the columns of the contact's Jacobian, and the efforts' limits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EffortBounds {
    count: u8,
    joints: [JointBound; MAX_FINGER_JOINTS],
}

impl EffortBounds {
    /// From the joints, base to tip; at most [`MAX_FINGER_JOINTS`].
    pub fn from_joints(joints: impl IntoIterator<Item = JointBound>) -> Self {
        let mut bounds = Self::default();
        for joint in joints {
            bounds.joints[usize::from(bounds.count)] = joint;
            bounds.count += 1;
        }
        bounds
    }

    /// Those of a finger whose ball touches the object along the outward normal `n_O`, in O.
    ///
    /// The material point that touches lies at -r n from the ball's centre, so its velocity is J_v q' + J_w
    /// q' × (-r n).
    pub fn at(hand: &dyn Hand, finger: FingerIndex, joints: &FingerJoints, X_HO: &Pose, n_O: &Vec3) -> Self {
        let tip = hand.tip_kinematics(finger, joints);
        let n_H = X_HO.rotation * n_O;
        let lever_H = n_H * hand.fingertip_radius();
        let to_O = X_HO.rotation.inverse();
        let bound = |(j, limit): (usize, f64)| {
            let (v_H, w_H): (Vec3, Vec3) = (tip.J_v.column(j).into(), tip.J_w.column(j).into());
            JointBound { column_O: to_O * (v_H + lever_H.cross(&w_H)), spin: n_H.dot(&w_H), limit }
        };
        let limits = hand.finger(finger).joints.iter().map(|joint| joint.effort);
        Self::from_joints(limits.enumerate().map(bound))
    }

    /// The joints, base to tip.
    pub fn joints(&self) -> &[JointBound] {
        &self.joints[..usize::from(self.count)]
    }

    /// The same with every limit multiplied by `share` > 0.
    #[must_use]
    pub fn with_share(mut self, share: f64) -> Self {
        self.joints.iter_mut().for_each(|joint| joint.limit *= share);
        self
    }

    /// The joints' efforts (N·m; N) that exert a force on the object (N, in O) and a torque about the outward
    /// normal (N·m): Jᵀ f.
    pub fn efforts_of(&self, force_O: &Vec3, torsion: f64) -> FingerJoints {
        let mut efforts = FingerJoints::zeros(usize::from(self.count));
        for (effort, joint) in efforts.iter_mut().zip(self.joints()) {
            *effort = joint.column_O.dot(force_O) + joint.spin * torsion;
        }
        efforts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn efforts_are_the_power_per_joint_speed() {
        let joint = |column_O, spin| JointBound { column_O, spin, limit: 2.0 };
        let bounds = EffortBounds::from_joints([joint(Vec3::x() * 0.1, 0.5), joint(Vec3::z(), 0.0)]);
        let efforts = bounds.efforts_of(&Vec3::new(3.0, 4.0, 5.0), 0.2);
        assert_eq!(efforts.to_vec(), [0.1 * 3.0 + 0.5 * 0.2, 5.0]);
        assert!(bounds.with_share(0.5).joints().iter().all(|joint| joint.limit == 1.0));
    }
}
