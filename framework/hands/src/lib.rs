//! Hands from URDF files: what a robot's description says, turned into a [`HandDescription`], and a report of how.
//!
//! | question | file |
//! |---|---|
//! | What does the XML say, and in which line? | `document.rs` |
//! | Do the links form a tree? | `tree.rs` |
//! | Which links are fingertips and palm, which joints lie between? | `fingers.rs`, `guess.rs` |
//! | What limits, frames and drivers have the joints? | `joints.rs` |
//! | Which convex shapes have the links, where are their meshes? | `solids.rs`, `rods.rs`, `hull.rs`, `packages.rs` |
//! | Where is the ball that stands for a fingertip, and what of the last link remains beside it? | `tip.rs`, `trim.rs` |
//! | Which bodies always touch, and where do the fingers rest? | `contacts.rs` |
//!
//! No ROS tool is called and no environment is read: packages are looked for in given folders and above the file. What the file leaves open
//! is either given in the options, or chosen and said in the report; limits are never invented.

mod contacts;
mod find;
mod fingers;
mod guess;
mod joints;
mod rods;
mod solids;
mod tip;
mod tree;
mod trim;

use fingers::{Chain, Fingers};
use regrasp_api::{
    FingerDescription, Fingertip, HandDescription, JointDescription, PlacedShape, Pose, Rotation,
};
use regrasp_formats::{Joint, Kind, Packages, Robot, RobotFault as Fault, RobotFileError, parse_urdf};
use serde::Serialize;
use solids::{Piece, Shaper};
use std::path::{Path, PathBuf};
use tip::Tip;
use tree::Tree;
use trim::Seen;

/// The largest URDF that is read (bytes).
const MAX_BYTES: u64 = 64 << 20;

/// What a URDF does not say about a hand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UrdfOptions {
    /// The fingertip links, one a finger, in the order in which the fingers are counted; guessed where empty.
    pub tips: Vec<String>,
    /// Radius of the balls that stand for the fingertips (m); where absent, that of the tip links' own balls.
    pub fingertip_radius: Option<f64>,
    /// Centres of these balls in the tip links' frames (m): none (they are fitted), one for all, or one for each finger.
    pub tip_offset: Vec<[f64; 3]>,
    /// The link whose frame is the hand's; where absent, the last one that all fingertips hang on.
    pub palm: Option<String>,
    /// Folders in which packages are looked for.
    pub packages: Vec<PathBuf>,
    /// The most convex pieces that a mesh is taken apart into; its convex hull where absent or 1.
    pub mesh_pieces: Option<usize>,
    /// The largest acceleration of every joint (rad/s²); where absent, what the file says, or else 20.
    pub acceleration: Option<f64>,
    /// The largest velocity (rad/s) of joints for which the file says none, or 0.
    pub velocity: Option<f64>,
    /// The largest effort (N·m) of joints for which the file says none, or 0.
    pub effort: Option<f64>,
}

/// A hand from a URDF, and how it was understood.
#[derive(Clone, Debug, PartialEq)]
pub struct UrdfHand {
    /// The hand; meshes are in place.
    pub description: HandDescription,
    /// What was understood, chosen and ignored.
    pub report: UrdfReport,
}

/// What was understood of a URDF, chosen and ignored; sentences are for people.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct UrdfReport {
    /// The link whose frame is the hand's.
    pub palm: String,
    /// The tip links, one a finger.
    pub tips: Vec<String>,
    /// Whether the tips were guessed.
    pub tips_guessed: bool,
    /// For each finger where its ball was put, and why there.
    pub tip_centers: Vec<String>,
    /// For each link with a shape what was made of it.
    pub shapes: Vec<String>,
    /// Pairs that touch in all sampled postures and are excluded: `palm`, a joint (the link behind it), or a finger (its tip).
    pub touching: Vec<[String; 2]>,
    /// Pairs that touch in most sampled postures, with their share: not excluded.
    pub often_touching: Vec<([String; 2], f64)>,
    /// What was ignored.
    pub ignored: Vec<String>,
    /// What was chosen or changed.
    pub notes: Vec<String>,
}

