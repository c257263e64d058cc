//! What several strategies ask of the graph: who is near, and which pairs were not tried yet.

use regrasp_api::{Action, ComponentId, Context, EdgeKind, GraphView, Link, NodeId};

/// Random nodes that are looked at for an untried pair before the search for one is given up.
const LOOKS: usize = 8;

/// Every node, in the order of creation.
pub(crate) fn nodes(graph: &dyn GraphView) -> impl Iterator<Item = NodeId> {
    (0..graph.node_count() as u32).map(NodeId)
}

/// The start, then the goals.
pub(crate) fn ends(graph: &dyn GraphView) -> impl Iterator<Item = NodeId> {
    std::iter::once(graph.start()).chain(graph.goals().iter().copied())
}

/// Asks for a path where the ends are joined, or joins an end; then connects a pair that is near, where it
/// may look at so many `neighbours`, or else explores.
pub(crate) fn connect_or_explore(
    graph: &dyn GraphView,
    neighbours: Option<usize>,
    context: &mut Context<'_>,
) -> Action {
    if graph.joined() {
        return Action::Query;
    }
    if let Some(action) = join_ends(graph) {
        return action;
    }
    if let Some((a, b)) = neighbours.and_then(|count| untried_pair(graph, count, context)) {
        return Action::Connect(a, b, EdgeKind::TransferRegrasp);
    }
    let (samples, most) = graph.samples();
    if samples < most { Action::Explore(Link::Components) } else { Action::Stop }
}

/// Start and goals enter the graph as new nodes do: by a path in GS_n to each component that has not been
/// tried yet.
pub(crate) fn join_ends(graph: &dyn GraphView) -> Option<Action> {
    let untried = |end: NodeId| {
        nearest_of_each_component(graph, end)
            .into_iter()
            .find(|&near| !graph.attempted(end, near, EdgeKind::Grasp))
    };
    ends(graph).find_map(|end| untried(end).map(|near| Action::Connect(end, near, EdgeKind::Grasp)))
}

/// The node nearest to `node` in each component but its own, components in ascending order.
pub(crate) fn nearest_of_each_component(graph: &dyn GraphView, node: NodeId) -> Vec<NodeId> {
    let own = graph.component(node);
    let mut best: Vec<Option<(f64, NodeId)>> = vec![None; graph.node_count()];
    for other in nodes(graph) {
        let component = graph.component(other);
        if component == own {
            continue;
        }
        let distance = graph.distance(node, other);
        let place = &mut best[component.0 as usize];
        if place.is_none_or(|(least, _)| distance < least) {
            *place = Some((distance, other));
        }
    }
    best.into_iter().flatten().map(|(_, nearest)| nearest).collect()
}

/// The node nearest to `node` among those whose component `is_wanted`; the older one of two equally near.
pub(crate) fn nearest_in(
    graph: &dyn GraphView,
    node: NodeId,
    is_wanted: impl Fn(ComponentId) -> bool,
) -> Option<NodeId> {
    let wanted = nodes(graph).filter(|&other| other != node && is_wanted(graph.component(other)));
    let measured = wanted.map(|other| (graph.distance(node, other), other));
    measured.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, nearest)| nearest)
}

/// Two nodes of different components, the second among the `neighbours` nearest of the first, that were not
/// tried to be joined by transfer and regrasps.
///
/// Looks at the newest node, the ends and a few random nodes: all pairs would cost the square of the graph's
/// size at each step.
pub(crate) fn untried_pair(
    graph: &dyn GraphView,
    neighbours: usize,
    context: &mut Context<'_>,
) -> Option<(NodeId, NodeId)> {
    let count = graph.node_count();
    let newest = count.checked_sub(1).map(|last| NodeId(last as u32));
    let random = (0..LOOKS.min(count)).map(|_| NodeId(context.random.index(count) as u32));
    let mut looked_at = newest.into_iter().chain(ends(graph)).chain(random);
    looked_at.find_map(|node| untried_neighbour(graph, node, neighbours).map(|other| (node, other)))
}

/// The nearest of the `neighbours` nodes of other components closest to `node` that was not tried with it.
fn untried_neighbour(graph: &dyn GraphView, node: NodeId, neighbours: usize) -> Option<NodeId> {
    let own = graph.component(node);
    let apart = nodes(graph).filter(|&other| graph.component(other) != own);
    let mut measured: Vec<(f64, NodeId)> = apart.map(|other| (graph.distance(node, other), other)).collect();
    let order = |a: &(f64, NodeId), b: &(f64, NodeId)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    if neighbours < measured.len() {
        measured.select_nth_unstable_by(neighbours, order);
        measured.truncate(neighbours);
    }
    measured.sort_unstable_by(order);
    let untried = |other: &NodeId| !graph.attempted(node, *other, EdgeKind::TransferRegrasp);
    measured.into_iter().map(|(_, other)| other).find(untried)
}
