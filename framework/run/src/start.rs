//! A configuration as the start of a problem.

use regrasp_api::{Configuration, FingerGrasp, FingerJoints, PoseDescription, StartDescription};

/// A configuration as a problem's start: its pose, and the grasp with joints and contacts.
pub fn start_at(q: &Configuration) -> StartDescription {
    let finger = |(finger, joints): (_, &FingerJoints)| FingerGrasp {
        contact: q.contacts[finger].map(|contact| contact.p_OC.into()),
        joints: Some(joints.to_vec()),
    };
    let grasp = q.joints.iter().map(finger).collect();
    StartDescription { pose: PoseDescription::from(&q.X_HO), grasp: Some(grasp) }
}