/// Reads the hand of a URDF file.
///
/// Some 10 ms, more with large meshes; the same file and options give the same hand.
pub fn read_urdf(path: &Path, options: &UrdfOptions) -> Result<UrdfHand, RobotFileError> {
    let text = read(path).map_err(|reason| Fault::of_file(reason).within(path))?;
    convert(path, &text, options).map_err(|fault| fault.within(path))
}

fn read(path: &Path) -> Result<String, String> {
    let unreadable = |error: std::io::Error| format!("cannot read the file: {error}");
    let size = std::fs::metadata(path).map_err(unreadable)?.len();
    if size > MAX_BYTES {
        return Err(format!("{size} bytes are more than the largest allowed {MAX_BYTES}"));
    }
    String::from_utf8(std::fs::read(path).map_err(unreadable)?)
        .map_err(|_| "the file is not UTF-8 text".into())
}

fn convert(path: &Path, text: &str, options: &UrdfOptions) -> Result<UrdfHand, Fault> {
    check_options(options)?;
    let model = parse_urdf(text)?;
    let tree = Tree::new(&model)?;
    let fingers = Fingers::find(&tree, &options.tips, options.palm.as_deref())?;
    let mut shaper = Shaper::new(Packages::new(path, &options.packages), options.mesh_pieces.unwrap_or(1));
    let radius = match options.fingertip_radius {
        Some(radius) => radius,
        None => tip::common_radius(&tree, &fingers, &mut shaper)?,
    };
    let mut reader =
        Reader { tree: &tree, fingers: &fingers, options, radius, shaper, report: UrdfReport::default() };
    let mut description = reader.hand()?;
    let mut report = reader.report;
    report.shapes = reader.shaper.notes;
    skipped(&model, &mut report.ignored);
    let contacts = contacts::complete(&mut description).map_err(contacts::refused)?;
    report.touching = contacts.touching;
    report.often_touching = contacts.often;
    for [a, b] in contacts.at_rest {
        report.notes.push(format!("`{a}` and `{b}` touch in the resting posture; no better one was found"));
    }
    Ok(UrdfHand { description, report })
}

fn check_options(options: &UrdfOptions) -> Result<(), Fault> {
    let within = |name: &'static str, value: f64, low: f64, high: f64, unit: &str| {
        let message = format!("`{name}` = {value} is outside {low}..={high}{unit}");
        if (low..=high).contains(&value) { Ok(()) } else { Err(Fault::of_key(name, message)) }
    };
    options.fingertip_radius.map_or(Ok(()), |r| within("fingertip_radius", r, 1e-4, 0.2, " m"))?;
    options.acceleration.map_or(Ok(()), |a| within("acceleration", a, 1e-3, 1e9, " rad/s²"))?;
    options.velocity.map_or(Ok(()), |v| within("velocity", v, 1e-3, 1e9, " rad/s"))?;
    options.effort.map_or(Ok(()), |e| within("effort", e, 1e-6, 1e9, " N·m"))?;
    options.mesh_pieces.map_or(Ok(()), |n| within("mesh_pieces", n as f64, 1.0, 64.0, ""))?;
    options.tip_offset.iter().flatten().try_for_each(|&x| within("tip_offset", x, -10.0, 10.0, " m"))
}

/// Elements that say nothing about a hand's geometry, each kind once.
fn skipped(model: &Robot, ignored: &mut Vec<String>) {
    let mut kinds = model.skipped.clone();
    kinds.sort_unstable();
    kinds.dedup();
    for kind in kinds.iter().filter(|kind| *kind != "material") {
        let count = model.skipped.iter().filter(|other| *other == kind).count();
        ignored.push(format!("{count} × <{kind}>"));
    }
    ignored.push("masses and inertias: planning does not need them".into());
}

/// Where a link belongs.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Owner {
    Palm,
    /// Finger, and which of its moving joints.
    Finger(usize, usize),
}

/// A link of the hand, its pose in the frame B of what it belongs to, and its shapes in B.
struct Part {
    owner: Owner,
    link: usize,
    X_BL: Pose,
    pieces: Vec<Piece>,
}

/// The shapes of parts.
fn placed<'p>(parts: impl Iterator<Item = &'p Part>) -> Vec<PlacedShape> {
    parts.flat_map(|part| part.pieces.iter().map(Piece::placed)).collect()
}

