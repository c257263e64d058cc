//! The object's straight motion, as the plan's states mean it.

use regrasp_api::{Pose, Resolution, Vec3, interpolate};

/// The object's motion from one pose to another: position linear, orientation by slerp, constant velocities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    X_0: Pose,
    X_1: Pose,
    /// Velocity (m per motion), in H, of the object's origin.
    v_H: Vec3,
    /// Angular velocity (rad per motion), in H.
    w_H: Vec3,
}

impl Motion {
    pub fn new(X_0: &Pose, X_1: &Pose) -> Self {
        let (q0, q1) = (X_0.rotation, X_1.rotation);
        // The shorter arc, chosen as slerp chooses it.
        let near = q0.coords.dot(&q1.coords) >= 0.0;
        let q1 = if near { q1 } else { regrasp_api::Rotation::new_unchecked(-q1.into_inner()) };
        let v_H = X_1.translation.vector - X_0.translation.vector;
        Self { X_0: *X_0, X_1: *X_1, v_H, w_H: (q1 * q0.inverse()).scaled_axis() }
    }

    /// The pose a fraction `s` of the way; exact at both ends.
    pub fn pose(&self, s: f64) -> Pose {
        if s >= 1.0 {
            return self.X_1;
        }
        interpolate(&self.X_0, &self.X_1, s)
    }

    /// Velocity (m per motion), in H, of the object's material point at `p_H` when its pose is `X_HO`.
    pub fn velocity(&self, X_HO: &Pose, p_H: &Vec3) -> Vec3 {
        self.v_H + self.w_H.cross(&(p_H - X_HO.translation.vector))
    }

    /// The largest part of the motion that is one step at this resolution, at most 1.
    pub fn step(&self, resolution: &Resolution) -> f64 {
        let steps =
            (self.v_H.norm() / resolution.transfer_step).max(self.w_H.norm() / resolution.transfer_turn);
        1.0 / steps.max(1.0)
    }

    /// Whether nothing moves at all.
    pub fn is_still(&self) -> bool {
        self.X_0 == self.X_1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Rotation, angle_between};

    #[test]
    fn velocity_is_the_derivative_of_the_pose() {
        let turn = Rotation::from_euler_angles(0.4, -0.3, 0.9);
        let minus = Rotation::new_unchecked(-turn.into_inner());
        let X_0 =
            Pose::from_parts(Vec3::new(0.1, 0.2, 0.3).into(), Rotation::from_euler_angles(0.1, 0.0, 2.0));
        for rotation in [turn, minus] {
            let motion = Motion::new(&X_0, &Pose::from_parts(Vec3::new(0.0, 0.25, 0.31).into(), rotation));
            let p_O = Vec3::new(0.01, -0.02, 0.03);
            let place = |s| motion.pose(s).rotation * p_O + motion.pose(s).translation.vector;
            let numeric = (place(0.6 + 1e-6) - place(0.6 - 1e-6)) / 2e-6;
            assert!((motion.velocity(&motion.pose(0.6), &place(0.6)) - numeric).norm() < 1e-8);
            assert!(angle_between(&motion.pose(1.0).rotation, &rotation) == 0.0);
        }
    }
}
