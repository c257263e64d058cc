//! The joints over time as a table, beside models of the hand.

use crate::csv::Table;
use crate::table::{Row, object_head};
use crate::{File, Scene};
use regrasp_api::{FingerIndex, JointKind};

/// Times (s), joints (rad; m) by the names of the model, the object's pose in H.
pub(crate) fn trajectory(scene: &Scene<'_>, name: String) -> File {
    let mut table = Table::new(&[vec!["time".to_owned()], motion_head(scene)].concat());
    for row in scene.rows() {
        table.line(&[vec![row.time.to_string()], motion_cells(&row)].concat());
    }
    File { name, bytes: table.into_bytes() }
}

/// The trajectory with all that it takes to carry it out: the segment's number, the links of the fingertip
/// that moves in it and of those that hold (with `;` between them), what the motors must aim at, and the
/// least distance of a force from its friction cone (N).
///
/// At a time that occurs twice other fingers hold from then on: the forces pass over while everything rests.
pub(crate) fn controls(scene: &Scene<'_>, name: String) -> File {
    let mut head: Vec<String> = ["time", "segment", "moving", "holding"].map(String::from).into();
    head.extend(motion_head(scene));
    head.extend(motors(scene).map(|(finger, joint)| format!("target.{}", scene.names.joints[finger][joint])));
    head.push("force_margin".into());
    let mut table = Table::new(&head);
    let tip = |finger: FingerIndex| scene.names.tips[finger.index()].as_str();
    for row in scene.rows() {
        let holding = row.moving().map_or(row.q.holding(), |moving| row.q.holding().without(moving));
        let holding: Vec<&str> = holding.iter().map(tip).collect();
        let moving = row.moving().map_or("", tip).to_owned();
        let mut cells = vec![row.time.to_string(), row.segment.to_string(), moving, holding.join(";")];
        cells.extend(motion_cells(&row));
        cells.extend(motors(scene).map(|motor| target(scene, row.state, row.q, motor).to_string()));
        cells.push(scene.forces.margin(row.state).map_or(String::new(), |margin| margin.to_string()));
        table.line(&cells);
    }
    File { name, bytes: table.into_bytes() }
}

fn motion_head(scene: &Scene<'_>) -> Vec<String> {
    let joints = scene.names.joints.iter().flatten().map(|joint| format!("joint.{joint}"));
    joints.chain(object_head()).collect()
}

fn motion_cells(row: &Row<'_>) -> Vec<String> {
    let joints = row.q.joints.iter().flat_map(|(_, joints)| joints.to_vec());
    let (position, orientation) = row.object();
    joints.chain(position).chain(orientation).map(|number| number.to_string()).collect()
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
    scene.forces.target(state, q, FingerIndex(finger as u8), joint, prismatic)
}
