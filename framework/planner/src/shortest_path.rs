//! A shortest path through the manipulation graph by A*.

use crate::graph::Graph;
use regrasp_api::{EdgeId, NodeId, Total};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// One edge of a path, and whether it is walked from its `from` to its `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Step {
    pub edge: EdgeId,
    pub forward: bool,
}

/// The shortest path from `start` to the nearest of `goals` in the planner's metric, `None` if there is none.
///
/// P. Hart, N. Nilsson, B. Raphael, "A formal basis for the heuristic determination of minimum cost paths",
/// IEEE Trans. Systems Science and Cybernetics 1968; the heuristic is the metric itself, which never
/// overestimates. Ties are broken by node number, so that the path is unique.
pub(crate) fn shortest_path(graph: &Graph, start: NodeId, goals: &[NodeId]) -> Option<Vec<Step>> {
    let ahead = |node| goals.iter().map(|&goal| graph.distance(node, goal)).fold(f64::INFINITY, f64::min);
    let adjacent = adjacency(graph);
    let mut cost = vec![f64::INFINITY; graph.node_count()];
    let mut came_by: Vec<Option<(NodeId, Step)>> = vec![None; graph.node_count()];
    let mut open = BinaryHeap::from([Reverse((Total(ahead(start)), start))]);
    let mut closed = vec![false; graph.node_count()];
    cost[start.0 as usize] = 0.0;
    while let Some(Reverse((_, node))) = open.pop() {
        if goals.contains(&node) {
            return Some(trace(&came_by, node));
        }
        if std::mem::replace(&mut closed[node.0 as usize], true) {
            continue;
        }
        for &(next, step) in &adjacent[node.0 as usize] {
            let through = cost[node.0 as usize] + graph.distance(node, next);
            if through < cost[next.0 as usize] {
                cost[next.0 as usize] = through;
                came_by[next.0 as usize] = Some((node, step));
                open.push(Reverse((Total(through + ahead(next)), next)));
            }
        }
    }
    None
}

fn adjacency(graph: &Graph) -> Vec<Vec<(NodeId, Step)>> {
    let mut adjacent = vec![Vec::new(); graph.node_count()];
    for edge in graph.edges() {
        adjacent[edge.from.0 as usize].push((edge.to, Step { edge: edge.id, forward: true }));
        adjacent[edge.to.0 as usize].push((edge.from, Step { edge: edge.id, forward: false }));
    }
    adjacent
}

fn trace(came_by: &[Option<(NodeId, Step)>], goal: NodeId) -> Vec<Step> {
    let mut path = Vec::new();
    let mut node = goal;
    while let Some((before, step)) = came_by[node.0 as usize] {
        path.push(step);
        node = before;
    }
    path.reverse();
    path
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Configuration, EdgeKind, EdgeVerdict, Origin, PerFinger, Pose, Random};

    fn random_graph(random: &mut Random) -> Graph {
        let mut graph = Graph::new(0.03);
        let none = PerFinger::filled(1, None);
        for _ in 0..12 {
            let p = random.direction() * random.unit();
            let joints = PerFinger::filled(1, Default::default());
            let X_HO = Pose::translation(p.x, p.y, p.z);
            graph.add_node(Configuration { X_HO, joints, contacts: none }, Origin::Explored);
        }
        for _ in 0..16 {
            let (a, b) = (NodeId(random.index(12) as u32), NodeId(random.index(12) as u32));
            if a != b {
                graph.add_edge(a, b, EdgeKind::Grasp, EdgeVerdict::Valid);
            }
        }
        graph
    }

    /// Shortest distances from every node to `goal` by relaxing all edges until nothing changes.
    fn relaxed(graph: &Graph, goal: NodeId) -> Vec<f64> {
        let mut distance = vec![f64::INFINITY; graph.node_count()];
        distance[goal.0 as usize] = 0.0;
        for _ in 0..graph.node_count() {
            for edge in graph.edges() {
                let (a, b) = (edge.from.0 as usize, edge.to.0 as usize);
                let length = graph.distance(edge.from, edge.to);
                distance[a] = distance[a].min(distance[b] + length);
                distance[b] = distance[b].min(distance[a] + length);
            }
        }
        distance
    }

    #[test]
    fn paths_are_as_short_as_exhaustive_relaxation_finds() {
        let mut random = Random::from_key(3, 0, 0, 0);
        let mut found = 0;
        for _ in 0..200 {
            let graph = random_graph(&mut random);
            let (start, goals) = (NodeId(0), [NodeId(10), NodeId(11)]);
            let best = goals.map(|goal| relaxed(&graph, goal)[0]).into_iter().fold(f64::INFINITY, f64::min);
            let Some(path) = shortest_path(&graph, start, &goals) else {
                assert!(best.is_infinite());
                continue;
            };
            found += 1;
            let (mut at, mut length) = (start, 0.0);
            for step in path {
                let edge = graph.edge(step.edge).unwrap();
                let (from, to) = if step.forward { (edge.from, edge.to) } else { (edge.to, edge.from) };
                assert_eq!(from, at, "the path is connected");
                length += graph.distance(from, to);
                at = to;
            }
            assert!(goals.contains(&at) && (length - best).abs() < 1e-12);
        }
        assert!(found > 50, "{found} of 200 random graphs had a path");
    }
}
