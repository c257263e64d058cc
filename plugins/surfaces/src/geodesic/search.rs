//! Exact shortest paths: windows of straight rays, unfolded facet by facet and led towards the target.
//!
//! A window is the part of an edge that straight lines from one source reach through one strip of unfolded
//! facets (Mitchell, Mount & Papadimitriou, "The discrete geodesic problem", SIAM J. Comput. 1987; Chen &
//! Han, "Shortest paths on a polyhedron", SoCG 1990). Windows leave a queue as in Xin & Wang, "Improving Chen
//! and Han's algorithm on the discrete geodesic problem", ACM TOG 2009, with two departures for paths between
//! two points: the key is the length so far plus a lower bound of the rest (A*), and a window that cannot
//! shorten the best path by more than the relative tolerance is dropped. Shortest paths bend at saddle
//! vertices only; those become sources of the region behind them.

use super::bound::LowerBound;
use super::plane::{cross, exit, part_of_opposite, rotate};
use super::windows::{Arrival, FLAG, Label, Scratch, Source, UNKNOWN, Window};
use crate::polyhedron::{HalfEdge, Planar, Polyhedron, next, planar_norm, previous};
use crate::rolling::Spot;
use regrasp_api::{CallError, Context, Vec3};
use std::f64::consts::{PI, TAU};

/// Windows between two questions whether to stop.
const STRIDE: usize = 1024;
/// Slack in lengths (m) against rounding.
const ROUNDING: f64 = 1e-13;
/// Lengths below this fraction of the object's size need no order.
const FINEST: f64 = 1e-3;

/// One search from a start to a target.
pub(super) struct Search<'a> {
    polyhedron: &'a Polyhedron,
    scratch: &'a mut Scratch,
    bound: LowerBound,
    p_OT: Vec3,
    tolerance: f64,
    /// Windows at or above this length (m) are dropped.
    limit: f64,
    /// The last piece of the best path found.
    best: Option<Arrival>,
}

impl<'a> Search<'a> {
    /// Prepares a search; `known` is the length (m) of some path, infinite if none is known.
    pub fn new(
        polyhedron: &'a Polyhedron,
        scratch: &'a mut Scratch,
        bound: LowerBound,
        target: &Spot,
        tolerance: f64,
        known: f64,
    ) -> Self {
        scratch.windows.clear();
        scratch.sources.clear();
        scratch.epoch += 1;
        if scratch.labels.len() < polyhedron.outgoing.len() {
            scratch.labels.resize(polyhedron.outgoing.len(), UNKNOWN);
        }
        scratch.start_facets.clear();
        scratch.target_facets.clear();
        polyhedron.facets_at(target.place, |facet| scratch.target_facets.push(facet));
        let limit = known * (1.0 - tolerance);
        Self { polyhedron, scratch, bound, p_OT: target.contact.p_OC, tolerance, limit, best: None }
    }

    /// The last piece of the shortest path from `start` if it is shorter than the known one by more than the
    /// tolerance.
    pub fn run(mut self, start: &Spot, context: &Context<'_>) -> Result<Option<Arrival>, CallError> {
        let least = self.bound.of_point(&start.contact.p_OC).max(FINEST * self.polyhedron.radius);
        self.scratch.queue.restart(least);
        self.spread_start(start);
        let mut count = 0;
        while let Some((key, index)) = self.scratch.queue.pop() {
            if key >= self.limit {
                continue;
            }
            count += 1;
            if count % STRIDE == 0 {
                context.proceed()?;
            }
            if index & FLAG == 0 {
                self.spread_window(index);
            } else {
                self.spread_vertex(index & !FLAG, key);
            }
        }
        Ok(self.best)
    }

    fn offer(&mut self, length: f64, last: Arrival) {
        if length < self.limit {
            self.best = Some(last);
            self.limit = length * (1.0 - self.tolerance);
            self.scratch.queue.cut(self.limit);
        }
    }