struct Reader<'a> {
    tree: &'a Tree<'a>,
    fingers: &'a Fingers,
    options: &'a UrdfOptions,
    radius: f64,
    shaper: Shaper,
    report: UrdfReport,
}

impl Reader<'_> {
    fn hand(&mut self) -> Result<HandDescription, Fault> {
        let (tree, fingers) = (self.tree, self.fingers);
        let name = |link: usize| tree.link_of(link).name.clone();
        self.report.palm = name(fingers.palm);
        self.report.tips = fingers.chains.iter().map(|chain| name(chain.tip)).collect();
        self.report.tips_guessed = fingers.guessed;
        self.report.notes.extend(fingers.left_out.iter().cloned());
        let count = (self.options.tip_offset.len(), fingers.chains.len());
        if count.0 > 1 && count.0 != count.1 {
            let message = format!(
                "`tip_offset` has {} entries; give one, or one for each of the {} fingers",
                count.0, count.1
            );
            return Err(Fault::of_key("tip_offset", message));
        }
        let owned = self.owned()?;
        let palm = placed(owned.iter().filter(|part| part.owner == Owner::Palm));
        let finger = fingers.chains.iter().enumerate();
        let finger = finger.map(|(f, chain)| self.finger(f, chain, &owned)).collect::<Result<_, _>>()?;
        Ok(HandDescription {
            name: tree.model.name.clone(),
            references: Vec::new(),
            fingertip_radius: self.radius,
            fingertip: Fingertip::Ball,
            palm,
            finger,
            touching: Vec::new(),
        })
    }

    /// The pieces of every link that is part of the hand, each in the frame of what it belongs to.
    fn owned(&mut self) -> Result<Vec<Part>, Fault> {
        let tree = self.tree;
        let mut owned = Vec::new();
        let mut open = vec![(self.fingers.palm, Owner::Palm, Pose::identity())];
        self.upward(&mut open);
        while let Some((link, owner, X_BL)) = open.pop() {
            let pieces = self.shaper.pieces(tree.link_of(link))?;
            let pieces = pieces.into_iter().map(|piece| piece.moved(&X_BL)).collect();
            owned.push(Part { owner, link, X_BL, pieces });
            for &index in tree.below(link).iter().rev() {
                // What is above the palm was looked at already.
                if tree.path(self.fingers.palm).contains(&index) {
                    continue;
                }
                let joint = tree.joint(index);
                let next = match self.fingers.owner(index) {
                    Some((finger, place)) => (Owner::Finger(finger, place), Pose::identity()),
                    None => (owner, X_BL * self.held(joint)),
                };
                open.push((tree.child(index), next.0, next.1));
            }
        }
        Ok(owned)
    }

    /// The links above the palm that are fixed to it.
    fn upward(&mut self, open: &mut Vec<(usize, Owner, Pose)>) {
        let (mut link, mut X_HL) = (self.fingers.palm, Pose::identity());
        while let Some(index) = self.tree.above(link) {
            let joint = self.tree.joint(index);
            link = self.tree.parent(index);
            if joint.kind != Kind::Fixed {
                self.report.ignored.push(format!(
                    "everything above joint `{}`, which moves the palm: link `{}` and what hangs on it",
                    joint.name,
                    self.tree.link_of(link).name
                ));
                return;
            }
            X_HL *= joint.X_PJ.inverse();
            open.push((link, Owner::Palm, X_HL));
        }
    }

    /// The pose of a joint's child in its parent, where the joint is fixed or belongs to no finger.
    fn held(&mut self, joint: &Joint) -> Pose {
        if joint.kind == Kind::Fixed {
            return joint.X_PJ;
        }
        let range = joint.limit.map_or((f64::MIN, f64::MAX), |limit| {
            (limit.lower.unwrap_or(f64::MIN), limit.upper.unwrap_or(f64::MAX))
        });
        let q = if range.0 <= range.1 { 0_f64.clamp(range.0, range.1) } else { 0.0 };
        self.report.ignored.push(format!("joint `{}` belongs to no finger: it is held at {q}", joint.name));
        match joint.kind {
            Kind::Revolute | Kind::Continuous => joint.X_PJ * Rotation::from_scaled_axis(joint.axis * q),
            Kind::Prismatic => joint.X_PJ * nalgebra::Translation3::from(joint.axis * q),
            Kind::Fixed | Kind::Other => joint.X_PJ,
        }
    }

    fn finger(&mut self, finger: usize, chain: &Chain, owned: &[Part]) -> Result<FingerDescription, Fault> {
        let (tree, fingers) = (self.tree, self.fingers);
        let notes = &mut self.report.notes;
        let joints::FingerJoints { base, mut joints, X_LTip } =
            joints::joints(tree, fingers, chain, self.options, notes)?;
        let last = joints.len() - 1;
        for (place, joint) in joints.iter_mut().enumerate().take(last) {
            joint.link = placed(owned.iter().filter(|part| part.owner == Owner::Finger(finger, place)));
        }
        let tip = self.tip(finger, chain, &X_LTip, owned, &mut joints[last]);
        let rest = joints.iter().map(|joint| 0_f64.clamp(joint.lower, joint.upper)).collect();
        let mut finger = FingerDescription {
            name: self.finger_name(chain),
            base,
            joint: joints,
            tip: tip.center.into(),
            rest,
        };
        settle_rest(&mut finger);
        Ok(finger)
    }

    /// Puts the ball, and gives the last link the shapes that remain beside it.
    fn tip(
        &mut self,
        finger: usize,
        chain: &Chain,
        X_LTip: &Pose,
        owned: &[Part],
        joint: &mut JointDescription,
    ) -> Tip {
        let place = chain.moving.len() - 1;
        let last = || owned.iter().filter(|part| part.owner == Owner::Finger(finger, place));
        let pieces = |parts: &mut dyn Iterator<Item = &Part>| -> Vec<Piece> {
            parts.flat_map(|part| part.pieces.clone()).collect()
        };
        let own = pieces(&mut last().filter(|part| part.link == chain.tip));
        let all = pieces(&mut last());
        let has_own_link = chain.path.last() != chain.moving.last();
        let offset = match self.options.tip_offset[..] {
            [] => None,
            [one] => Some(one),
            ref each => Some(each[finger]),
        };
        let tip = Tip::new(X_LTip, offset, (&own, &all), self.radius, has_own_link);
        let name = self.finger_name(chain);
        let beside = if tip.is_ball {
            let behind = pieces(&mut last().filter(|part| part.link != chain.tip));
            let seen = self.seen(chain, last());
            seen.trimmed(&tip, behind, self.radius, &mut self.report.notes, &name)
        } else {
            all
        };
        let kept = tip.cut(beside, self.radius, &mut self.report.notes, &name);
        let free = tip.free(&kept, self.radius).to_degrees();
        let how = &tip.how;
        self.report
            .tip_centers
            .push(format!("`{name}`: {how}; free up to {free:.0}° from the finger's direction"));
        joint.link = kept.iter().map(Piece::placed).collect();
        tip
    }

    /// What is seen of the links that move with the tip.
    fn seen<'p>(&mut self, chain: &Chain, parts: impl Iterator<Item = &'p Part>) -> Seen {
        let mut seen = Seen { tip: Vec::new(), behind: Vec::new() };
        for part in parts {
            let pieces = self.shaper.seen(self.tree.link_of(part.link));
            let pieces = pieces.into_iter().map(|piece| piece.moved(&part.X_BL));
            if part.link == chain.tip { seen.tip.extend(pieces) } else { seen.behind.extend(pieces) }
        }
        seen
    }

    /// The tip link's name, unless a joint or the palm is called so too: `touching` needs names that are different.
    fn finger_name(&self, chain: &Chain) -> String {
        let name = &self.tree.link_of(chain.tip).name;
        let taken = name == "palm" || self.tree.joint_named(name).is_some();
        if taken { format!("finger {name}") } else { name.clone() }
    }
}

/// Driven joints rest where their drivers have them.
fn settle_rest(finger: &mut FingerDescription) {
    for driven in 0..finger.joint.len() {
        let Some(mimic) = &finger.joint[driven].mimic else { continue };
        let driver = finger.joint.iter().position(|joint| joint.name == mimic.joint);
        let position = driver.map_or(0.0, |driver| finger.rest[driver]);
        finger.rest[driven] = mimic.multiplier * position + mimic.offset;
    }
}
