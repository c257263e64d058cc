//! `graph-strategy/connect-first`: as few nodes as possible.
//!
//! Whenever two components hold near nodes that were not tried with each other, they are tried: start and
//! goals by a path in GS_n, all others by transfer and regrasps (Algorithm 3), the newest node and the ends
//! first. A new node is sampled only when no such pair is left. `neighbours` bounds how many nodes of other
//! components each node is tried with, and so how much is spent on a graph before it grows.
//!
//! It is the other end of the paper's α: P(α = 1) = 1 while there is something to connect. It pays where
//! samples are dear (tight workspaces, slow samplers) or the problem is solved by few regrasps; elsewhere it
//! spends its time on transfers between nodes that one more sample would have joined inside GS_n.
//!
//! Sources: Algorithms 2 and 3 of A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous
//! manipulation planning", SSD 2007; trying all links of a small roadmap before it grows is in the manner of
//! T. Siméon, J.-P. Laumond, C. Nissoux, "Visibility-based probabilistic roadmaps for motion planning",
//! Advanced Robotics 2000, without its filter of nodes.

use crate::nearest::connect_or_explore;
use regrasp_api::{
    Action, Build, CallError, Context, Entry, GraphStrategy, GraphView, SearchPolicy, Settings,
    SettingsError, Slot, check_settings, inventory,
};
use serde::{Deserialize, Serialize};

/// Settings of [`ConnectFirst`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ConnectFirstSettings {
    /// Nearest nodes of other components that a node is tried to be connected with.
    #[schemars(range(min = 1, max = 1000))]
    pub neighbours: usize,
    /// How the planner carries out the strategy's actions.
    pub policy: SearchPolicy,
}

impl Default for ConnectFirstSettings {
    /// Our choice.
    fn default() -> Self {
        Self { neighbours: 3, policy: SearchPolicy::default() }
    }
}

impl Settings for ConnectFirstSettings {}

/// Explores only when nothing is left to connect.
#[derive(Clone, Copy, Debug)]
pub struct ConnectFirst {
    settings: ConnectFirstSettings,
}

impl ConnectFirst {
    /// A strategy that tries each node with so many neighbours.
    pub fn new(settings: ConnectFirstSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }
}

impl GraphStrategy for ConnectFirst {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        Ok(connect_or_explore(graph, Some(self.settings.neighbours), context))
    }

    fn policy(&self) -> SearchPolicy {
        self.settings.policy
    }
}

inventory::submit! {
    Entry {
        id: "graph-strategy/connect-first",
        slots: &[Slot::GraphStrategy],
        summary: "explores only when no near pair of nodes is left to connect",
        references: &[
            "A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation \
             planning, SSD 2007, Algorithms 2 and 3",
            "T. Siméon, J.-P. Laumond, C. Nissoux, Visibility-based probabilistic roadmaps for motion \
             planning, Advanced Robotics 2000",
        ],
        schema: ConnectFirstSettings::schema,
        check: check_settings::<ConnectFirstSettings>,
        build: Build::GraphStrategy(|json, _| {
            Ok(Box::new(ConnectFirst::new(ConnectFirstSettings::from_json(json)?)?))
        }),
    }
}
