//! What a plan file holds. SI units; keys in the order of the fields.

use crate::{Claims, ObjectRecord, PlanCertificate, PluginNotes, Statistics};
use regrasp_api::{Problem, Slot};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The version of the format that this crate writes. It reads [`OLDEST_VERSION`] and all between.
pub const VERSION: u32 = 2;
/// The oldest version that this crate reads. What version 2 adds is optional, so that both are one type.
pub const OLDEST_VERSION: u32 = 1;

/// The name of the format, the file's first key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Format {
    /// A plan file.
    #[default]
    #[serde(rename = "regrasp-plan")]
    RegraspPlan,
}

/// A whole plan: it stands alone, whatever becomes of the scenario file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Says that this is a plan file.
    pub format: Format,
    /// [`VERSION`]; older in plans that an older program made.
    pub version: u32,
    /// What was to be done, everything resolved: no file names, no defaults left out.
    pub scenario: ResolvedScenario,
    /// The seed of all random streams.
    pub seed: u64,
    /// Versions of the programs that made the plan, by name.
    pub versions: BTreeMap<String, String>,
    /// What the program derived from the scenario's object; absent where its mesh is all there is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub object: Option<ObjectRecord>,
    /// What the plan claims of its contacts and grasps.
    pub claims: Claims,
    /// For each goal that was reached, in turn: how many segments are done by then (0 where the start is the
    /// goal).
    pub goals_reached: Vec<usize>,
    /// What stopped the search before its end; absent where nothing did.
    pub stopped_by: Option<StoppedBy>,
    /// How the search went.
    pub statistics: Statistics,
    /// What the plugins have to say of the plan, each by its slot: names and values of their own, which
    /// nothing checks.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub notes: BTreeMap<Slot, PluginNotes>,
    /// What the verifier certifies; absent until it has.
    pub certificate: Option<PlanCertificate>,
    /// The motion.
    pub segments: Vec<SegmentRecord>,
}

/// The problem with the plugins that solved it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResolvedScenario {
    /// The scenario's name.
    pub name: String,
    /// Hand, object, obstacles, start, goals, limits; meshes are inside.
    pub problem: Problem,
    /// The plugin in each slot.
    pub plugins: BTreeMap<Slot, PluginChoice>,
}

/// A plugin with its settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PluginChoice {
    /// The plugin's id, such as `sampler/rlg`.
    pub id: String,
    /// Its settings, defaults included.
    pub settings: serde_json::Value,
}

/// What ended a search before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StoppedBy {
    /// The budget of nodes.
    MaxNodes,
    /// The time limit: the only end that another run may not repeat, together with `interrupt`.
    TimeLimit,
    /// The user.
    Interrupt,
}

/// One segment of the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SegmentRecord {
    /// What happens.
    pub kind: SegmentName,
    /// The finger that moves, counted from 0; for regrasps only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub finger: Option<u8>,
    /// The states. The first equals the last one of the segment before, exactly.
    pub states: Vec<StateRecord>,
}

/// What happens in a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SegmentName {
    /// The object moves, the fingertips roll.
    Transfer,
    /// The object rests, one finger moves.
    Regrasp,
}

/// Hand and object at one instant. In between, joints and position move linearly, orientation by slerp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateRecord {
    /// Time from the motion's start (s).
    pub time: f64,
    /// The object's pose in the hand's frame.
    pub object: PoseRecord,
    /// Joint positions (rad; m where prismatic): for each finger, base to tip.
    pub joints: Vec<Vec<f64>>,
    /// Velocity of each joint (rad/s; m/s where prismatic), as `joints`; absent in plans of version 1. The
    /// cubic through positions and velocities is what a trajectory controller plays.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocities: Option<Vec<Vec<f64>>>,
    /// For each finger its contact, or null where it does not hold the object.
    pub contacts: Vec<Option<ContactRecord>>,
    /// For each contact its cone's number among `claims.contact.cones`; absent where all contacts share
    /// `claims.contact.cone`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cones: Option<Vec<Option<usize>>>,
    /// For each finger the force that its contact exerts on the object, in O (N); null where it does not
    /// hold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub forces: Option<Vec<Option<[f64; 3]>>>,
}

/// A pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PoseRecord {
    /// Position (m).
    pub position: [f64; 3],
    /// Orientation as a unit quaternion w, x, y, z.
    pub orientation: [f64; 4],
}

/// Where a fingertip touches the object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactRecord {
    /// The point in the object's frame (m).
    pub point_O: [f64; 3],
    /// The unit normal in the object's frame, outward: from the object to the fingertip.
    pub normal_O: [f64; 3],
    /// The point in the fingertip's frame: origin at the ball's centre, axes of the last link (m).
    pub point_F: [f64; 3],
}
