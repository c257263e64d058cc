//! Hands as serial chains of joints with link shapes and a spherical fingertip.

use super::{PlacedShape, PoseDescription};
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
    pub fingertip_radius: f64,
    /// What touches the object: the ball itself, or a point.
    #[serde(default, skip_serializing_if = "Fingertip::is_ball")]
    pub fingertip: Fingertip,
    /// Shapes fixed to the hand's frame.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub palm: Vec<PlacedShape>,
    /// The fingers, in the order in which everything counts them.
    pub finger: Vec<FingerDescription>,
}

/// What a fingertip does on the object while the object moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fingertip {
    /// A ball: it rolls, and the contact moves over both bodies.
    #[default]
    Ball,
    /// A point that stays where it was set down and about which the finger turns freely (the point contact of grasp statics). The ball is its
    /// collision shape: its centre keeps the place over the object that it had at touch-down, one radius above the contact along the
    /// surface's normal there. What this neglects is of the order of the radius: a declared point wants a small one.
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
    pub tip: [f64; 3],
    /// Joint positions (rad; m where prismatic) that the finger takes when it rests free of the object.
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
    /// The axis in the joint's frame; its length does not matter.
    pub axis: [f64; 3],
    /// Lowest position (rad; m where prismatic).
    pub lower: f64,
    /// Highest position (rad; m where prismatic).
    pub upper: f64,
    /// Largest speed (rad/s; m/s where prismatic).
    #[serde(default = "default_velocity")]
    pub velocity: f64,
    /// Largest acceleration (rad/s²; m/s² where prismatic).
    #[serde(default = "default_acceleration")]
    pub acceleration: f64,
    /// Largest effort (N·m; N where prismatic).
    #[serde(default = "default_effort")]
    pub effort: f64,
    /// Shapes of the link behind the joint, in the joint's moved frame.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub link: Vec<PlacedShape>,
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
