//! The border to parry: our vectors and poses in its types.

use parry3d_f64::math::{Pose as ParryPose, Rot3, Vector};
use parry3d_f64::shape::Segment;
use regrasp_api::{Pose, Vec3};

pub(crate) fn vector(v: &Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

pub(crate) fn segment(a: &Vec3, b: &Vec3) -> Segment {
    Segment::new(vector(a), vector(b))
}

pub(crate) fn parry_pose(X: &Pose) -> ParryPose {
    let q = X.rotation.coords;
    ParryPose::from_parts(vector(&X.translation.vector), Rot3::from_xyzw(q.x, q.y, q.z, q.w))
}
