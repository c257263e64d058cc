//! A best-first search over SE(3): goes on from the node whose pose lies nearest to a goal's, and widens
//! where nothing comes of it.

use regrasp_api::{
    Action, Build, CallError, Context, EdgeKind, Effect, Entry, GraphStrategy, GraphView, Link, NoSettings,
    NodeId, Settings, Slot, Vicinity, angle_between, check_settings, inventory,
};

/// What a turn by one radian counts (m).
const TURN: f64 = 0.03;

/// Extends the most promising node.
struct BestFirst;

/// How far the object's pose in `node` is from that of the nearest goal (m).
fn to_go(graph: &dyn GraphView, node: NodeId) -> f64 {
    let X = graph.configuration(node).X_HO;
    let from = |goal: &NodeId| {
        let Y = graph.configuration(*goal).X_HO;
        let shift = (X.translation.vector - Y.translation.vector).norm();
        shift + TURN * angle_between(&X.rotation, &Y.rotation)
    };
    graph.goals().iter().map(from).fold(f64::INFINITY, f64::min)
}

/// How often `node` was extended, and how often of those without a new node.
fn tries(graph: &dyn GraphView, node: NodeId) -> (usize, usize) {
    let of_node =
        graph.history().iter().filter(|past| matches!(past.action, Action::Extend(n, ..) if n == node));
    of_node.fold((0, 0), |(all, bad), past| (all + 1, bad + usize::from(past.effect == Effect::Failed)))
}

/// The node of the start's component with the least way to go; each try makes it look farther away.
fn best(graph: &dyn GraphView) -> Option<NodeId> {
    let start = graph.component(graph.start());
    let ours = (0..graph.node_count() as u32).map(NodeId).filter(|&node| graph.component(node) == start);
    let cost = |node: NodeId| to_go(graph, node) * (1.0 + 0.5 * tries(graph, node).0 as f64);
    let costs = ours.map(|node| (node, cost(node)));
    costs.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(node, _)| node)
}

/// The untried pair of a node of ours and a goal, the nearest first.
fn bridge(graph: &dyn GraphView, node: NodeId) -> Option<Action> {
    let open = |goal: &&NodeId| {
        graph.component(**goal) != graph.component(node)
            && !graph.attempted(node, **goal, EdgeKind::TransferRegrasp)
    };
    let nearest = |a: &&NodeId, b: &&NodeId| graph.distance(node, **a).total_cmp(&graph.distance(node, **b));
    let goal = graph.goals().iter().filter(open).min_by(nearest)?;
    Some(Action::Connect(node, *goal, EdgeKind::TransferRegrasp))
}

impl GraphStrategy for BestFirst {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        if graph.joined() {
            return Ok(Action::Query);
        }
        let (samples, most) = graph.samples();
        let Some(node) = best(graph).filter(|_| samples < most) else { return Ok(Action::Stop) };
        if let Some(bridge) = bridge(graph, node) {
            return Ok(bridge);
        }
        // Every fourth step goes anywhere, so that a dead end is left.
        if context.random.unit() < 0.25 {
            return Ok(Action::Explore(Link::Components));
        }
        let wider = 1.0 + tries(graph, node).1 as f64;
        let Vicinity { radius, angle } = Vicinity::default();
        let within = Vicinity { radius: radius * wider.min(4.0), angle: (angle * wider).min(3.0) };
        Ok(Action::Extend(node, within, Link::Components))
    }
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "graph-strategy/best-first",
    slots: &[Slot::GraphStrategy],
    summary: "goes on from the node whose pose lies nearest to the goal's",
    references: &[
        "Hart, Nilsson, Raphael, A formal basis for the heuristic determination of minimum cost paths, IEEE \
         SSC 1968",
    ],
    schema: NoSettings::schema,
    check: check_settings::<NoSettings>,
    build: Build::GraphStrategy(|json, _parts| {
        NoSettings::from_json(json)?;
        Ok(Box::new(BestFirst))
    }),
};
inventory::submit! { ENTRY }
