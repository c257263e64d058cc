//! The three joints that inverse kinematics solves for, the others standing still.

use crate::hand::{chain::FingerChain, screw::Screw};
use nalgebra::Matrix3;
use regrasp_api::Vec3;

/// A chain of three joints: p_HF(q) = e₁(q₁) e₂(q₂) e₃(q₃) p0.
#[derive(Clone, Debug)]
pub(in crate::hand) struct Triple {
    /// The joints' screws in H, with the three joints at 0.
    pub screws: [Screw; 3],
    /// The fingertip's centre in H (m), with the three joints at 0.
    pub p0: Vec3,
}

impl Triple {
    /// The chain that remains when all joints but `solved` (ascending) keep their positions of `joints`.
    pub fn new(chain: &FingerChain, solved: &[usize; 3], joints: &[f64]) -> Self {
        // From the tip backwards, each spare joint moves everything behind it.
        let mut screws = solved.map(|joint| chain.screws[joint]);
        let mut p0 = chain.p_HF0;
        for joint in (0..chain.screws.len()).rev().filter(|joint| !solved.contains(joint)) {
            let (spare, q) = (&chain.screws[joint], joints[joint]);
            p0 = spare.move_point(&p0, q);
            for (screw, &index) in screws.iter_mut().zip(solved) {
                if index > joint {
                    *screw = screw.moved_by(spare, q);
                }
            }
        }
        Self { screws, p0 }
    }

    /// The fingertip's centre (m) and its velocity per speed of each joint.
    pub fn tip_jacobian(&self, q: &[f64; 3]) -> (Vec3, Matrix3<f64>) {
        let [s1, s2, s3] = &self.screws;
        let p3 = s3.move_point(&self.p0, q[2]);
        let p2 = s2.move_point(&p3, q[1]);
        let p1 = s1.move_point(&p2, q[0]);
        let v3 = s1.move_vector(&s2.move_vector(&s3.velocity(&p3), q[1]), q[0]);
        let v2 = s1.move_vector(&s2.velocity(&p2), q[0]);
        (p1, Matrix3::from_columns(&[s1.velocity(&p1), v2, v3]))
    }
}
