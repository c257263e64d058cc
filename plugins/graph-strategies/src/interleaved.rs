//! `graph-strategy/interleaved`: the paper's Algorithm 1 with a biased α.
//!
//! While start and goal lie in different components, draw α: 0 explores GS_n (Algorithm 2), 1 tries to
//! connect a random node with another component by transfer and regrasps (Algorithm 3). The paper wants the
//! probability of α = 1 low at first and rising as the graph grows, and leaves its law open; ours is `P(α =
//! 1) = start + (end - start) · (1 - exp(-nodes / growth))`.
//!
//! By default it departs from the paper where that was measured to be faster: before all else start and goals
//! are tried to be joined (`first_try`, `join_ends`), every new node is kept (`drop_unconnected`), and one
//! component is tried a draw (`all_components`).
//!
//! Source: A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous manipulation
//! planning", SSD 2007, section IV.

use crate::nearest::{self, nearest_of_each_component};
use regrasp_api::{
    Action, Build, CallError, Context, EdgeKind, Entry, GraphStrategy, GraphView, Link, NodeId, SearchPolicy,
    Settings, SettingsError, Slot, check_settings, inventory,
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
    /// Whether the start is tried to be joined to each goal by transfers and regrasps before anything else.
    /// In the paper both are in the graph from the first line on, and nothing goes before the search
    /// (Algorithm 1, lines 1 and 2).
    pub first_try: bool,
    /// How often, before even that, a relay is tried: rolls towards the goal, each as far as it goes, and
    /// between them regrasps of those fingers alone that bar the way. With `first_try` alone; 0 means never.
    /// The paper has none.
    #[schemars(range(min = 0, max = 1000))]
    pub relays: usize,
    /// Whether paths in GS_n from start and goals to each component are tried at once; the paper tries those
    /// of new nodes alone (Algorithm 2).
    pub join_ends: bool,
    /// Whether new nodes are tried to be joined by paths in GS_n at all. Without, Algorithm 3 alone joins the
    /// graph: to see what GS_n is good for.
    pub grasp_paths: bool,
    /// Whether a new node that no path in GS_n joins to a component is dropped, as in the paper (Algorithm 2,
    /// lines 10 to 13).
    pub drop_unconnected: bool,
    /// Whether α = 1 tries the drawn node with each other component, as in the paper (Algorithm 3, line 3),
    /// or with the nearest one that was not tried with it.
    pub all_components: bool,
    /// How the planner carries out the strategy's actions.
    pub policy: SearchPolicy,
}

impl Default for InterleavedSettings {
    /// The paper leaves the law open; this one did best in `studies/alpha.toml`. What the paper has for the
    /// rest, the preset `paper` sets.
    fn default() -> Self {
        Self {
            start: 0.1,
            end: 1.0,
            growth: 5.0,
            first_try: true,
            relays: 4,
            join_ends: true,
            grasp_paths: true,
            drop_unconnected: false,
            all_components: false,
            policy: SearchPolicy::default(),
        }
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
        let InterleavedSettings { start, end, growth, .. } = self.settings;
        start + (end - start) * (1.0 - (-(nodes as f64) / growth).exp())
    }

    /// Line 1 of Algorithm 3, and what becomes of the node: `None` if it was tried with all of its
    /// neighbours.
    fn connection(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Option<Action> {
        let (node, other) = pair_to_connect(graph, context)?;
        Some(if self.settings.all_components {
            Action::ConnectAll(node, EdgeKind::TransferRegrasp)
        } else {
            Action::Connect(node, other, EdgeKind::TransferRegrasp)
        })
    }

    fn link(&self) -> Link {
        match self.settings {
            InterleavedSettings { grasp_paths: false, .. } => Link::None,
            InterleavedSettings { drop_unconnected: true, .. } => Link::ComponentsOrDrop,
            _ => Link::Components,
        }
    }
}

impl GraphStrategy for Interleaved {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        if graph.joined() {
            return Ok(Action::Query);
        }
        let InterleavedSettings { first_try, join_ends, grasp_paths, .. } = self.settings;
        let join_ends = join_ends && grasp_paths;
        let reach = first_try.then(|| reach_goals(graph)).flatten();
        if let Some(action) = reach.or_else(|| if join_ends { nearest::join_ends(graph) } else { None }) {
            return Ok(action);
        }
        let (samples, most) = graph.samples();
        if samples >= most {
            return Ok(Action::Stop);
        }
        // α of Algorithm 1, line 5.
        let connect = context.random.unit() < self.probability(graph.node_count());
        let connection = if connect { self.connection(graph, context) } else { None };
        Ok(connection.unwrap_or(Action::Explore(self.link())))
    }

    fn policy(&self) -> SearchPolicy {
        let InterleavedSettings { first_try, relays, policy, .. } = self.settings;
        SearchPolicy { relays: if first_try { relays } else { 0 }, ..policy }
    }
}

/// The start and a goal that were not tried to be joined by transfer and regrasps.
///
/// The paper has nothing of the kind: both are in its graph from the first line on, and are joined by what
/// grows there.
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
        references: &[
            "A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation \
             planning, SSD 2007, Algorithm 1",
        ],
        schema: InterleavedSettings::schema,
        check: check_settings::<InterleavedSettings>,
        build: Build::GraphStrategy(|json, _| {
            Ok(Box::new(Interleaved::new(InterleavedSettings::from_json(json)?)?))
        }),
    }
}
