//! A MuJoCo model of hand and object with one keyframe for each grasp.

use super::Set;
use super::columns::quaternion;
use crate::GraspsError;
use crate::grasp::BulkGrasp;
use regrasp_api::{HandDescription, JointKind};
use regrasp_export::{ExportError, File, Format, Scene};
use regrasp_physics::SimulationSettings;
use regrasp_plan::{Plan, SegmentName, SegmentRecord, StateRecord, state_record};
use regrasp_world::ChainHand;
use std::fmt::Write as _;
use std::io::{self, Write};

/// The model around its keyframes, and the files of its meshes.
pub struct Keyframes {
    before: String,
    after: String,
    meshes: Vec<File>,
}

/// Makes the model of a set; `plan` says hand, object and claims, `stem` begins the names of mesh files.
///
/// It is the model that a plan's export makes, with its motors and their gains. Keyframes are called `0`,
/// `1`, …; `qpos` holds joints and object, `ctrl` what the motors must aim at so that they exert the grasp's
/// efforts.
pub fn keyframes(set: &Set<'_>, plan: &Plan, stem: &str) -> Result<Keyframes, GraspsError> {
    let mut plan = plan.clone();
    plan.segments = vec![resting(set, plan.scenario.problem.hand.clone())?];
    let files = Scene::new(&plan)?.export(Format::Mjcf, stem)?;
    let (mut text, mut meshes) = (String::new(), Vec::new());
    for file in files {
        if file.name.ends_with(".xml") {
            text = String::from_utf8_lossy(&file.bytes).into_owned();
        } else if file.name.ends_with(".stl") {
            meshes.push(file);
        }
    }
    let (before, rest) = text.split_once("<keyframe>").unwrap_or((&text, ""));
    let after = rest.split_once("</keyframe>").map_or("", |(_, after)| after);
    let before = before.replacen("<mujoco", "<!-- regrasp-grasps -->\n<mujoco", 1);
    Ok(Keyframes { before, after: after.to_owned(), meshes })
}

/// The first grasp twice: a motion in which nothing moves.
fn resting(set: &Set<'_>, hand: HandDescription) -> Result<SegmentRecord, GraspsError> {
    let hand = ChainHand::new(hand).map_err(ExportError::from)?;
    let mut states: Vec<StateRecord> = Vec::new();
    let first = set.rows.each(&mut |grasp| {
        if !states.is_empty() {
            return Err(io::ErrorKind::Interrupted.into());
        }
        states = vec![state_record(&grasp.q, 0.0, &hand), state_record(&grasp.q, 1.0, &hand)];
        Ok(())
    });
    // The first is enough.
    drop(first);
    Ok(SegmentRecord { kind: SegmentName::Transfer, finger: None, states })
}

impl Keyframes {
    /// The meshes that the model names, to be written beside it.
    pub fn meshes(&self) -> &[File] {
        &self.meshes
    }

    /// Writes the model with the keyframes of all grasps.
    pub fn write(&self, set: &Set<'_>, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(self.before.as_bytes())?;
        out.write_all(b"<keyframe>\n")?;
        let mut number = 0_u64;
        set.rows.each(&mut |grasp| {
            let line = key(number, grasp, set.hand);
            number += 1;
            out.write_all(line.as_bytes())
        })?;
        out.write_all(b"  </keyframe>")?;
        out.write_all(self.after.as_bytes())
    }
}

fn key(number: u64, grasp: &BulkGrasp, hand: &HandDescription) -> String {
    let settings = SimulationSettings::default();
    let (mut qpos, mut ctrl) = (String::new(), String::new());
    let push = |text: &mut String, x: f64| {
        let space = if text.is_empty() { "" } else { " " };
        let _ = write!(text, "{space}{x}");
    };
    for ((finger, joints), description) in grasp.q.joints.iter().zip(&hand.finger) {
        for (j, (&q, joint)) in joints.iter().zip(&description.joint).enumerate() {
            push(&mut qpos, q);
            if joint.mimic.is_none() {
                let stiffness = match joint.kind {
                    JointKind::Revolute => settings.stiffness,
                    JointKind::Prismatic => settings.linear_stiffness,
                };
                let effort = grasp.held.as_ref().map_or(0.0, |held| held.efforts[finger][j]);
                push(&mut ctrl, q + effort / stiffness);
            }
        }
    }
    let object = grasp.q.X_HO.translation.vector.iter().copied().chain(quaternion(grasp));
    object.for_each(|x| push(&mut qpos, x));
    format!("    <key name=\"{number}\" qpos=\"{qpos}\" ctrl=\"{ctrl}\"/>\n")
}
