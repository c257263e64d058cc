//! A roadmap made ready for queries: for each node the edges at it.

use super::map::Roadmap;

/// The turn (rad) that a regrasp is worth, as in a relay.
const TURN: f32 = 0.3;

/// A roadmap, or its first nodes, made ready for queries.
pub struct RoadmapGraph<'r> {
    pub(crate) roadmap: &'r Roadmap,
    nodes: usize,
    /// Where the edges at each node begin in `ends`, and one more.
    first: Vec<u32>,
    /// The other node of an edge, and the edge.
    ends: Vec<(u32, u32)>,
    /// What a turn by one radian counts (m): the object's radius.
    pub(crate) turn_length: f32,
    /// What a way through the graph costs for each metre, about.
    pub(crate) cost_of_length: f32,
}

impl<'r> RoadmapGraph<'r> {
    /// The first `nodes` of a roadmap with the edges between them; `turn_length` (m) is what a turn by one
    /// radian counts, the object's radius.
    pub fn new(roadmap: &'r Roadmap, nodes: usize, turn_length: f64) -> Self {
        let nodes = nodes.min(roadmap.node_count());
        let inside = || roadmap.links.iter().enumerate().filter(|(_, link)| (link.from as usize) < nodes);
        let mut first = vec![0; nodes + 1];
        for (_, link) in inside() {
            first[link.from as usize + 1] += 1;
            first[link.to as usize + 1] += 1;
        }
        (0..nodes).for_each(|node| first[node + 1] += first[node]);
        let mut next = first.clone();
        let mut ends = vec![(0, 0); first[nodes] as usize];
        for (number, link) in inside() {
            for (at, other) in [(link.from, link.to), (link.to, link.from)] {
                let place = &mut next[at as usize];
                ends[*place as usize] = (other, number as u32);
                *place += 1;
            }
        }
        let turn_length = turn_length as f32;
        let mut graph = Self { roadmap, nodes, first, ends, turn_length, cost_of_length: 0.0 };
        let (cost, length) = inside().fold((0.0, 0.0), |(cost, length), (number, link)| {
            (cost + f64::from(graph.cost(number as u32)), length + f64::from(link.length))
        });
        graph.cost_of_length = if length > 0.0 { (cost / length) as f32 } else { 0.0 };
        graph
    }

    /// How many nodes.
    pub fn node_count(&self) -> usize {
        self.nodes
    }

    /// How many edges.
    pub fn edge_count(&self) -> usize {
        self.ends.len() / 2
    }

    /// The edges at a node: the other node, and the edge.
    pub(crate) fn at(&self, node: u32) -> &[(u32, u32)] {
        let [begin, end] = [0, 1].map(|i| self.first[node as usize + i] as usize);
        &self.ends[begin..end]
    }

    /// What an edge costs in a way: its regrasps, and its length in turns that are worth one.
    pub(crate) fn cost(&self, edge: u32) -> f32 {
        let link = &self.roadmap.links[edge as usize];
        f32::from(link.regrasps) + self.cost_of(link.length)
    }

    /// What a length (m) without regrasps costs.
    pub(crate) fn cost_of(&self, length: f32) -> f32 {
        length / (TURN * self.turn_length)
    }

    /// How many nodes each component has, the largest first.
    pub fn components(&self) -> Vec<usize> {
        let mut seen = vec![false; self.nodes];
        let mut sizes = Vec::new();
        for node in 0..self.nodes as u32 {
            let (mut open, mut size) = (vec![node], 0);
            while let Some(at) = open.pop() {
                if !std::mem::replace(&mut seen[at as usize], true) {
                    size += 1;
                    open.extend(self.at(at).iter().map(|&(other, _)| other));
                }
            }
            sizes.extend((size > 0).then_some(size));
        }
        sizes.sort_unstable_by(|a, b| b.cmp(a));
        sizes
    }
}
