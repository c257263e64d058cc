//! Hands from robots' files: what a description says, turned into a
//! [`HandDescription`], and a report of how.
//!
//! | question | file |
//! |---|---|
//! | What can be given beside the file? | `options.rs` |
//! | What becomes of scales, chosen and soft limits, joints without a range? | `prepare.rs` |
//! | Do the links form a tree? | `tree.rs` |
//! | Where do joints stand that no finger has? | `posture.rs` |
//! | Which links are fingertips and palm, which joints lie between? | `fingers.rs`, `guess.rs`, `rank.rs` |
//! | What limits, frames and drivers have the joints? | `joints.rs` |
//! | What is missing? | `needs.rs` |
//! | What is out of all proportion? | `plausible.rs` |
//! | Which convex shapes have the links, where are their meshes? | `solids.rs`, `rods.rs`, `hulls.rs` |
//! | Where is the ball that stands for a fingertip, and what of the last link remains beside it? | `tip.rs`,
//! `trim.rs` |
//! | Which bodies always touch, and where do the fingers rest? | `contacts.rs` |
//!
//! No ROS tool is called and no environment is read: packages are looked for in given folders and above the
//! file. What the file leaves open is either given in the options, or chosen and said in the report; limits
//! are never invented.

mod ball;
mod contacts;
mod find;
mod fingers;
mod guess;
mod hulls;
mod joints;
mod needs;
mod options;
mod plausible;
mod posture;
mod prepare;
mod rank;
mod reader;
mod report;
mod rods;
mod solids;
mod tip;
mod tree;
mod trim;

pub use options::{HandOptions, JointChoice};
pub use plausible::implausible_rates;
pub use report::{HandReport, ReadHand};

use fingers::Fingers;
use needs::Needs;
use posture::Posture;
use reader::Reader;
use regrasp_api::HandDescription;
use regrasp_formats::{Packages, Robot, RobotFault as Fault, RobotFileError, parse_urdf, read_robot};
use solids::Shaper;
use std::path::Path;
use tree::Tree;

/// Reads the hand of a robot's file.
///
/// Some 10 ms, more with large meshes; the same file and options give the same hand.
pub fn read_hand(path: &Path, options: &HandOptions) -> Result<ReadHand, RobotFileError> {
    let robot = read_robot(path).map_err(|fault| fault.within(path))?;
    let options = with_key_frame(&robot, options).map_err(|fault| fault.within(path))?;
    convert(path, robot, &options).map_err(|fault| fault.within(path))
}

/// Reads the hand of a URDF's text, as a program made it of the file `path`, beside which its meshes are
/// looked for.
pub fn read_urdf_text(path: &Path, text: &str, options: &HandOptions) -> Result<ReadHand, RobotFileError> {
    let read = parse_urdf(text).and_then(|robot| convert(path, robot, options));
    // Its lines are not those of the file.
    read.map_err(|fault| Fault { line: None, ..fault }.within(path))
}

/// The options with the positions of the key frame that they name.
fn with_key_frame(robot: &Robot, options: &HandOptions) -> Result<HandOptions, Fault> {
    let mut options = options.clone();
    let Some(name) = &options.keyframe else { return Ok(options) };
    let Some(frame) = robot.key_frames.iter().find(|frame| frame.name == *name) else {
        let known: Vec<String> = robot.key_frames.iter().map(|frame| format!("`{}`", frame.name)).collect();
        let message = format!("the file has no posture `{name}`; it has {}", known.join(", "));
        return Err(Fault::of_key("keyframe", message));
    };
    let position = |(name, q): (&String, &f64)| JointChoice {
        name: name.clone(),
        position: Some(*q),
        ..JointChoice::default()
    };
    let joints = frame.positions.iter().map(position).chain(options.joints.drain(..)).collect();
    options.joints = joints;
    Ok(options)
}

fn convert(path: &Path, mut robot: Robot, options: &HandOptions) -> Result<ReadHand, Fault> {
    options::check(options)?;
    let mut report = HandReport::default();
    let still = prepare::prepare(&mut robot, options, &mut report.notes)?;
    report.notes.append(&mut robot.remarks);
    if !robot.key_frames.is_empty() && options.keyframe.is_none() {
        let names: Vec<String> = robot.key_frames.iter().map(|frame| format!("`{}`", frame.name)).collect();
        report.ignored.push(format!("postures of the file ({}): `--keyframe` takes one", names.join(", ")));
    }
    let tree = Tree::new(&robot)?;
    let posture = Posture::new(&tree, options)?;
    let fingers = Fingers::find(&tree, &options.tips, options.palm.as_deref())
        .map_err(|fault| unmoved(fault, &still))?;
    let shaper =
        Shaper::new(Packages::new(path, &options.packages), options.mesh_pieces.unwrap_or(1), &robot.links);
    let parts = (&tree, &fingers, &posture);
    let needs = Needs::default();
    let mut reader =
        Reader { tree: parts.0, fingers: parts.1, posture: parts.2, options, shaper, report, needs };
    let mut description = reader.hand()?;
    let Reader { shaper, mut report, needs, .. } = reader;
    report.shapes = shaper.notes;
    report.ignored.extend(robot.ignored.iter().cloned());
    plausible::check(&tree, &fingers, &description, &mut report.notes)?;
    check_count(description.finger.len(), &report)?;
    needs.check(path, options)?;
    finish(&mut description, &mut report)?;
    Ok(ReadHand { description, report })
}

/// Says of a file in which no finger was found that joints were taken as fixed.
fn unmoved(fault: Fault, still: &[String]) -> Fault {
    if still.is_empty() {
        return fault;
    }
    let shown: Vec<String> = still.iter().take(6).map(|name| format!("`{name}`")).collect();
    let message = format!(
        "{}\n{} joints have limits from a number to the same number, as programs for drawing export them, \
         and were taken as fixed ({}{}): give \
         them a range, such as `--limits '*=-1.57..1.57'`",
        fault.message,
        still.len(),
        shown.join(", "),
        if still.len() > shown.len() { ", …" } else { "" }
    );
    Fault { message, ..fault }
}

/// The fewest fingers with which anything can be regrasped.
const FEWEST_FINGERS: usize = 3;

fn check_count(count: usize, report: &HandReport) -> Result<(), Fault> {
    if count >= FEWEST_FINGERS {
        return Ok(());
    }
    let left_out: String =
        report.notes.iter().filter(|note| note.contains(" hold")).map(|n| format!("\n{n}")).collect();
    let fingers = if count == 1 { "1 finger".into() } else { format!("{count} fingers") };
    Err(Fault::of_file(format!(
        "{fingers} can hold; at least {FEWEST_FINGERS} are needed, because two must hold the object while a \
         third moves on it (with soft \
         fingers; with point contacts and friction it takes three and a fourth){left_out}"
    )))
}

/// Excludes what always touches, and finds a posture to rest in.
fn finish(description: &mut HandDescription, report: &mut HandReport) -> Result<(), Fault> {
    let contacts = contacts::complete(description).map_err(contacts::refused)?;
    report.touching = contacts.touching;
    report.often_touching = contacts.often;
    for [a, b] in contacts.at_rest {
        report.notes.push(format!("`{a}` and `{b}` touch in the resting posture; no better one was found"));
    }
    Ok(())
}
