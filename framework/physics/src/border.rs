//! The one border between nalgebra, which the project speaks, and glam, which rapier speaks.

use rapier3d_f64::math::{Pose as GlamPose, Rotation as GlamRotation, Vector};
use regrasp_api::{Pose, Rotation, Vec3};

pub(crate) fn to_glam(v: &Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

pub(crate) fn from_glam(v: Vector) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

pub(crate) fn pose_to_glam(X: &Pose) -> GlamPose {
    let q = X.rotation.quaternion();
    GlamPose::from_parts(to_glam(&X.translation.vector), GlamRotation::from_xyzw(q.i, q.j, q.k, q.w))
}

pub(crate) fn pose_from_glam(X: &GlamPose) -> Pose {
    let q = X.rotation;
    let rotation = Rotation::from_quaternion(nalgebra::Quaternion::new(q.w, q.x, q.y, q.z));
    Pose::from_parts(from_glam(X.translation).into(), rotation)
}
