//! What can be shown beside the plan itself; other crates compute it.

use regrasp_api::BodyPair;
use regrasp_plan::Plan;
use serde::Serialize;

/// A plan on a page, and what is shown with it.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// What else is known of it.
    pub extras: &'a Extras,
    /// What tells it from the page's other plans, such as its file's name.
    pub label: &'a str,
}

/// What is known of a plan beyond its file. Everything is optional: what is absent is not shown.
#[derive(Clone, Debug, Default)]
pub struct Extras {
    /// Margin and clearance over time.
    pub curves: Option<StateCurves>,
    /// The forces that hold the object, over time.
    pub grip: Option<GripCurves>,
    /// The verifier's checks.
    pub checks: Vec<CheckRow>,
    /// The manipulation graph.
    pub graph: Option<GraphPicture>,
    /// Where a simulation took the object.
    pub replay: Option<ReplayTrack>,
}

/// Two figures for each state of the plan, segment after segment.
#[derive(Clone, Debug, Default)]
pub struct StateCurves {
    /// The closure margin, or what the plan's criterion puts in its place (no unit); `None` where there is
    /// none.
    pub margin: Vec<Option<f64>>,
    /// What `margin` is, in a few words.
    pub margin_name: String,
    /// The smallest distance of two bodies that may not touch (m); `None` where there are none.
    pub clearance: Vec<Option<f64>>,
    /// The two bodies, in words; empty where there are none.
    pub clearance_pair: Vec<String>,
    /// The clearance that the plan must keep (m).
    pub least_clearance: f64,
}

/// How the fingers hold the object at each state of the plan, segment after segment.
#[derive(Clone, Debug, Default)]
pub struct GripCurves {
    /// For each finger the force that it exerts on the object, in O (N); `None` where it does not hold.
    pub forces: Vec<Vec<Option<[f64; 3]>>>,
    /// For each joint, finger after finger, the effort that this takes, in parts of its limit.
    pub efforts: Vec<Vec<f64>>,
    /// Where the forces come from, in a few words.
    pub origin: String,
}

/// One check of the verifier.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckRow {
    /// Its name.
    pub name: String,
    /// Whether it is met.
    pub ok: bool,
    /// The worst value; absent where there was nothing to check.
    pub worst: Option<f64>,
    /// The value that the worst may not pass.
    pub limit: f64,
    /// `≤` or `>`: on which side of the limit a value is good.
    pub sign: String,
    /// The unit of both.
    pub unit: String,
    /// Where the worst value is reached, in words.
    pub place: String,
    /// The time of that place (s).
    pub time: Option<f64>,
    /// The finger that it is about, counted from 0.
    pub finger: Option<usize>,
    /// The joint of that finger, counted from 0 at the base.
    pub joint: Option<usize>,
    /// The two bodies that it is about.
    pub pair: Option<BodyPair>,
}

/// The manipulation graph at the end of a run.
#[derive(Clone, Debug, Default)]
pub struct GraphPicture {
    /// The nodes, by number.
    pub nodes: Vec<GraphNode>,
    /// What was tried between them.
    pub edges: Vec<GraphEdge>,
}

/// A node: a grasp.
#[derive(Clone, Debug)]
pub struct GraphNode {
    /// Object, joints and contacts.
    pub state: regrasp_plan::StateRecord,
    /// The component that it belongs to.
    pub component: usize,
    /// The component that it belongs to by paths in GS_n alone.
    pub grasp_component: usize,
    /// `start`, or the goal that it was made for, such as `goal 1`; absent for all others.
    pub end: Option<String>,
}

/// Two nodes that the planner tried to join.
#[derive(Clone, Debug, Serialize)]
pub struct GraphEdge {
    /// One node.
    pub from: usize,
    /// The other.
    pub to: usize,
    /// `grasp` (a path in GS_n) or `transfer-regrasp`.
    pub kind: &'static str,
    /// `failed`, `unchecked`, `valid`, `executable` or `used`.
    pub fate: &'static str,
}

/// Where a simulation of the plan took the object.
#[derive(Clone, Debug, Default)]
pub struct ReplayTrack {
    /// What simulated it, and how it ended, in a few words.
    pub caption: String,
    /// Times on the plan's clock (s), ascending.
    pub times: Vec<f64>,
    /// The object's poses in the hand's frame then: position (m), and orientation as a unit quaternion w, x,
    /// y, z.
    pub poses: Vec<[f64; 7]>,
}
