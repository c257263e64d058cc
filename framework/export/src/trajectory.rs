//! The joints over time as a table, beside models of the hand.

use crate::csv::Table;
use crate::{File, Scene};
use regrasp_api::JointKind;

/// Times (s), joints (rad; m) by the names of the model, the object's pose in H; with `targets`, also what the motors must aim at.
///
/// At a time that occurs twice other fingers hold from then on: the forces pass over while everything rests.
pub(crate) fn trajectory(scene: &Scene<'_>, name: String, targets: bool) -> File {
    let mut head = vec!["time".to_owned()];
    head.extend(scene.names.joints.iter().flatten().cloned());
    head.extend(
        ["object.x", "object.y", "object.z", "object.qw", "object.qx", "object.qy", "object.qz"]
            .map(String::from),
    );
    if targets {
        head.extend(
            motors(scene).map(|(finger, joint)| format!("target.{}", scene.names.joints[finger][joint])),
        );
    }
    let mut table = Table::new(&head);
    for row in scene.rows() {
        let mut cells = vec![row.time.to_string()];
        cells.extend(row.q.joints.iter().flat_map(|(_, joints)| joints.to_vec()).map(|q| q.to_string()));
        let (position, orientation) = row.object();
        cells.extend(position.iter().chain(&orientation).map(f64::to_string));
        if targets {
            cells.extend(motors(scene).map(|motor| target(scene, row.state, row.q, motor).to_string()));
        }
        table.line(&cells);
    }
    File { name, bytes: table.into_bytes() }
}

/// Finger and joint of every motor: all joints but those that another joint drives.
pub(crate) fn motors<'a>(scene: &'a Scene<'_>) -> impl Iterator<Item = (usize, usize)> + 'a {
    let fingers = scene.description().finger.iter().enumerate();
    let all = fingers.flat_map(|(finger, chain)| (0..chain.joint.len()).map(move |joint| (finger, joint)));
    all.filter(|&(finger, joint)| scene.description().finger[finger].joint[joint].mimic.is_none())
}

/// What a motor aims at so that its spring exerts the grasp's part (rad; m).
pub(crate) fn target(
    scene: &Scene<'_>,
    state: usize,
    q: &regrasp_api::Configuration,
    (finger, joint): (usize, usize),
) -> f64 {
    let prismatic = scene.description().finger[finger].joint[joint].kind == JointKind::Prismatic;
    scene.forces.target(state, q, regrasp_api::FingerIndex(finger as u8), joint, prismatic)
}
