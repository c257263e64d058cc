//! All that the page is told, as one JSON value.

use crate::ViewError;
use crate::extras::{CheckRow, Extras, GraphEdge, GraphPicture, GripCurves, ReplayTrack, Shown, StateCurves};
use crate::hand::{PoseData, pose};
use crate::motion::{MotionData, StatesData, check_state, motion};
use crate::number::{micro, milli, nano};
use crate::scene::{SceneData, scene};
use regrasp_api::{FingerIndex, GoalDescription, Hand, Problem, Slot};
use regrasp_plan::{ConeClaim, Plan, PlanCertificate, StoppedBy};
use regrasp_world::ChainHand;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

#[derive(Serialize)]
struct PageData<'a> {
    name: &'a str,
    seed: u64,
    versions: &'a BTreeMap<String, String>,
    plugins: BTreeMap<&'static str, &'a str>,
    cone: Option<ConeClaim>,
    contact_model: &'a str,
    /// The object's poses at the goals.
    goals: Vec<PoseData>,
    goals_reached: &'a [usize],
    stopped_by: Option<StoppedBy>,
    certificate: Option<&'a PlanCertificate>,
    #[serde(flatten)]
    scene: SceneData,
    motion: MotionData,
    curves: Option<CurvesData<'a>>,
    grip: Option<GripData<'a>>,
    verdict: &'a [CheckRow],
    graph: Option<GraphData<'a>>,
    replay: Option<ReplayData<'a>>,
}

#[derive(Serialize)]
struct CurvesData<'a> {
    margin: Vec<Option<f64>>,
    margin_name: &'a str,
    clearance: Vec<Option<f64>>,
    /// The pairs of bodies that occur, in words.
    pairs: Vec<&'a str>,
    /// For each state the index of its pair.
    pair: Vec<usize>,
    least_clearance: f64,
}

#[derive(Serialize)]
struct GripData<'a> {
    /// For each state and finger: empty, or a force (N, in O).
    forces: Vec<Vec<Vec<f64>>>,
    /// As many numbers a state as the hand has joints: parts of the limits.
    efforts: Vec<f64>,
    origin: &'a str,
}

#[derive(Serialize)]
struct GraphData<'a> {
    states: StatesData,
    components: Vec<usize>,
    /// The same by paths in GS_n alone.
    grasp_components: Vec<usize>,
    ends: Vec<Option<&'a str>>,
    edges: &'a [GraphEdge],
}

#[derive(Serialize)]
struct ReplayData<'a> {
    caption: &'a str,
    times: Vec<f64>,
    poses: Vec<f64>,
}

/// The first plan's data, and those of the others.
#[derive(Serialize)]
pub(crate) struct AllData<'a> {
    label: &'a str,
    #[serde(flatten)]
    first: PageData<'a>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    beside: Vec<Value>,
}