    fn spread_start(&mut self, start: &Spot) {
        let polyhedron = self.polyhedron;
        polyhedron.facets_at(start.place, |facet| self.scratch.start_facets.push(facet));
        let source = self.add_source(Source { p_OS: start.contact.p_OC, length: 0.0, before: None });
        for index in 0..self.scratch.start_facets.len() {
            let facet = self.scratch.start_facets[index];
            if self.scratch.target_facets.contains(&facet) {
                self.offer((start.contact.p_OC - self.p_OT).norm(), Arrival::Source(source, facet));
            }
            for edge in 3 * facet..3 * facet + 3 {
                let vertex = polyhedron.half_edges[edge as usize].vertex;
                self.label(vertex, &start.contact.p_OC, 0.0, Arrival::Source(source, facet));
                self.open(edge, source, 0.0..=f64::INFINITY);
            }
        }
    }

    /// Opens the window of a source through an edge of a facet that holds the source; `part` limits it, from
    /// the edge's first vertex (m).
    fn open(&mut self, edge: u32, source: u32, part: std::ops::RangeInclusive<f64>) {
        let Source { p_OS, length, .. } = self.scratch.sources[source as usize];
        let twin = self.polyhedron.half_edges[edge as usize].twin;
        let frame = &self.polyhedron.half_edges[twin as usize];
        let [x, y] = frame.unfold(&p_OS);
        if y < self.polyhedron.snap {
            return; // the source lies on this edge: its other facet is in the star too
        }
        let ends = [(frame.length - part.end()).max(0.0), (frame.length - part.start().max(0.0)).max(0.0)];
        self.push(Window { half_edge: twin, parent: source | FLAG, ends, source: [x, -y], so_far: length });
    }

    fn add_source(&mut self, source: Source) -> u32 {
        self.scratch.sources.push(source);
        (self.scratch.sources.len() - 1) as u32
    }

    /// Queues a window unless it is useless; one that enters the target's facet ends there.
    fn push(&mut self, window: Window) {
        let frame = &self.polyhedron.half_edges[window.half_edge as usize];
        let facet = window.half_edge / 3;
        let target = frame.unfold(&self.p_OT);
        let crossing = cross(&window.source, &target);
        // A window round a single ray past a saddle may have its ends swapped by rounding, which `clamp`
        // would refuse.
        let clamped = crossing.max(window.ends[0]).min(window.ends[1]);
        let straight = window.so_far
            + planar_norm(clamped - window.source[0], window.source[1])
            + planar_norm(clamped - target[0], target[1]);
        if straight >= self.limit {
            return;
        }
        if self.scratch.target_facets.contains(&facet) {
            if (crossing - clamped).abs() <= 10.0 * self.polyhedron.snap {
                let last = Arrival::Window(self.add(window));
                self.offer(straight, last);
            }
            return;
        }
        if self.is_dominated(frame, &window) || self.scratch.start_facets.contains(&facet) {
            return;
        }
        let key =
            straight.max(self.bound.through(frame, &window.source, window.ends, window.so_far, clamped));
        if key < self.limit {
            let index = self.add(window);
            self.scratch.queue.push(key, index);
        }
    }

    fn add(&mut self, window: Window) -> u32 {
        self.scratch.windows.push(window);
        (self.scratch.windows.len() - 1) as u32
    }

    /// Whether a known path to an end of the edge, continued along the edge, beats the window everywhere (Xin
    /// & Wang 2009, section 3.2).
    fn is_dominated(&self, frame: &HalfEdge, window: &Window) -> bool {
        let [b0, b1] = window.ends;
        let [x, y] = window.source;
        let head = self.polyhedron.half_edges[next(window.half_edge) as usize].vertex;
        let by_tail = self.known(frame.vertex) + b1 + ROUNDING < window.so_far + planar_norm(b1 - x, y);
        by_tail || self.known(head) + (frame.length - b0) + ROUNDING < window.so_far + planar_norm(b0 - x, y)
    }

