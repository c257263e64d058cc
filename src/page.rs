//! What a page shows beside the plan itself, and places of a plan in words.

mod grip;

use crate::api::{BodyPair, EdgeKind, Hand, NodeId, Problem};
use crate::plan::{Criterion, Place, Plan, state_record};
use crate::planner::{EdgeRecord, End, Fate, GraphRecord};
use crate::verify::{Check, StateFigures};
use crate::view::{CheckRow, Extras, GraphEdge, GraphNode, GraphPicture, StateCurves};

/// What the verifier knows of a plan.
pub fn of_plan(plan: &Plan) -> Extras {
    let problem = &plan.scenario.problem;
    let verdict = crate::verify::verify(plan);
    Extras {
        checks: verdict.checks.iter().map(|check| check_row(check, problem)).collect(),
        // A plan without sense has no figures; its failed checks say why.
        curves: crate::verify::series(plan).ok().map(|figures| curves(plan, &figures.concat())),
        grip: grip::grip(plan),
        ..Extras::default()
    }
}

fn check_row(check: &Check, problem: &Problem) -> CheckRow {
    CheckRow {
        name: check.name.into(),
        ok: check.ok,
        worst: check.worst,
        limit: check.limit,
        sign: check.side.sign().into(),
        unit: check.unit.into(),
        place: place_text(&check.place, problem),
        time: check.place.time,
        finger: check.place.finger,
        joint: check.place.joint,
        pair: check.place.pair,
    }
}

fn curves(plan: &Plan, figures: &[StateFigures]) -> StateCurves {
    let problem = &plan.scenario.problem;
    let pair = |(a, b): BodyPair| format!("{} and {}", problem.name_of(a), problem.name_of(b));
    let pair_of = |figure: &StateFigures| figure.clearance.map_or(String::new(), |(_, bodies)| pair(bodies));
    StateCurves {
        margin: figures.iter().map(|figure| figure.margin).collect(),
        margin_name: match plan.claims.criterion {
            Criterion::Closure => "Closure margin".into(),
            _ => "Room to hold the load".into(),
        },
        clearance: figures.iter().map(|figure| figure.clearance.map(|(distance, _)| distance)).collect(),
        clearance_pair: figures.iter().map(pair_of).collect(),
        least_clearance: problem.limits.tolerances.clearance,
    }
}

/// The manipulation graph of a run.
pub fn graph(record: &GraphRecord, hand: &dyn Hand) -> GraphPicture {
    let ends = record.ends();
    let end = |node| ends.iter().find(|(_, other)| *other == node).map(|(end, _)| end_name(*end));
    let nodes = record.nodes().iter().zip(record.grasp_components()).enumerate();
    GraphPicture {
        nodes: nodes
            .map(|(index, (q, inside))| {
                let node = NodeId(index as u32);
                let component = record.component(node).0 as usize;
                let state = state_record(q, 0.0, hand);
                GraphNode { state, component, grasp_component: inside.0 as usize, end: end(node) }
            })
            .collect(),
        edges: record.edges().iter().map(graph_edge).collect(),
    }
}

fn end_name(end: End) -> String {
    match end {
        End::Start => "start".into(),
        End::Goal(index) => format!("goal {}", index + 1),
    }
}

fn graph_edge(edge: &EdgeRecord) -> GraphEdge {
    GraphEdge {
        from: edge.from.0 as usize,
        to: edge.to.0 as usize,
        kind: match edge.kind {
            EdgeKind::Grasp => "grasp",
            EdgeKind::TransferRegrasp => "transfer-regrasp",
        },
        fate: match edge.fate {
            Fate::Failed => "failed",
            Fate::Unchecked => "unchecked",
            Fate::Valid => "valid",
            Fate::Executable => "executable",
            Fate::Used => "used",
        },
    }
}

/// A place in a plan in words, fingers and obstacles by the names that the problem gives them. Goals,
/// segments, states and joints are counted from 1.
pub fn place_text(place: &Place, problem: &Problem) -> String {
    // Everything is counted from 1 where a person reads of it; indices of data begin with 0.
    let part = |name: &str, index: Option<usize>| index.map(|index| format!("{name} {}", index + 1));
    let parts = [
        part("goal", place.goal),
        part("segment", place.segment),
        part("state", place.state),
        place.time.map(|time| format!("{time:.2} s")),
        place.finger.map(|finger| finger_name(finger, problem)),
        part("joint", place.joint),
        place.pair.map(|(a, b)| format!("{} and {}", problem.name_of(a), problem.name_of(b))),
        place.note.clone(),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn finger_name(finger: usize, problem: &Problem) -> String {
    let named = problem.hand.finger.get(finger).map(|finger| format!("finger `{}`", finger.name));
    named.unwrap_or_else(|| format!("finger {}", finger + 1))
}
