//! Distance to the nearest sharp edge.

use crate::bvh::{Hierarchy, Thing};
use crate::polyhedron::Polyhedron;
use regrasp_api::Vec3;

/// The edges whose facets meet at more than an angle.
#[derive(Clone, Debug)]
pub(crate) struct SharpEdges {
    ends: Vec<(Vec3, Vec3)>,
    hierarchy: Hierarchy,
    /// For each facet the edge nearest to its middle: the first bound of a search.
    nearest: Vec<u32>,
}

impl SharpEdges {
    /// Collects the edges that bend by more than `angle` (rad).
    pub fn new(polyhedron: &Polyhedron, angle: f64) -> Self {
        let mesh = &polyhedron.mesh;
        let is_sharp = |index: usize| {
            let neighbor = &mesh.neighbors(index as u32 / 3)[index % 3];
            neighbor.bend.abs() > angle && index < polyhedron.half_edges[index].twin as usize
        };
        let ends: Vec<_> = (0..polyhedron.half_edges.len())
            .filter(|&index| is_sharp(index))
            .map(|index| {
                let edge = &polyhedron.half_edges[index];
                (edge.p_OE, edge.at(edge.length))
            })
            .collect();
        let things: Vec<_> =
            ends.iter().map(|&(a, b)| Thing { corners: [a, b, b], thin: Vec3::zeros() }).collect();
        let mut edges = Self { ends, hierarchy: Hierarchy::new(&things), nearest: Vec::new() };
        if !edges.ends.is_empty() {
            let middle = |facet| mesh.corners(facet).iter().sum::<Vec3>() / 3.0;
            edges.nearest =
                (0..mesh.facets().len() as u32).map(|facet| edges.search(&middle(facet), 0).1).collect();
        }
        edges
    }

    /// The straight distance (m) to the nearest sharp edge, infinite if there is none.
    pub fn distance(&self, facet: u32, p_OC: &Vec3) -> f64 {
        if self.ends.is_empty() {
            return f64::INFINITY;
        }
        let first = self.nearest.get(facet as usize).copied().unwrap_or(0);
        self.search(p_OC, first).0.sqrt()
    }

    /// Squared distance and number of the nearest edge.
    fn search(&self, p_OC: &Vec3, first: u32) -> (f64, u32) {
        let mut best = (self.squared_distance(first, p_OC), first);
        let mut bound = best.0;
        self.hierarchy.closest(p_OC, &mut bound, |edge, bound| {
            let squared = self.squared_distance(edge, p_OC);
            if squared < best.0 {
                best = (squared, edge);
                *bound = squared;
            }
        });
        best
    }

    fn squared_distance(&self, edge: u32, p: &Vec3) -> f64 {
        let (a, b) = &self.ends[edge as usize];
        let ab = b - a;
        let t = ((p - a).dot(&ab) / ab.norm_squared()).clamp(0.0, 1.0);
        (a + ab * t - p).norm_squared()
    }
}