    fn known(&self, vertex: u32) -> f64 {
        let label = &self.scratch.labels[vertex as usize];
        if label.epoch == self.scratch.epoch { label.length } else { f64::INFINITY }
    }

    /// Notes a way to a vertex; a shorter one to a saddle makes it a source.
    fn label(&mut self, vertex: u32, p_OS: &Vec3, so_far: f64, arrival: Arrival) {
        let length = so_far + (self.position(vertex) - p_OS).norm();
        self.label_at(vertex, length, arrival);
    }

    fn label_at(&mut self, vertex: u32, length: f64, arrival: Arrival) {
        if length >= self.known(vertex) {
            return;
        }
        let epoch = self.scratch.epoch;
        self.scratch.labels[vertex as usize] = Label { epoch, length, arrival };
        if self.polyhedron.is_saddle(vertex) {
            let key = length + self.bound.of_point(&self.position(vertex));
            if key < self.limit {
                self.scratch.queue.push(key, vertex | FLAG);
            }
        }
    }

    fn position(&self, vertex: u32) -> Vec3 {
        self.polyhedron.mesh.vertices()[vertex as usize]
    }

    /// Sends a window through its facet to the two other edges.
    fn spread_window(&mut self, index: u32) {
        let window = self.scratch.windows[index as usize];
        let frame = &self.polyhedron.half_edges[window.half_edge as usize];
        let ([ax, ay], [ix, iy]) = (frame.apex, window.source);
        // Positive where the apex lies to the left of the ray through an end.
        let side = |b: f64| (b - ix) * (ay - iy) + iy * (ax - ix);
        let (left_of_first, left_of_last) = (side(window.ends[0]), side(window.ends[1]));
        let margin = 1e-9 * (ay - iy) * frame.length;
        if left_of_first < margin && left_of_last > -margin {
            let length = window.so_far + planar_norm(ax - ix, ay - iy);
            self.label_at(self.polyhedron.apex(window.half_edge), length, Arrival::Window(index));
        }
        if left_of_last > 0.0 {
            self.through_right(index, &window, frame, left_of_first < 0.0);
        }
        if left_of_first < 0.0 {
            self.through_left(index, &window, frame, left_of_last > 0.0);
        }
    }

    /// Continues through the edge from the frame's head to the apex; `split` where the apex cuts the window.
    fn through_right(&mut self, index: u32, window: &Window, frame: &HalfEdge, split: bool) {
        let edge = next(window.half_edge);
        let out = self.polyhedron.half_edges[edge as usize];
        let [ax, ay] = frame.apex;
        // The far side's frame starts at the apex and runs to the head.
        let turn = [(frame.length - ax) / out.length, -ay / out.length];
        let local = |[x, y]: Planar| rotate(&turn, [x - ax, y - ay]);
        let source = local(window.source);
        let first = if split { 0.0 } else { exit(&source, &local([window.ends[0], 0.0]), out.length) };
        let last = exit(&source, &local([window.ends[1], 0.0]), out.length);
        self.push_child(index, window, out.twin, source, [first, last]);
    }

    /// Continues through the edge from the apex to the frame's tail; `split` where the apex cuts the window.
    fn through_left(&mut self, index: u32, window: &Window, frame: &HalfEdge, split: bool) {
        let edge = previous(window.half_edge);
        let out = self.polyhedron.half_edges[edge as usize];
        // The far side's frame starts at the tail and runs to the apex.
        let turn = [frame.apex[0] / out.length, frame.apex[1] / out.length];
        let source = rotate(&turn, window.source);
        let first = exit(&source, &rotate(&turn, [window.ends[0], 0.0]), out.length);
        let last =
            if split { out.length } else { exit(&source, &rotate(&turn, [window.ends[1], 0.0]), out.length) };
        self.push_child(index, window, out.twin, source, [first, last]);
    }

