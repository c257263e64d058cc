//! The cheapest way through a roadmap from one end to the other, both of them joined to some nodes.

use super::graph::RoadmapGraph;
use super::near::apart;
use super::nodes::ScanPose;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// How many times the usual cost per metre the heuristic takes for certain. More finds ways sooner that cost
/// more; on the paper's cube this is a fifth quicker than 0.8, at the same regrasps.
const GREED: f32 = 1.3;
/// No node before, and no edge.
const NONE: u32 = u32::MAX;

/// A node that an end may be joined to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Access {
    pub node: u32,
    /// What it costs to get there.
    pub cost: f32,
}

/// A way: the node that the start is joined to, edges in turn with the node in which each ends, and so the
/// node that is joined to the goal.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Way {
    pub first: u32,
    pub edges: Vec<(u32, u32)>,
}

impl Way {
    /// The node that the goal is joined to.
    pub fn last(&self) -> u32 {
        self.edges.last().map_or(self.first, |&(_, node)| node)
    }
}

/// The cheapest way, or nearly so, without the edges that are `dead`; `None` if there is none.
///
/// A* (P. Hart, N. Nilsson, B. Raphael, IEEE Trans. Systems Science and Cybernetics 1968) with a heuristic
/// that may overestimate: what a way of that length usually costs. Ties are broken by the node's number.
pub(crate) fn cheapest(
    graph: &RoadmapGraph<'_>,
    (starts, goals): (&[Access], &[Access]),
    goal: &ScanPose,
    dead: &BTreeSet<u32>,
) -> Option<Way> {
    let poses = graph.roadmap.nodes.poses();
    let (end, scale) = (graph.node_count(), GREED * graph.cost_of_length);
    let ahead = |node: u32| match node as usize {
        node if node == end => 0.0,
        node => scale * apart(&poses[node], goal, graph.turn_length),
    };
    let mut cost = vec![f32::INFINITY; end + 1];
    let mut came_by = vec![(NONE, NONE); end + 1];
    let mut closed = vec![false; end + 1];
    let mut open = BinaryHeap::new();
    for start in starts.iter().filter(|start| (start.node as usize) < end) {
        if start.cost < cost[start.node as usize] {
            cost[start.node as usize] = start.cost;
            open.push(Reverse(((start.cost + ahead(start.node)).to_bits(), start.node)));
        }
    }
    while let Some(Reverse((_, node))) = open.pop() {
        if node as usize == end {
            return Some(trace(&came_by, end));
        }
        if std::mem::replace(&mut closed[node as usize], true) {
            continue;
        }
        let inside = graph.at(node).iter().filter(|(_, edge)| !dead.contains(edge));
        let inside = inside.map(|&(other, edge)| (other, edge, graph.cost(edge)));
        let out = goals.iter().filter(|goal| goal.node == node).map(|goal| (end as u32, NONE, goal.cost));
        for (next, edge, step) in inside.chain(out) {
            let through = cost[node as usize] + step;
            if through < cost[next as usize] {
                cost[next as usize] = through;
                came_by[next as usize] = (node, edge);
                // Costs are not negative: their bits are ordered as they are.
                open.push(Reverse(((through + ahead(next)).to_bits(), next)));
            }
        }
    }
    None
}

fn trace(came_by: &[(u32, u32)], end: usize) -> Way {
    let (mut node, _) = came_by[end];
    let mut edges = Vec::new();
    while let (before, edge) = came_by[node as usize]
        && before != NONE
    {
        edges.push((edge, node));
        node = before;
    }
    edges.reverse();
    Way { first: node, edges }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roadmap::map::{Link, Roadmap, RoadmapParts};
    use regrasp_api::EdgeKind;

    /// Nodes along a line, the joints of one finger left out of the account.
    fn line(links: &[(u32, u32, u8)]) -> Roadmap {
        let row = |x: f32| [0.0, 1.0, 0.0, 0.0, 0.0, x, 0.0, 0.0, 0.0, 0.0, 0.0].map(f32::to_bits);
        let rows = (0..5).flat_map(|node| row(node as f32 * 0.01)).collect();
        let mut roadmap =
            Roadmap::from_parts(RoadmapParts { joints: vec![0], rows, ..Default::default() }).unwrap();
        let link = |&(from, to, regrasps): &(u32, u32, u8)| {
            let length = 0.01 * (from - to) as f32;
            Link { from, to, kind: EdgeKind::TransferRegrasp, regrasps, length }
        };
        roadmap.links = links.iter().map(link).collect();
        roadmap
    }

    #[test]
    fn ways_save_regrasps_and_go_round_dead_edges() {
        let roadmap = line(&[(1, 0, 4), (2, 1, 4), (3, 2, 4), (4, 3, 4), (3, 0, 4)]);
        let graph = RoadmapGraph::new(&roadmap, 5, 0.03);
        let ends = [Access { node: 0, cost: 0.0 }, Access { node: 4, cost: 0.0 }];
        let goal = roadmap.nodes.poses()[4];
        let way =
            |dead: &[u32]| cheapest(&graph, (&ends[..1], &ends[1..]), &goal, &dead.iter().copied().collect());
        assert_eq!(way(&[]), Some(Way { first: 0, edges: vec![(4, 3), (3, 4)] }));
        let longer = way(&[4]).unwrap();
        assert_eq!((longer.edges.len(), longer.last()), (4, 4));
        assert_eq!(way(&[3]), None);
        assert_eq!(graph.components(), [5]);
        let fewer = RoadmapGraph::new(&roadmap, 2, 0.03);
        assert_eq!((fewer.node_count(), fewer.edge_count()), (2, 1));
    }
}
