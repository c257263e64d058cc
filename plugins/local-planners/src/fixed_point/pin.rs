//! One step of the object with the fingertips pinned to it.

use crate::common::Levers;
use crate::rolling::constraint::ContactJacobian;
use crate::transfer::Motion;
use regrasp_api::{Configuration, FingerIndex, FingerJoints, Pose, Reason, Task, Vec3};

/// What stays the same during one transfer.
pub(crate) struct Pinned<'a> {
    pub task: &'a Task<'a>,
    pub levers: &'a Levers,
    pub motion: Motion,
    /// The holding fingers, with where their fingertips' centres are on the object (m, in O).
    pub pins: Vec<(FingerIndex, Vec3)>,
    /// The most (m) that a fingertip's centre strays from its place between two states.
    pub stray: f64,
    /// The most (m) that a finger travels in one step.
    pub travel: f64,
}

/// Why a step was not made.
pub(crate) enum Failure {
    /// In between the fingertips stray, or a finger travels too far: try a shorter one.
    Finer,
    /// The end.
    Stop(Reason),
}

impl Pinned<'_> {
    /// Makes `next` the state at `s.1` of the motion, `q` being the one at `s.0`; or says why there is none
    /// (then `next` means nothing). Collision and stability are not looked at.
    pub fn advance(&self, q: &Configuration, s: (f64, f64), next: &mut Configuration) -> Result<(), Failure> {
        next.clone_from(q);
        next.X_HO = self.motion.pose(s.1);
        let X_HMid = self.motion.pose(0.5 * (s.0 + s.1));
        for &(finger, p_OF) in &self.pins {
            let joints = self.follow(q, finger, &to_hand(&next.X_HO, &p_OF))?;
            let start = &q.joints[finger];
            let middle = self.task.hand.tip_center(finger, &start.interpolate(&joints, 0.5));
            // Joints on a line carry the tip on a parabola, to leading order: it strays most in the middle.
            if (middle - to_hand(&X_HMid, &p_OF)).norm() > self.stray
                || self.levers.between(finger, start, &joints) > self.travel
            {
                return Err(Failure::Finer);
            }
            next.joints[finger] = joints;
        }
        Ok(())
    }

    /// The finger's joints with its tip's centre at `p_HF` (m), near those of `q`; spare joints move as
    /// little as they need.
    fn follow(&self, q: &Configuration, finger: FingerIndex, p_HF: &Vec3) -> Result<FingerJoints, Failure> {
        let (hand, start) = (self.task.hand, &q.joints[finger]);
        let tip = hand.tip_kinematics(finger, start);
        // At lever 0 the material point of the Jacobian is the tip's centre.
        let jacobian = ContactJacobian::new(&tip, start.len(), &Vec3::z(), 0.0);
        let change = jacobian.speeds(&(p_HF - tip.p_HF)).ok_or(Failure::Stop(Reason::Reach))?;
        let mut near = *start;
        near.iter_mut().zip(change.iter()).for_each(|(q, change)| *q += change);
        if !hand.within_limits(finger, &near) {
            return Err(Failure::Stop(Reason::Limits));
        }
        hand.inverse(finger, p_HF, &near).ok_or(Failure::Stop(Reason::Reach))
    }
}

fn to_hand(X_HO: &Pose, p_O: &Vec3) -> Vec3 {
    X_HO.rotation * p_O + X_HO.translation.vector
}