    fn push_child(&mut self, parent: u32, window: &Window, half_edge: u32, source: Planar, ends: [f64; 2]) {
        if ends[1] > ends[0] {
            self.push(Window { half_edge, parent, ends, source, so_far: window.so_far });
        }
    }

    /// Makes a saddle vertex the source of the facets that straight rays cannot reach past it.
    fn spread_vertex(&mut self, vertex: u32, key: f64) {
        let Label { length, arrival, .. } = self.scratch.labels[vertex as usize];
        let p_OV = self.position(vertex);
        if key > length + self.bound.of_point(&p_OV) + ROUNDING {
            return; // a shorter way was found after this one was queued
        }
        let back = self.direction_back(vertex, arrival);
        let source = self.add_source(Source { p_OS: p_OV, length, before: Some(arrival) });
        let total = self.polyhedron.total_angle[vertex as usize];
        let polyhedron = self.polyhedron;
        for outgoing in polyhedron.star(vertex) {
            let arrival = Arrival::Source(source, outgoing / 3);
            if self.scratch.target_facets.contains(&(outgoing / 3)) {
                self.offer(length + (p_OV - self.p_OT).norm(), arrival);
            }
            let neighbor = polyhedron.half_edges[next(outgoing) as usize].vertex;
            self.label(neighbor, &p_OV, length, arrival);
            // Relative to the way back, shortest paths leave between π and total - π.
            let frame = &polyhedron.half_edges[outgoing as usize];
            let from = (polyhedron.direction[outgoing as usize] - back).rem_euclid(total);
            let to = from + frame.apex[1].atan2(frame.apex[0]);
            let (low, high) = (from.max(PI), to.min(total - PI));
            if low < high + 1e-12 {
                let part = part_of_opposite(frame, low - from, high - from);
                self.open(next(outgoing), source, part);
            }
        }
    }

    /// Direction (rad, in the vertex's star) from which the path to the vertex comes.
    fn direction_back(&self, vertex: u32, arrival: Arrival) -> f64 {
        match arrival {
            Arrival::Window(index) => {
                let window = &self.scratch.windows[index as usize];
                let outgoing = previous(window.half_edge);
                let frame = &self.polyhedron.half_edges[window.half_edge as usize];
                let ([ax, ay], [ix, iy]) = (frame.apex, window.source);
                let (to_tail, to_source) = ((-ay).atan2(-ax), (iy - ay).atan2(ix - ax));
                // A ray along the edge to the tail may seem to come from just beyond it.
                let angle = (to_source - to_tail + PI).rem_euclid(TAU) - PI;
                self.polyhedron.direction[outgoing as usize] + angle.max(0.0)
            }
            Arrival::Source(source, _) => {
                self.direction_to(vertex, &self.scratch.sources[source as usize].p_OS)
            }
        }
    }

    /// Direction of a point that lies in one of the facets around the vertex.
    fn direction_to(&self, vertex: u32, p_OP: &Vec3) -> f64 {
        let to = p_OP - self.position(vertex);
        let angle_in = |outgoing: u32| {
            let frame = &self.polyhedron.half_edges[outgoing as usize];
            let inward = self.polyhedron.mesh.normal(outgoing / 3).cross(&frame.along_O);
            let off_plane = self.polyhedron.mesh.normal(outgoing / 3).dot(&to).abs();
            let angle = inward.dot(&to).atan2(frame.along_O.dot(&to));
            let corner = frame.apex[1].atan2(frame.apex[0]);
            let outside = (-angle).max(angle - corner).max(0.0) * to.norm() + off_plane;
            (outside, self.polyhedron.direction[outgoing as usize] + angle.clamp(0.0, corner))
        };
        self.polyhedron
            .star(vertex)
            .map(angle_in)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(0.0, |(_, direction)| direction)
    }
}
