//! `graph-strategy/lazy`: edges are checked only when a path uses them.
//!
//! A new node gets unchecked edges inside GS_n to its `neighbours` nearest nodes, at no cost. Once start and
//! goal are joined, the unchecked edges of the shortest path are checked, those near its ends first (there
//! are few ways out of an end, so that a bad edge is found early); an edge that fails leaves the graph, and
//! the next shortest path is looked at. A path whose edges are all valid is queried, that is decomposed into
//! transfers and regrasps. So a path in GS_n is never decomposed before its check; nor would that be unsafe:
//! decomposition lays the path again.
//!
//! Where GS_n is not connected, no number of samples joins start and goal. Therefore a share `connect` of the
//! steps that find them apart tries two components by transfer and regrasps (Algorithm 3), which has no lazy
//! form.
//!
//! It pays where paths inside GS_n are dear to check and mostly valid (fine meshes, small steps); a shortest
//! path prefers long edges, so that where long ones mostly fail, many checks are wasted.
//!
//! Source: R. Bohlin, L. Kavraki, "Path planning using lazy PRM", ICRA 2000. Departures: nodes were checked
//! when they were sampled, and the roadmap grows by one node when start and goal fall apart, not by a batch.

use crate::nearest::untried_pair;
use regrasp_api::{
    Action, Build, CallError, Context, EdgeId, EdgeKind, EdgeVerdict, Entry, GraphStrategy, GraphView, Link,
    NodeId, SearchPolicy, Settings, SettingsError, Slot, check_settings, inventory,
};
use serde::{Deserialize, Serialize};

/// Nodes of other components that a node is tried with by transfer and regrasps.
const CONNECTED_NEIGHBOURS: usize = 5;

/// Settings of [`Lazy`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LazySettings {
    /// Nearest nodes that a new node gets unchecked edges to.
    #[schemars(range(min = 1, max = 1000))]
    pub neighbours: usize,
    /// Probability that while start and goal are apart two components are tried by transfer and regrasps.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub connect: f64,
    /// How the planner carries out the strategy's actions.
    pub policy: SearchPolicy,
}

impl Default for LazySettings {
    /// Our choices.
    fn default() -> Self {
        Self { neighbours: 5, connect: 0.2, policy: SearchPolicy::default() }
    }
}

impl Settings for LazySettings {}

/// Checks edges only when a path uses them.
#[derive(Clone, Copy, Debug)]
pub struct Lazy {
    settings: LazySettings,
}

impl Lazy {
    /// A strategy that links new nodes as the settings say.
    pub fn new(settings: LazySettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }
}

impl GraphStrategy for Lazy {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        if graph.joined() {
            return Ok(unchecked_edge(graph).map_or(Action::Query, Action::Check));
        }
        if let Some(goal) = untried_goal(graph) {
            return Ok(Action::Connect(graph.start(), goal, EdgeKind::Grasp));
        }
        let (samples, most) = graph.samples();
        if samples >= most {
            return Ok(Action::Stop);
        }
        if context.random.unit() < self.settings.connect
            && let Some((a, b)) = untried_pair(graph, CONNECTED_NEIGHBOURS, context)
        {
            return Ok(Action::Connect(a, b, EdgeKind::TransferRegrasp));
        }
        Ok(Action::Explore(Link::Unchecked(self.settings.neighbours)))
    }

    fn policy(&self) -> SearchPolicy {
        self.settings.policy
    }
}

/// The unchecked edge of the shortest path that is nearest to one of its ends, the start's first.
fn unchecked_edge(graph: &dyn GraphView) -> Option<EdgeId> {
    let path = graph.shortest_path();
    let is_unchecked = |id: &EdgeId| {
        let place = graph.edges().binary_search_by_key(id, |edge| edge.id);
        place.is_ok_and(|place| graph.edges()[place].verdict == EdgeVerdict::Unchecked)
    };
    let inward = |i: &usize| (*i).min(path.len() - 1 - *i);
    (0..path.len()).filter(|&i| is_unchecked(&path[i])).min_by_key(inward).map(|i| path[i])
}

/// A goal to which no direct path in GS_n from the start was tried: the ends have no edges of their own.
fn untried_goal(graph: &dyn GraphView) -> Option<NodeId> {
    let untried = |goal: &NodeId| !graph.attempted(graph.start(), *goal, EdgeKind::Grasp);
    graph.goals().iter().copied().find(untried)
}

inventory::submit! {
    Entry {
        id: "graph-strategy/lazy",
        slots: &[Slot::GraphStrategy],
        summary: "enters edges unchecked, and checks those that a path from start to goal uses",
        references: &["R. Bohlin, L. Kavraki, Path planning using lazy PRM, ICRA 2000"],
        schema: LazySettings::schema,
        check: check_settings::<LazySettings>,
        build: Build::GraphStrategy(|json, _| Ok(Box::new(Lazy::new(LazySettings::from_json(json)?)?))),
    }
}
