//! The graph of Steiner points, and shortest paths in it.

use crate::polyhedron::{Polyhedron, next, previous};
use crate::rolling::Spot;
use regrasp_api::{CallError, Context, Total, Vec3};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Points between two questions whether to stop.
const STRIDE: usize = 1024;
/// Stands for the start in the place of a point's number.
pub(super) const START: u32 = u32::MAX;

/// Points on the edges of a polyhedron; two are neighbours if they lie on different edges of one facet.
#[derive(Clone, Debug)]
pub(super) struct Graph {
    points: Vec<Vec3>,
    /// A half-edge that holds each point.
    pub edges: Vec<u32>,
    /// The number of the first point of each half-edge's edge, and how many there are.
    ranges: Vec<(u32, u32)>,
}

impl Graph {
    /// Puts max(`fewest`, length / `spacing` (m), rounded up) points on every edge, each in the middle of an
    /// equal part.
    pub fn new(polyhedron: &Polyhedron, fewest: u32, spacing: f64) -> Self {
        let mut graph =
            Self { points: Vec::new(), edges: Vec::new(), ranges: vec![(0, 0); polyhedron.half_edges.len()] };
        for (index, edge) in polyhedron.half_edges.iter().enumerate() {
            if index as u32 > edge.twin {
                continue;
            }
            let count = ((edge.length / spacing).ceil() as u32).max(fewest);
            let range = (graph.points.len() as u32, count);
            graph.ranges[index] = range;
            graph.ranges[edge.twin as usize] = range;
            for k in 0..count {
                graph.points.push(edge.at(edge.length * (f64::from(k) + 0.5) / f64::from(count)));
                graph.edges.push(index as u32);
            }
        }
        graph
    }

    /// Where a point lies (m, in O).
    pub fn at(&self, point: u32) -> Vec3 {
        self.points[point as usize]
    }

    /// The number of points.
    pub fn size(&self) -> usize {
        self.points.len()
    }

    /// The parts (m) into which an edge is cut: what crossing it may cost.
    pub fn part(&self, polyhedron: &Polyhedron, half_edge: u32) -> f64 {
        polyhedron.half_edges[half_edge as usize].length / f64::from(self.ranges[half_edge as usize].1)
    }

    fn of_edge(&self, half_edge: u32) -> std::ops::Range<u32> {
        let (first, count) = self.ranges[half_edge as usize];
        first..first + count
    }
}

/// The best known way to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Label {
    /// The search that wrote it.
    epoch: u64,
    length: f64,
    /// The point before, and the facet in between.
    pub before: u32,
    pub facet: u32,
}
const UNKNOWN: Label = Label { epoch: 0, length: f64::INFINITY, before: START, facet: 0 };

/// A point that waits, by the least length (m) of a path through it; ties by number, so that the order is
/// certain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Waiting {
    least: Total,
    point: u32,
    so_far: Total,
}

/// Memory of a search, kept between calls; nothing of one call shows in the next.
#[derive(Default)]
pub(super) struct Scratch {
    pub labels: Vec<Label>,
    epoch: u64,
    waiting: BinaryHeap<Reverse<Waiting>>,
    target_facets: Vec<u32>,
}

/// The last point of the best path, and the facet in which it goes on to the target.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub last: u32,
    pub facet: u32,
    length: f64,
}

/// A* over the points from one place to another: the rest of a path is at least the straight distance.
pub(super) struct Search<'a> {
    pub polyhedron: &'a Polyhedron,
    pub graph: &'a Graph,
    pub scratch: &'a mut Scratch,
    pub p_OT: Vec3,
}

impl Search<'_> {
    /// The shortest path over the points; `None` where the mesh's parts are not connected.
    pub fn run(
        mut self,
        (start, end): (&Spot, &Spot),
        context: &Context<'_>,
    ) -> Result<Option<Found>, CallError> {
        self.prepare(end);
        let mut best: Option<Found> = None;
        let p_OS = start.contact.p_OC;
        let polyhedron = self.polyhedron;
        polyhedron.facets_at(start.place, |facet| {
            self.arrive(&mut best, START, facet, &p_OS, 0.0);
            for edge in 3 * facet..3 * facet + 3 {
                self.reach(edge, START, facet, &p_OS, 0.0);
            }
        });
        let mut taken = 0;
        while let Some(Reverse(waiting)) = self.scratch.waiting.pop() {
            if best.is_some_and(|found| found.length <= waiting.least.0) {
                break;
            }
            if waiting.so_far.0 > self.scratch.labels[waiting.point as usize].length {
                continue;
            }
            taken += 1;
            if taken % STRIDE == 0 {
                context.proceed()?;
            }
            self.expand(&mut best, &waiting);
        }
        Ok(best)
    }

    fn prepare(&mut self, end: &Spot) {
        let scratch = &mut *self.scratch;
        scratch.epoch += 1;
        scratch.waiting.clear();
        scratch.target_facets.clear();
        if scratch.labels.len() < self.graph.size() {
            scratch.labels.resize(self.graph.size(), UNKNOWN);
        }
        self.polyhedron.facets_at(end.place, |facet| scratch.target_facets.push(facet));
    }

    /// Goes on from a point to its neighbours in both of its facets.
    fn expand(&mut self, best: &mut Option<Found>, waiting: &Waiting) {
        let edge = self.graph.edges[waiting.point as usize];
        let p_OP = self.graph.at(waiting.point);
        for side in [edge, self.polyhedron.half_edges[edge as usize].twin] {
            let facet = side / 3;
            self.arrive(best, waiting.point, facet, &p_OP, waiting.so_far.0);
            for other in [next(side), previous(side)] {
                self.reach(other, waiting.point, facet, &p_OP, waiting.so_far.0);
            }
        }
    }

    /// Ends a path in a facet that holds the target.
    fn arrive(&self, best: &mut Option<Found>, last: u32, facet: u32, p_OP: &Vec3, so_far: f64) {
        if self.scratch.target_facets.contains(&facet) {
            let length = so_far + (self.p_OT - p_OP).norm();
            if best.is_none_or(|found| length < found.length) {
                *best = Some(Found { last, facet, length });
            }
        }
    }

    /// Offers all points of an edge a way from a point of the same facet.
    fn reach(&mut self, edge: u32, before: u32, facet: u32, p_OP: &Vec3, so_far: f64) {
        for point in self.graph.of_edge(edge) {
            let p = self.graph.at(point);
            let length = so_far + (p - p_OP).norm();
            let label = &mut self.scratch.labels[point as usize];
            if label.epoch == self.scratch.epoch && label.length <= length {
                continue;
            }
            *label = Label { epoch: self.scratch.epoch, length, before, facet };
            let least = length + (self.p_OT - p).norm();
            self.scratch.waiting.push(Reverse(Waiting { least: Total(least), point, so_far: Total(length) }));
        }
    }
}
