//! Vectors, rotations and poses, in monogram notation.
//!
//! `X_HO` is the pose of frame O in frame H, `p_OC` the position of C's origin in O, `n_O` a unit vector
//! given in O. Products read by matching letters: `X_HC = X_HO * X_OC`. Lengths are metres, angles radians.

use nalgebra::{Isometry3, Matrix3, Quaternion, Translation3, UnitQuaternion, Vector3};

/// A position (m), direction or other free vector; its frame is the last letter of its name's subscript.
pub type Vec3 = Vector3<f64>;
/// A 3×3 matrix.
pub type Mat3 = Matrix3<f64>;
/// A rotation, as a unit quaternion.
pub type Rotation = UnitQuaternion<f64>;
/// A rigid motion: a rotation followed by a translation (m).
pub type Pose = Isometry3<f64>;

/// The pose a fraction `s` in [0, 1] of the way from `X_0` to `X_1`: position linear, orientation by the
/// shorter arc.
///
/// This is the motion that a plan *means* between two of its states. Never panics: where the two orientations
/// differ by exactly π the arc follows the quaternions as they are given.
pub fn interpolate(X_0: &Pose, X_1: &Pose, s: f64) -> Pose {
    let p = X_0.translation.vector.lerp(&X_1.translation.vector, s);
    Pose::from_parts(Translation3::from(p), slerp(&X_0.rotation, &X_1.rotation, s))
}

/// Spherical linear interpolation along the shorter arc, `s` in [0, 1]; exact at both ends up to the sign.
pub fn slerp(R_0: &Rotation, R_1: &Rotation, s: f64) -> Rotation {
    let q0 = R_0.quaternion().coords;
    let mut q1 = R_1.quaternion().coords;
    let mut cos = q0.dot(&q1);
    if cos < 0.0 {
        (q1, cos) = (-q1, -cos);
    }
    // Below 1e-6 of arc the chord is the arc to rounding.
    let (w0, w1) = if cos > 1.0 - 1e-12 {
        (1.0 - s, s)
    } else {
        let angle = cos.min(1.0).acos();
        let sin = angle.sin();
        (((1.0 - s) * angle).sin() / sin, (s * angle).sin() / sin)
    };
    Rotation::new_normalize(Quaternion::from(q0 * w0 + q1 * w1))
}

/// The unit normal a fraction `s` of the way along the arc from `n_0` to `n_1` (less than π apart).
pub fn slerp_normals(n_0: &Vec3, n_1: &Vec3, s: f64) -> Vec3 {
    let angle = n_0.cross(n_1).norm().atan2(n_0.dot(n_1));
    if angle < 1e-9 {
        return *n_1;
    }
    (n_0 * ((1.0 - s) * angle).sin() + n_1 * (s * angle).sin()) / angle.sin()
}

/// The angle between two orientations, in [0, π] rad.
pub fn angle_between(R_0: &Rotation, R_1: &Rotation) -> f64 {
    let q = R_0.rotation_to(R_1);
    2.0 * q.imag().norm().atan2(q.scalar().abs())
}

/// The matrix `[v]×` with `[v]× w = v × w`.
pub fn cross_matrix(v: &Vec3) -> Mat3 {
    Mat3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

/// Some unit vector orthogonal to the unit vector `n`; continuous except near ±z changes of branch.
pub fn any_orthogonal(n: &Vec3) -> Vec3 {
    let axis = if n.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    n.cross(&axis).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn slerp_reaches_both_ends_and_halves_the_angle() {
        let R_0 = Rotation::from_euler_angles(0.1, 0.2, 0.3);
        for angle in [1e-9, 1e-3, 1.0, PI - 1e-6, PI] {
            let R_1 = R_0 * Rotation::from_scaled_axis(Vec3::new(0.0, 0.6, 0.8) * angle);
            assert!(angle_between(&slerp(&R_0, &R_1, 0.0), &R_0) < 1e-12);
            assert!(angle_between(&slerp(&R_0, &R_1, 1.0), &R_1) < 1e-12);
            let half = slerp(&R_0, &R_1, 0.5);
            assert!((angle_between(&R_0, &half) - angle / 2.0).abs() < 1e-9);
        }
    }

    #[test]
    fn angle_ignores_the_quaternions_sign() {
        let R = Rotation::from_euler_angles(0.4, -0.2, 1.0);
        let minus = Rotation::new_unchecked(-R.into_inner());
        assert!(angle_between(&R, &minus) < 1e-12);
    }
}
