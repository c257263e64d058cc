//! `graph-strategy/explore-first`: a roadmap first, its connection afterwards.
//!
//! While the graph is small only Algorithm 2 works: nodes of GS_n are sampled and joined by paths inside
//! GS_n. Once the graph has `nodes` nodes, or the share `fraction` of the budget is generated, its components
//! are connected by transfer and regrasps (Algorithm 3), near pairs first; where no pair is left that was not
//! tried, one more node is explored. A query is asked as soon as start and goal are joined, in either phase.
//!
//! It differs from the paper's Algorithm 1 by its sharp turn from exploring to connecting, in place of an α
//! that rises slowly. It pays where exploring is cheap and attempts to connect are not: most of them become
//! needless in a dense graph. It wastes time where GS_n falls into many components that no sample joins.
//!
//! Sources: the phases are those of the probabilistic roadmap, L. Kavraki, P. Švestka, J.-C. Latombe, M.
//! Overmars, "Probabilistic roadmaps for path planning in high-dimensional configuration spaces", IEEE T-RA
//! 1996 (construction, then expansion between components); Algorithms 2 and 3 are those of A. Sahbani, J.-P.
//! Saut, V. Perdereau, SSD 2007.

use crate::nearest::connect_or_explore;
use regrasp_api::{
    Action, Build, CallError, Context, Entry, GraphStrategy, GraphView, SearchPolicy, Settings,
    SettingsError, Slot, check_settings, inventory,
};
use serde::{Deserialize, Serialize};

/// Settings of [`ExploreFirst`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ExploreFirstSettings {
    /// Size of the graph, in nodes, at which exploring ends.
    #[schemars(range(min = 0, max = 100_000))]
    pub nodes: usize,
    /// Share of the budget of nodes after which exploring ends at the latest.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub fraction: f64,
    /// Nearest nodes of other components that a node is tried to be connected with.
    #[schemars(range(min = 1, max = 1000))]
    pub neighbours: usize,
    /// How the planner carries out the strategy's actions.
    pub policy: SearchPolicy,
}

impl Default for ExploreFirstSettings {
    /// Our choices: a graph of the size that the paper's Table 1 ends with (23 to 65 nodes), and half of the
    /// budget.
    fn default() -> Self {
        Self { nodes: 25, fraction: 0.5, neighbours: 5, policy: SearchPolicy::default() }
    }
}

impl Settings for ExploreFirstSettings {}

/// Explores up to a size of the graph, then connects.
#[derive(Clone, Copy, Debug)]
pub struct ExploreFirst {
    settings: ExploreFirstSettings,
}

impl ExploreFirst {
    /// A strategy with the given end of the exploration.
    pub fn new(settings: ExploreFirstSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    /// Whether the graph is still too small to connect its components.
    fn explores(&self, graph: &dyn GraphView) -> bool {
        let (samples, most) = graph.samples();
        graph.node_count() < self.settings.nodes && (samples as f64) < self.settings.fraction * most as f64
    }
}

impl GraphStrategy for ExploreFirst {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        Ok(connect_or_explore(graph, (!self.explores(graph)).then_some(self.settings.neighbours), context))
    }

    fn policy(&self) -> SearchPolicy {
        self.settings.policy
    }
}

inventory::submit! {
    Entry {
        id: "graph-strategy/explore-first",
        slots: &[Slot::GraphStrategy],
        summary: "explores GS_n up to a size of the graph, then connects its components",
        references: &[
            "L. Kavraki, P. Švestka, J.-C. Latombe, M. Overmars, Probabilistic roadmaps for path \
             planning in high-dimensional configuration spaces, IEEE T-RA 1996",
            "A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation \
             planning, SSD 2007, Algorithms 2 and 3",
        ],
        schema: ExploreFirstSettings::schema,
        check: check_settings::<ExploreFirstSettings>,
        build: Build::GraphStrategy(|json, _| {
            Ok(Box::new(ExploreFirst::new(ExploreFirstSettings::from_json(json)?)?))
        }),
    }
}
