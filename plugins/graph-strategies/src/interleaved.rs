//! `graph-strategy/interleaved`: the paper's Algorithm 1 with a biased α.
//!
//! First the start is tried to be joined to each goal by transfer and regrasps (Algorithm 3). Then, while start and goal lie in
//! different components, draw α: 0 explores GS_n (Algorithm 2), 1 tries to connect a random
//! node with another component by transfer and regrasps (Algorithm 3). The paper wants the probability of α = 1 low at
//! first and rising as the graph grows, and leaves its law open; ours is
//! `P(α = 1) = start + (end - start) · (1 - exp(-nodes / growth))`.
//!
//! Source: A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous manipulation planning", SSD 2007,
//! section IV.

use crate::nearest::{join_ends, nearest_of_each_component};
use regrasp_api::{
    Action, Build, CallError, Context, EdgeKind, Entry, GraphStrategy, GraphView, Link, NodeId, Settings,
    SettingsError, Slot, check_settings, inventory,
};
use serde::{Deserialize, Serialize};

/// Settings of [`Interleaved`]: the law of α.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct InterleavedSettings {
    /// Probability of α = 1 for an empty graph.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub start: f64,
    /// Probability of α = 1 for a large graph.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub end: f64,
    /// Number of nodes after which 63 % of the way from `start` to `end` is made (no unit).
    #[schemars(range(min = 0.1, max = 1e6), extend("x-unit" = "1"))]
    pub growth: f64,
}

impl Default for InterleavedSettings {
    /// The paper leaves the law open; this one did best in `studies/alpha.toml`.
    fn default() -> Self {
        Self { start: 0.1, end: 1.0, growth: 5.0 }
    }
}

impl Settings for InterleavedSettings {}

/// The paper's strategy.
#[derive(Clone, Copy, Debug)]
pub struct Interleaved {
    settings: InterleavedSettings,
}

impl Interleaved {
    /// A strategy with the given law of α.
    pub fn new(settings: InterleavedSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    /// The probability of α = 1 in a graph of `nodes` nodes.
    fn probability(&self, nodes: usize) -> f64 {
        let InterleavedSettings { start, end, growth } = self.settings;
        start + (end - start) * (1.0 - (-(nodes as f64) / growth).exp())
    }
}

impl GraphStrategy for Interleaved {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        if graph.joined() {
            return Ok(Action::Query);
        }
        if let Some(action) = reach_goals(graph).or_else(|| join_ends(graph)) {
            return Ok(action);
        }
        let (generated, most) = graph.generated();
        if generated >= most {
            return Ok(Action::Stop);
        }
        let connect = context.random.unit() < self.probability(graph.node_count());
        let pair = if connect { pair_to_connect(graph, context) } else { None };
        Ok(match pair {
            Some((a, b)) => Action::Connect(a, b, EdgeKind::TransferRegrasp),
            None => Action::Explore(Link::Components),
        })
    }
}

/// The start and a goal that were not tried to be joined by transfer and regrasps.
///
/// The paper connects both to the graph outside of GS_n at the end (section IV.D); tried at the beginning, between the two, it makes most of
/// the graph superfluous where the way is short.
fn reach_goals(graph: &dyn GraphView) -> Option<Action> {
    let start = graph.start();
    let untried =
        |&&goal: &&NodeId| goal != start && !graph.attempted(start, goal, EdgeKind::TransferRegrasp);
    let goal = graph.goals().iter().find(untried)?;
    Some(Action::Connect(start, *goal, EdgeKind::TransferRegrasp))
}

/// A random node and the nearest node of another component that was not tried with it.
fn pair_to_connect(graph: &dyn GraphView, context: &mut Context<'_>) -> Option<(NodeId, NodeId)> {
    let node = NodeId(context.random.index(graph.node_count()) as u32);
    let closest = nearest_of_each_component(graph, node)
        .into_iter()
        .filter(|&other| !graph.attempted(node, other, EdgeKind::TransferRegrasp))
        .min_by(|&a, &b| graph.distance(node, a).total_cmp(&graph.distance(node, b)));
    closest.map(|other| (node, other))
}

inventory::submit! {
    Entry {
        id: "graph-strategy/interleaved",
        slots: &[Slot::GraphStrategy],
        summary: "explores GS_n and connects components in turn, by the paper's biased α",
        references: &["A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation planning, SSD 2007, Algorithm 1"],
        schema: InterleavedSettings::schema,
        check: check_settings::<InterleavedSettings>,
        build: Build::GraphStrategy(|json, _| Ok(Box::new(Interleaved::new(InterleavedSettings::from_json(json)?)?))),
    }
}
