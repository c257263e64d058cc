//! `graph-strategy/bidirectional`: two trees that grow towards each other.
//!
//! The component of the start and those of the goals are two trees. They grow in turn: a node of the tree is
//! extended by a sample near it, with probability `greed` the node nearest to a random node of the other
//! tree, otherwise a random one. The new node is then tried with the nearest node of each tree that it does
//! not belong to, first inside GS_n, then by transfer and regrasps; a new node that no path in GS_n joins to
//! the tree it grew from may so enter the trees all the same. With probability `anywhere` a sample is drawn
//! anywhere instead: growing near old nodes alone would never leave a component of GS_n that the trees fill.
//!
//! It pays where the motion from start to goal is a narrow passage that samples anywhere miss; in an open
//! workspace its short extensions make more nodes than samples anywhere do.
//!
//! Source: J. Kuffner, S. LaValle, "RRT-Connect: an efficient approach to single-query path planning", ICRA
//! 2000; S. LaValle, "Planning Algorithms", 2006, section 5.5.3. Departures: trees grow in turn by the count
//! of samples, not the smaller one first, since a tree whose extensions fail to join it would stay the
//! smaller one for ever; a strategy sees distances between nodes only, so that the other tree's nodes take
//! the place of random configurations, and the manifold's samples near a node that of steps towards them.

use crate::nearest::{ends, nearest_in, nodes};
use regrasp_api::{
    Action, Build, CallError, ComponentId, Context, EdgeKind, Entry, GraphStrategy, GraphView, Link, NodeId,
    SearchPolicy, Settings, SettingsError, Slot, Vicinity, check_settings, inventory,
};
use serde::{Deserialize, Serialize};

/// Settings of [`Bidirectional`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BidirectionalSettings {
    /// Probability that the node nearest to the other tree's random node is extended, not a random one.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub greed: f64,
    /// Probability of a sample anywhere in place of one near a tree.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub anywhere: f64,
    /// How the planner carries out the strategy's actions.
    pub policy: SearchPolicy,
}

impl Default for BidirectionalSettings {
    /// Our choices.
    fn default() -> Self {
        Self { greed: 0.8, anywhere: 0.1, policy: SearchPolicy::default() }
    }
}

impl Settings for BidirectionalSettings {}

/// Grows a tree from the start and one from the goals.
#[derive(Clone, Copy, Debug)]
pub struct Bidirectional {
    settings: BidirectionalSettings,
}

impl Bidirectional {
    /// A strategy that grows as the settings say.
    pub fn new(settings: BidirectionalSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    /// The node to extend, of the tree whose turn it is.
    fn node_to_extend(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> NodeId {
        let (tree, other) = if graph.samples().0.is_multiple_of(2) {
            (Tree::Start, Tree::Goals)
        } else {
            (Tree::Goals, Tree::Start)
        };
        let (own, others) = (members(graph, tree), members(graph, other));
        let random = own[context.random.index(own.len())];
        if context.random.unit() >= self.settings.greed {
            return random;
        }
        let aim = others[context.random.index(others.len())];
        nearest_in(graph, aim, |component| tree.holds(graph, component)).unwrap_or(random)
    }
}

impl GraphStrategy for Bidirectional {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        if graph.joined() {
            return Ok(Action::Query);
        }
        if let Some(action) = join_trees(graph) {
            return Ok(action);
        }
        let (samples, most) = graph.samples();
        if samples >= most {
            return Ok(Action::Stop);
        }
        if graph.goals().is_empty() || context.random.unit() < self.settings.anywhere {
            return Ok(Action::Explore(Link::Components));
        }
        Ok(Action::Extend(self.node_to_extend(graph, context), Vicinity::default(), Link::Components))
    }

    fn policy(&self) -> SearchPolicy {
        self.settings.policy
    }
}

/// One of the two trees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tree {
    Start,
    Goals,
}

impl Tree {
    /// Whether the component belongs to the tree.
    fn holds(self, graph: &dyn GraphView, component: ComponentId) -> bool {
        match self {
            Self::Start => graph.component(graph.start()) == component,
            Self::Goals => graph.goals().iter().any(|&goal| graph.component(goal) == component),
        }
    }
}

fn members(graph: &dyn GraphView, tree: Tree) -> Vec<NodeId> {
    nodes(graph).filter(|&node| tree.holds(graph, graph.component(node))).collect()
}

/// An untried edge from the newest node, or an end, to the nearest node of a tree that it does not belong to.
fn join_trees(graph: &dyn GraphView) -> Option<Action> {
    let newest = nodes(graph).last();
    let tried_from = newest.into_iter().chain(ends(graph));
    tried_from.flat_map(|node| [(node, Tree::Start), (node, Tree::Goals)]).find_map(|(node, tree)| {
        let own = graph.component(node);
        if tree.holds(graph, own) {
            return None;
        }
        let near = nearest_in(graph, node, |component| tree.holds(graph, component))?;
        let kinds = [EdgeKind::Grasp, EdgeKind::TransferRegrasp];
        let untried = kinds.into_iter().find(|&kind| !graph.attempted(node, near, kind))?;
        Some(Action::Connect(node, near, untried))
    })
}

inventory::submit! {
    Entry {
        id: "graph-strategy/bidirectional",
        slots: &[Slot::GraphStrategy],
        summary: "grows a tree from the start and one from the goals, and tries to join them",
        references: &[
            "J. Kuffner, S. LaValle, RRT-Connect: an efficient approach to single-query path planning, \
             ICRA 2000",
            "S. LaValle, Planning Algorithms, Cambridge University Press 2006, section 5.5.3",
        ],
        schema: BidirectionalSettings::schema,
        check: check_settings::<BidirectionalSettings>,
        build: Build::GraphStrategy(|json, _| {
            Ok(Box::new(Bidirectional::new(BidirectionalSettings::from_json(json)?)?))
        }),
    }
}
