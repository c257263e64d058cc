//! Downhill on the field of distances: which facets the path crosses.

use super::field::gradient;
use super::fine::{Fine, FinePoint};
use crate::polyhedron::{Polyhedron, next, previous};
use crate::strip::Strip;
use regrasp_api::Vec3;
use std::collections::VecDeque;

/// Where a descent stands: in a facet, at one of its vertices if it slid there.
#[derive(Clone, Copy, Debug)]
struct Stand {
    facet: u32,
    p_OP: Vec3,
    vertex: Option<u32>,
}

/// Follows the gradient of distances on the fine mesh, and notes the edges of the coarse mesh that it
/// crosses.
pub(super) struct Descent<'a> {
    pub coarse: &'a Polyhedron,
    pub fine: &'a Fine,
    pub phi: &'a [f64],
    pub strip: &'a mut Strip,
    pub target: FinePoint,
}

impl Descent<'_> {
    /// Goes from a point to the target.
    ///
    /// Next to the target, where the field is not exact, and where the field has a false minimum, the rest of
    /// the way crosses as few facets as possible.
    pub fn run(&mut self, start: &FinePoint) {
        self.strip.crossings.clear();
        let corners = self.fine.polyhedron.mesh.corners(start.facet);
        let p_OP = corners.iter().zip(start.weights).map(|(corner, weight)| corner * weight).sum();
        let mut at = Stand { facet: start.facet, p_OP, vertex: None };
        let most = 4 * self.fine.polyhedron.mesh.facets().len();
        for _ in 0..most {
            if self.is_near(at.facet) {
                break;
            }
            let after = match at.vertex {
                None => Some(self.down(&at)),
                Some(vertex) => self.down_from_vertex(&at, vertex),
            };
            match after {
                Some(after) => at = after,
                None => break,
            }
        }
        self.hop(at.facet);
    }

    /// Whether a fine facet shares a vertex with the target's.
    fn is_near(&self, facet: u32) -> bool {
        let facets = self.fine.polyhedron.mesh.facets();
        let target = &facets[self.target.facet as usize];
        facets[facet as usize].iter().any(|vertex| target.contains(vertex))
    }

    /// Down the gradient through a facet, and over the edge that is met or along it.
    fn down(&mut self, at: &Stand) -> Stand {
        let polyhedron = &self.fine.polyhedron;
        let n = polyhedron.mesh.normal(at.facet);
        let along = -gradient(self.fine, at.facet, self.phi);
        let mut exit = (f64::INFINITY, 3 * at.facet);
        for index in 3 * at.facet..3 * at.facet + 3 {
            let edge = &polyhedron.half_edges[index as usize];
            let outward = edge.along_O.cross(&n);
            let speed = outward.dot(&along);
            if speed > 0.0 {
                let run = (outward.dot(&(edge.p_OE - at.p_OP)) / speed).max(0.0);
                if run < exit.0 {
                    exit = (run, index);
                }
            }
        }
        let twin = polyhedron.half_edges[exit.1 as usize].twin;
        let frame = &polyhedron.half_edges[twin as usize];
        let p_OP = if exit.0.is_finite() { at.p_OP + along * exit.0 } else { at.p_OP };
        let x = (p_OP - frame.p_OE).dot(&frame.along_O).clamp(0.0, frame.length);
        let beyond = twin / 3;
        let up = polyhedron.mesh.normal(beyond).cross(&frame.along_O);
        if up.dot(&gradient(self.fine, beyond, self.phi)) < 0.0 {
            self.cross(twin);
            return Stand { facet: beyond, p_OP: frame.at(x), vertex: None };
        }
        // Both sides lead to the edge: along it to its lower end.
        let ends = [frame.vertex, polyhedron.half_edges[next(twin) as usize].vertex];
        let lower = if self.phi[ends[0] as usize] <= self.phi[ends[1] as usize] { ends[0] } else { ends[1] };
        self.at_vertex(at.facet, lower)
    }

    fn at_vertex(&self, facet: u32, vertex: u32) -> Stand {
        Stand { facet, p_OP: self.fine.polyhedron.mesh.vertices()[vertex as usize], vertex: Some(vertex) }
    }

    /// The steepest way down from a vertex: into a facet or along an edge; `None` at a minimum.
    fn down_from_vertex(&mut self, at: &Stand, vertex: u32) -> Option<Stand> {
        let polyhedron = &self.fine.polyhedron;
        let mut best = (0.0, None);
        for edge in polyhedron.star(vertex) {
            let frame = &polyhedron.half_edges[edge as usize];
            let end = polyhedron.half_edges[next(edge) as usize].vertex;
            let slope = (self.phi[vertex as usize] - self.phi[end as usize]) / frame.length;
            if slope > best.0 {
                best = (slope, Some((edge, Some(end))));
            }
            let along = -gradient(self.fine, edge / 3, self.phi);
            let n = polyhedron.mesh.normal(edge / 3);
            let last = &polyhedron.half_edges[previous(edge) as usize];
            let is_inside =
                n.cross(&frame.along_O).dot(&along) > 0.0 && n.cross(&last.along_O).dot(&along) > 0.0;
            if is_inside && along.norm() > best.0 {
                best = (along.norm(), Some((edge, None)));
            }
        }
        let (edge, end) = best.1?;
        self.turn(vertex, at.facet, edge / 3);
        Some(match end {
            Some(end) => self.at_vertex(edge / 3, end),
            None => Stand { facet: edge / 3, vertex: None, ..*at },
        })
    }

    /// Goes around a vertex, counter-clockwise, from one of its facets to another.
    fn turn(&mut self, vertex: u32, from: u32, to: u32) {
        let Some(mut at) = self.fine.polyhedron.star(vertex).find(|edge| edge / 3 == from) else { return };
        while at / 3 != to {
            at = self.fine.polyhedron.counter_clockwise(at);
            self.cross(at);
        }
    }

    /// Notes that a fine edge is crossed, given by the half-edge of the facet that is entered.
    fn cross(&mut self, half_edge: u32) {
        let edge = &self.fine.polyhedron.half_edges[half_edge as usize];
        let (from, to) = (self.fine.parent(edge.twin / 3), self.fine.parent(half_edge / 3));
        if from == to {
            return;
        }
        let middle = edge.at(edge.length / 2.0);
        let off = |index: &u32| {
            let coarse = &self.coarse.half_edges[*index as usize];
            let leads_back = coarse.twin / 3 == from;
            if leads_back { coarse.unfold(&middle)[1] } else { f64::INFINITY }
        };
        let crossed = (3 * to..3 * to + 3).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(3 * to);
        self.strip.cross(self.coarse, crossed);
    }

    /// Goes to the target's facet over as few facets as possible.
    fn hop(&mut self, from: u32) {
        let edges = &self.fine.polyhedron.half_edges;
        let target = self.target.facet;
        // The search runs backwards, so that its steps are read off forwards.
        let mut steps = std::collections::BTreeMap::from([(target, u32::MAX)]);
        let mut waiting = VecDeque::from([target]);
        while let Some(facet) = waiting.pop_front().filter(|&facet| facet != from) {
            for index in 3 * facet..3 * facet + 3 {
                let before = edges[index as usize].twin / 3;
                steps.entry(before).or_insert_with(|| {
                    waiting.push_back(before);
                    index
                });
            }
        }
        let mut at = from;
        while at != target {
            let entered = steps[&at];
            self.cross(entered);
            at = entered / 3;
        }
    }
}
