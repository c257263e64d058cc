//! MJCF, MuJoCo's descriptions of robots.
//!
//! Format: "XML Reference", MuJoCo documentation. Read are the tree of bodies with hinge and slide joints,
//! shapes, default classes, included files, the compiler's settings, joints coupled by equality constraints,
//! the forces of actuators, excluded contacts and keyframes. What is not read is listed with its line.

mod body;
mod classes;
mod compiler;
mod geom;
mod joint;
mod tag;
#[cfg(test)]
mod tests;

use crate::error::RobotFault as Fault;
use crate::robot::{KeyFrame, Robot};
use body::Place;
use classes::Classes;
use compiler::Compiler;
use geom::Meshes;
use regrasp_api::Pose;
use std::collections::BTreeMap;
use std::path::Path;
use tag::Tag;

/// The largest velocity (rad/s; m/s) of joints: MJCF has no word for it.
const VELOCITY: f64 = 2.0;

/// Top-level elements that are read, and those that planning does not need.
const USED: &[&str] =
    &["compiler", "default", "asset", "worldbody", "equality", "tendon", "actuator", "contact", "keyframe"];
const IDLE: &[&str] = &["option", "size", "visual", "statistic", "custom", "sensor", "extension"];

/// What is known while bodies are read.
struct Reader<'t> {
    classes: &'t Classes,
    compiler: Compiler,
    meshes: Meshes,
    robot: Robot,
    /// Joints in the order of keyframes, with how many numbers each takes there.
    coordinates: Vec<(String, usize)>,
    /// Where joints stand while the bodies stand as the file has them (rad; m).
    references: BTreeMap<String, f64>,
    remarks: Vec<String>,
    idle: BTreeMap<String, Vec<usize>>,
    /// How many bodies without a name begin in each line; lines of included files count as the same.
    nameless: BTreeMap<usize, usize>,
}

impl Reader<'_> {
    /// A name for a body that has none.
    fn nameless(&mut self, line: usize) -> String {
        let count = self.nameless.entry(line).or_default();
        *count += 1;
        match *count {
            1 => format!("body in line {line}"),
            count => format!("body {count} in line {line}"),
        }
    }

    fn idle(&mut self, tag: &Tag) {
        self.idle.entry(format!("<{}>", tag.name)).or_default().push(tag.line);
    }

    fn unknown(&mut self, tag: &Tag, around: &str) {
        self.remarks.push(format!("<{}> in <{around}>: not known, not used (line {})", tag.name, tag.line));
    }
}

/// Reads an MJCF file with the files that it includes.
pub fn read_mjcf(path: &Path) -> Result<Robot, Fault> {
    let root = tag::load(path)?;
    if root.name != "mujoco" {
        return Err(root.fault(format!("the outermost element is <{}>, an MJCF's is <mujoco>", root.name)));
    }
    let classes = Classes::new(&root);
    let mut reader = Reader {
        classes: &classes,
        compiler: Compiler::new(&root)?,
        meshes: Meshes::default(),
        robot: Robot { name: root.own("model").unwrap_or("hand").to_owned(), ..Robot::default() },
        coordinates: Vec::new(),
        references: BTreeMap::new(),
        remarks: Vec::new(),
        idle: BTreeMap::new(),
        nameless: BTreeMap::new(),
    };
    reader.meshes = Meshes::new(&root, &reader)?;
    top(&root, &mut reader);
    world(&root, &mut reader)?;
    limits(&root, &mut reader)?;
    reader.robot.excluded = excluded(&root);
    reader.robot.key_frames = key_frames(&root, &reader)?;
    let Reader { mut robot, remarks, idle, .. } = reader;
    robot.remarks = remarks;
    robot.ignored =
        idle.into_iter().map(|(what, lines)| format!("{what} ({})", crate::xml::places(&lines))).collect();
    Ok(robot)
}

/// What of the outermost elements is not read.
fn top(root: &Tag, reader: &mut Reader<'_>) {
    for tag in root.children.iter().filter(|tag| !USED.contains(&tag.name.as_str())) {
        if IDLE.contains(&tag.name.as_str()) { reader.idle(tag) } else { reader.unknown(tag, "mujoco") }
    }
    for (name, known) in [("equality", "joint"), ("contact", "exclude"), ("tendon", "fixed")] {
        for tag in root.all(name).flat_map(|group| &group.children).filter(|tag| tag.name != known) {
            reader.unknown(tag, name);
        }
    }
}

fn world(root: &Tag, reader: &mut Reader<'_>) -> Result<(), Fault> {
    let mut link = body::link("world", root.line);
    let mut any = false;
    for tag in root.all("worldbody") {
        any = true;
        let place = Place { parent: "world", X_PF: Pose::identity(), class: None };
        body::inside(tag, place, &mut link, reader)?;
    }
    if !any {
        return Err(root.fault("there is no <worldbody>; is this the MJCF of a hand?"));
    }
    reader.robot.links.insert(0, link);
    Ok(())
}

/// What equality constraints and actuators say of joints.
fn limits(root: &Tag, reader: &mut Reader<'_>) -> Result<(), Fault> {
    let couplings = joint::couplings(root, reader, &reader.references)?;
    let mut remarks = Vec::new();
    let efforts = joint::efforts(root, reader, &mut remarks)?;
    reader.remarks.append(&mut remarks);
    for joint in &mut reader.robot.joints {
        let Some(limit) = &mut joint.limit else { continue };
        limit.velocity = Some(VELOCITY);
        limit.effort = limit.effort.or(efforts.get(&joint.name).copied());
        joint.mimic = couplings.mimic.get(&joint.name).cloned();
        if let Some(&q) = couplings.still.get(&joint.name) {
            (limit.lower, limit.upper) = (Some(q), Some(q));
        }
    }
    reader.remarks.push(format!(
        "MJCF has no word for the speed of joints: {VELOCITY} rad/s is taken; `--velocity '*=…'` sets it \
         (`joint` under `[hand]`)"
    ));
    Ok(())
}

fn excluded(root: &Tag) -> Vec<[String; 2]> {
    let tags = root.all("contact").flat_map(|contact| contact.all("exclude"));
    tags.filter_map(|tag| Some([tag.own("body1")?.to_owned(), tag.own("body2")?.to_owned()])).collect()
}

fn key_frames(root: &Tag, reader: &Reader<'_>) -> Result<Vec<KeyFrame>, Fault> {
    let keys = root.all("keyframe").flat_map(|frame| frame.all("key")).enumerate();
    let read = |(i, tag): (usize, &Tag)| {
        let Some(text) = tag.own("qpos") else { return Ok(None) };
        let numbers = tag.numbers_of("qpos", text)?;
        let all: usize = reader.coordinates.iter().map(|(_, count)| count).sum();
        if numbers.len() != all {
            let message =
                format!("<key qpos>: it must be {all} numbers, one for each coordinate of the joints");
            return Err(tag.fault(message));
        }
        let mut positions = BTreeMap::new();
        let mut at = 0;
        for (joint, count) in &reader.coordinates {
            if *count == 1 {
                positions.insert(joint.clone(), numbers[at]);
            }
            at += count;
        }
        let name = tag.own("name").map_or_else(|| i.to_string(), str::to_owned);
        Ok(Some(KeyFrame { name, positions }))
    };
    keys.map(read).filter_map(Result::transpose).collect()
}
