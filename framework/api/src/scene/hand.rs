//! Hands as serial chains of joints with link shapes and a spherical fingertip.

use super::{PlacedShape, PoseDescription};
use crate::{Body, FingerIndex};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A hand: a palm and fingers. The hand's frame H is the fixed world frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HandDescription {
    /// What the hand is called.
    pub name: String,
    /// Where its dimensions come from.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub references: Vec<String>,
    /// Radius of every fingertip's ball (m).
    #[schemars(range(min = 1e-4, max = 0.2), extend("x-unit" = "m"))]
    pub fingertip_radius: f64,
    /// What touches the object: the ball itself, or a point.
    #[serde(default, skip_serializing_if = "Fingertip::is_ball")]
    pub fingertip: Fingertip,
    /// Shapes fixed to the hand's frame.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub palm: Vec<PlacedShape>,
    /// The fingers, in the order in which everything counts them.
    pub finger: Vec<FingerDescription>,
    /// Pairs of bodies that touch by construction and are never compared, beside those that always are left
    /// out (consecutive links of a finger; the palm and a first link that touch in the resting posture). A
    /// body is named by `palm`, by the joint before the link, or, for a fingertip's ball, by its finger.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("examples" = [[["palm", "thumb-base"]]]))]
    pub touching: Vec<[String; 2]>,
}

impl HandDescription {
    /// The body that `touching` calls by this name: `palm`, a joint (the link behind it) or a finger (its
    /// fingertip's ball).
    ///
    /// `None` where nothing, or more than one thing, has the name.
    pub fn body_named(&self, name: &str) -> Option<Body> {
        let palm = (name == PALM).then_some(Body::Palm);
        let fingers = self.finger.iter().enumerate();
        let mut found = palm.into_iter().chain(fingers.flat_map(|(f, finger)| {
            let index = FingerIndex(f as u8);
            let tip = (finger.name == name).then_some(Body::Fingertip(index));
            let links = finger.joint.iter().enumerate().filter(|(_, joint)| joint.name == name);
            tip.into_iter().chain(links.map(move |(link, _)| Body::Link(index, link as u8)))
        }));
        let first = found.next()?;
        found.next().is_none().then_some(first)
    }

    /// The name by which `touching` calls a body of the hand; `None` for object and obstacles.
    pub fn body_name(&self, body: Body) -> Option<&str> {
        match body {
            Body::Palm => Some(PALM),
            Body::Fingertip(finger) => self.finger.get(finger.index()).map(|finger| finger.name.as_str()),
            Body::Link(finger, link) => {
                let joint = self.finger.get(finger.index())?.joint.get(usize::from(link))?;
                Some(&joint.name)
            }
            Body::Object | Body::Obstacle(_) => None,
        }
    }
}

/// What `touching` calls the palm.
const PALM: &str = "palm";

/// What a fingertip does on the object while the object moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fingertip {
    /// A ball: it rolls, and the contact moves over both bodies.
    #[default]
    Ball,
    /// A point that stays where it was set down and about which the finger turns freely (the point contact of
    /// grasp statics). The ball is its collision shape: its centre keeps the place over the object that it
    /// had at touch-down, one radius above the contact along the surface's normal there. What this neglects
    /// is of the order of the radius: a declared point wants a small one.
    Point,
}

impl Fingertip {
    /// Whether the fingertip is a ball that rolls.
    pub fn is_ball(&self) -> bool {
        *self == Self::Ball
    }
}

/// One finger: a serial chain from the palm to a spherical fingertip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FingerDescription {
    /// What the finger is called.
    pub name: String,
    /// Pose of the finger's base in the hand's frame.
    #[serde(default)]
    pub base: PoseDescription,
    /// The joints, base to tip.
    pub joint: Vec<JointDescription>,
    /// Centre of the fingertip's ball in the last link's frame (m).
    #[serde(default)]
    #[schemars(extend("x-unit" = "m"))]
    pub tip: [f64; 3],
    /// Joint positions (rad; m where prismatic) that the finger takes when it rests free of the object.
    #[schemars(extend("x-unit" = "rad; m where prismatic"))]
    pub rest: Vec<f64>,
}

/// One joint and the link behind it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointDescription {
    /// What the joint is called.
    pub name: String,
    /// How it moves.
    #[serde(default)]
    pub kind: JointKind,
    /// Pose of the joint's frame, at position 0, in the frame of the link before (the base for the first).
    #[serde(default)]
    pub origin: PoseDescription,
    /// The axis in the joint's frame (a direction, of any length).
    #[schemars(extend("x-unit" = "1"))]
    pub axis: [f64; 3],
    /// Lowest position (rad; m where prismatic).
    #[schemars(extend("x-unit" = "rad; m where prismatic"))]
    pub lower: f64,
    /// Highest position (rad; m where prismatic).
    #[schemars(extend("x-unit" = "rad; m where prismatic"))]
    pub upper: f64,
    /// Largest speed (rad/s; m/s where prismatic).
    #[serde(default = "default_velocity")]
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "rad/s; m/s where prismatic"))]
    pub velocity: f64,
    /// Largest acceleration (rad/s²; m/s² where prismatic).
    #[serde(default = "default_acceleration")]
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "rad/s²; m/s² where prismatic"))]
    pub acceleration: f64,
    /// Largest effort (N·m; N where prismatic).
    #[serde(default = "default_effort")]
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "N·m; N where prismatic"))]
    pub effort: f64,
    /// Which joint drives this one; absent where it moves by itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mimic: Option<Mimic>,
    /// Shapes of the link behind the joint, in the joint's moved frame.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub link: Vec<PlacedShape>,
}

/// A joint that another one of the same finger drives, as by a tendon or a gear: q = `multiplier` · q of
/// `joint` + `offset`.
///
/// It counts as a joint everywhere (plans hold its position), but is none that a finger can choose.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mimic {
    /// The driving joint: one of the same finger that moves by itself.
    #[schemars(example = &"index-middle")]
    pub joint: String,
    /// By what its position is multiplied (no unit between joints of one kind).
    #[serde(default = "default_multiplier")]
    #[schemars(range(min = -100.0, max = 100.0), extend("x-unit" = "1"))]
    #[schemars(example = 0.8)]
    pub multiplier: f64,
    /// What is added (rad; m where prismatic).
    #[serde(default)]
    #[schemars(range(min = -10.0, max = 10.0), extend("x-unit" = "rad; m where prismatic"))]
    #[schemars(example = 0.1)]
    pub offset: f64,
}

fn default_multiplier() -> f64 {
    1.0
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum JointKind {
    /// Turns about its axis.
    #[default]
    Revolute,
    /// Slides along its axis.
    Prismatic,
}

fn default_velocity() -> f64 {
    2.0
}

fn default_acceleration() -> f64 {
    20.0
}

fn default_effort() -> f64 {
    1.0
}
