//! Forward kinematics by homogeneous matrices straight from the description, sharing no code with the crate.

use nalgebra::{Matrix4, Rotation3, Unit, Vector3, Vector4};
use regrasp_api::{FingerDescription, JointKind, PoseDescription};

fn homogeneous(pose: &PoseDescription) -> Matrix4<f64> {
    let turn = match (pose.orientation, pose.axis, pose.angle_deg) {
        (None, Some(axis), Some(angle)) => {
            Rotation3::from_axis_angle(&Unit::new_normalize(Vector3::from(axis)), angle.to_radians())
        }
        (None, None, None) => Rotation3::identity(),
        other => panic!("the test's hands have no such pose: {other:?}"),
    };
    Matrix4::new_translation(&Vector3::from(pose.position)) * turn.to_homogeneous()
}

/// The frames of the links in H.
pub fn frames(finger: &FingerDescription, joints: &[f64]) -> Vec<Matrix4<f64>> {
    let mut frame = homogeneous(&finger.base);
    let mut step = |(joint, &q): (&regrasp_api::JointDescription, &f64)| {
        let axis = Unit::new_normalize(Vector3::from(joint.axis));
        let motion = match joint.kind {
            JointKind::Revolute => Rotation3::from_axis_angle(&axis, q).to_homogeneous(),
            JointKind::Prismatic => Matrix4::new_translation(&(axis.into_inner() * q)),
        };
        frame = frame * homogeneous(&joint.origin) * motion;
        frame
    };
    finger.joint.iter().zip(joints).map(&mut step).collect()
}

/// The fingertip's centre in H.
pub fn tip(finger: &FingerDescription, joints: &[f64]) -> Vector3<f64> {
    let [x, y, z] = finger.tip;
    (frames(finger, joints).last().unwrap() * Vector4::new(x, y, z, 1.0)).xyz()
}