pub(crate) fn all<'a>(first: Shown<'a>, others: &[Shown<'_>]) -> Result<AllData<'a>, ViewError> {
    let data_of = |shown: &Shown<'_>| data(shown.plan, shown.extras).map(written);
    let known = if others.is_empty() { Value::Null } else { data_of(&first)? };
    let mut beside = Vec::with_capacity(others.len());
    for other in others {
        let named = |error| ViewError::Beside { label: other.label.into(), error: Box::new(error) };
        let mut value = data_of(other).map_err(named)?;
        value["label"] = other.label.into();
        // What is the first plan's too is not written again.
        for shared in ["hand", "object", "obstacles"] {
            if value[shared] == known[shared] {
                value[shared].take();
            }
        }
        beside.push(value);
    }
    Ok(AllData { label: first.label, first: data(first.plan, first.extras)?, beside })
}

fn written(data: PageData<'_>) -> Value {
    serde_json::to_value(data).expect("numbers and names can always be written")
}

fn data<'a>(plan: &'a Plan, extras: &'a Extras) -> Result<PageData<'a>, ViewError> {
    let problem = &plan.scenario.problem;
    let hand = ChainHand::new(problem.hand.clone())?;
    let states = plan.segments.iter().map(|segment| segment.states.len()).sum();
    let plugin = |(slot, choice): (&Slot, &'a regrasp_plan::PluginChoice)| (slot.name(), choice.id.as_str());
    Ok(PageData {
        name: &plan.scenario.name,
        seed: plan.seed,
        versions: &plan.versions,
        plugins: plan.scenario.plugins.iter().map(plugin).collect(),
        cone: plan.claims.contact.cone,
        contact_model: &plan.claims.contact.model,
        goals: goals(problem)?,
        goals_reached: &plan.goals_reached,
        stopped_by: plan.stopped_by,
        certificate: plan.certificate.as_ref(),
        scene: scene(problem)?,
        motion: motion(&plan.segments, &hand)?,
        curves: extras.curves.as_ref().map(|curves| curves_data(curves, states)).transpose()?,
        grip: extras.grip.as_ref().map(|grip| grip_data(grip, states, &hand)).transpose()?,
        verdict: &extras.checks,
        graph: extras.graph.as_ref().map(|graph| graph_data(graph, &hand)).transpose()?,
        replay: extras.replay.as_ref().map(replay_data).transpose()?,
    })
}

fn goals(problem: &Problem) -> Result<Vec<PoseData>, ViewError> {
    let goal = |(g, goal): (usize, &GoalDescription)| pose(&goal.pose, &format!("goal[{g}].pose"));
    problem.goal.iter().enumerate().map(goal).collect()
}

fn foreign<T>(what: &str) -> Result<T, ViewError> {
    Err(ViewError::Foreign(what.into()))
}

fn curves_data(curves: &StateCurves, states: usize) -> Result<CurvesData<'_>, ViewError> {
    let lengths = [curves.margin.len(), curves.clearance.len(), curves.clearance_pair.len()];
    if lengths != [states; 3] {
        return foreign("the curves do not have one value for each state of the plan");
    }
    let mut pairs: Vec<&str> = curves.clearance_pair.iter().map(String::as_str).collect();
    pairs.sort_unstable();
    pairs.dedup();
    let index = |name: &String| pairs.binary_search(&name.as_str()).expect("every name is among them");
    Ok(CurvesData {
        margin: curves.margin.iter().map(|x| x.map(micro)).collect(),
        margin_name: &curves.margin_name,
        clearance: curves.clearance.iter().map(|x| x.map(nano)).collect(),
        pair: curves.clearance_pair.iter().map(index).collect(),
        pairs,
        least_clearance: curves.least_clearance,
    })
}

fn grip_data<'a>(grip: &'a GripCurves, states: usize, hand: &ChainHand) -> Result<GripData<'a>, ViewError> {
    let fingers = hand.finger_count();
    let joints: usize = (0..fingers).map(|f| hand.finger(FingerIndex(f as u8)).joints.len()).sum();
    let fits = [grip.forces.len(), grip.efforts.len()] == [states; 2]
        && grip.forces.iter().all(|forces| forces.len() == fingers)
        && grip.efforts.iter().all(|efforts| efforts.len() == joints);
    if !fits {
        return foreign("the forces are not one for each state and finger of the plan");
    }
    let force = |force: &Option<[f64; 3]>| force.iter().flatten().map(|&x| milli(x)).collect();
    Ok(GripData {
        forces: grip.forces.iter().map(|forces| forces.iter().map(force).collect()).collect(),
        efforts: grip.efforts.iter().flatten().map(|&x| milli(x)).collect(),
        origin: &grip.origin,
    })
}

fn graph_data<'a>(graph: &'a GraphPicture, hand: &ChainHand) -> Result<GraphData<'a>, ViewError> {
    let mut states = StatesData::default();
    for node in &graph.nodes {
        check_state(&node.state, hand)
            .map_err(|reason| ViewError::Foreign(format!("a node of the graph: {reason}")))?;
        states.push(&node.state);
    }
    if graph.edges.iter().any(|edge| edge.from.max(edge.to) >= graph.nodes.len()) {
        return foreign("an edge of the graph names a node that it does not have");
    }
    Ok(GraphData {
        states,
        components: graph.nodes.iter().map(|node| node.component).collect(),
        grasp_components: graph.nodes.iter().map(|node| node.grasp_component).collect(),
        ends: graph.nodes.iter().map(|node| node.end.as_deref()).collect(),
        edges: &graph.edges,
    })
}

fn replay_data(replay: &ReplayTrack) -> Result<ReplayData<'_>, ViewError> {
    let ordered = replay.times.is_sorted_by(|a, b| a <= b);
    let finite = replay.times.iter().chain(replay.poses.iter().flatten()).all(|x| x.is_finite());
    if replay.times.is_empty() || replay.times.len() != replay.poses.len() || !ordered || !finite {
        return foreign("the replay does not have one pose for each of its times, these in ascending order");
    }
    Ok(ReplayData {
        caption: &replay.caption,
        times: replay.times.iter().map(|&t| micro(t)).collect(),
        poses: replay.poses.iter().flatten().map(|&x| nano(x)).collect(),
    })
}
