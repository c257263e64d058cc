//! The one border between nalgebra and parry's glam.

use parry3d_f64::math::{Pose as ParryPose, Rot3, Vector};
use regrasp_api::{Pose, Vec3};

pub(super) fn to_glam(v: &Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

pub(super) fn to_parry(X: &Pose) -> ParryPose {
    let q = X.rotation.quaternion();
    ParryPose::from_parts(to_glam(&X.translation.vector), Rot3::from_xyzw(q.i, q.j, q.k, q.w))
}
