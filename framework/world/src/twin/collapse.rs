//! Fewer facets, each near the true mesh.

use super::editable::{Editable, unit_normal};
use super::near::Near;
use super::places::on_facet;
use super::quadric::Quadric;
use super::touch::Touch;
use regrasp_api::{Mesh, Vec3};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A facet may turn by the angle of this cosine when a corner of it moves.
const LEAST_TURN: f64 = 0.3;
/// Places that are looked at on a new facet are at most this many radii apart.
const SPACING: f64 = 0.08;
/// An end of an edge is as good a place as the best if it is farther off by at most this part of the
/// tolerance.
const AS_GOOD: f64 = 0.02;

/// A pair of vertices that may become one, cheapest first; ties in the order of the numbers.
type Pair = Reverse<(u64, u32, u32, u32)>;

struct Collapse<'a> {
    surface: &'a mut Editable,
    touch: &'a Touch,
    /// How far (m) the new facets may be from the true mesh.
    tolerance: f64,
    near: &'a Near<'a>,
    quadrics: Vec<Quadric>,
    /// How often each vertex has moved: pairs from before are out of date.
    versions: Vec<u32>,
    queue: BinaryHeap<Pair>,
}

/// Merges vertices, the least costly first, as long as the facets stay within `tolerance` (m) of the true
/// mesh.
pub(super) fn collapse(surface: &mut Editable, mesh: &Mesh, touch: &Touch, tolerance: f64) {
    let (quadrics, near) = (quadrics(surface), Near::new(mesh, tolerance));
    let versions = vec![0; surface.vertices.len()];
    let queue = BinaryHeap::new();
    let mut run = Collapse { surface, touch, tolerance, near: &near, quadrics, versions, queue };
    for vertex in 0..run.surface.vertices.len() as u32 {
        run.offer(vertex, |other| other > vertex);
    }
    while let Some(Reverse((_, u, v, version))) = run.queue.pop() {
        let current = run.versions[u as usize] + run.versions[v as usize];
        if current == version
            && !run.surface.stars[u as usize].is_empty()
            && !run.surface.stars[v as usize].is_empty()
        {
            run.merge(u, v);
        }
    }
}

fn quadrics(surface: &Editable) -> Vec<Quadric> {
    let mut quadrics = vec![Quadric::zero(); surface.vertices.len()];
    for facet in surface.facets.iter().flatten() {
        let [a, b, c] = facet.map(|vertex| surface.point(vertex));
        let cross = (b - a).cross(&(c - a));
        let Some(n) = cross.try_normalize(0.0) else { continue };
        let plane = Quadric::plane(&n, &a, cross.norm());
        facet.iter().for_each(|&v| quadrics[v as usize] = quadrics[v as usize].plus(&plane));
    }
    quadrics
}

impl Collapse<'_> {
    /// Puts the pairs of a vertex and its neighbours into the queue.
    fn offer(&mut self, u: u32, wanted: impl Fn(u32) -> bool) {
        for v in self.surface.around(u).into_iter().filter(|&v| wanted(v)) {
            let (_, error) = self.place(u, v);
            if error.sqrt() <= self.tolerance {
                let version = self.versions[u as usize] + self.versions[v as usize];
                // Costs are not negative: their bits order as they do.
                let cost = error + self.length_cost(u, v);
                self.queue.push(Reverse((cost.to_bits(), u.min(v), u.max(v), version)));
            }
        }
    }

    /// What an edge costs for its length (m²): of those that are as good the shortest goes first, or in flat
    /// parts one vertex would gather all others round itself.
    fn length_cost(&self, u: u32, v: u32) -> f64 {
        let length = (self.surface.point(v) - self.surface.point(u)).norm();
        (AS_GOOD * self.tolerance * length / self.touch.radius).powi(2)
    }

    /// Where two vertices become one, and the error there (m²).
    fn place(&self, u: u32, v: u32) -> (Vec3, f64) {
        let quadric = self.quadrics[u as usize].plus(&self.quadrics[v as usize]);
        let (p, q) = (self.surface.point(u), self.surface.point(v));
        let middle = (p + q) * 0.5;
        let best = quadric.best(&middle);
        let length = (q - p).norm();
        let candidates = [best, middle, p, q].into_iter().filter(|x| (x - middle).norm() <= length);
        let judged = candidates.map(|x| (x, quadric.error(&x)));
        let least = judged.min_by(|a, b| a.1.total_cmp(&b.1)).expect("the middle is always near enough");
        // Where an end is as good, as in all that is flat, half of the facets stay as they are.
        let ends = [p, q].map(|x| (x, quadric.error(&x)));
        let end = if ends[0].1 <= ends[1].1 { ends[0] } else { ends[1] };
        if end.1.sqrt() <= least.1.sqrt() + AS_GOOD * self.tolerance { end } else { least }
    }

    fn merge(&mut self, u: u32, v: u32) {
        let (place, _) = self.place(u, v);
        let shared: Vec<u32> = self.surface.facets_with(u, v).collect();
        if shared.len() != 2 || !self.is_disc(u, v) {
            return;
        }
        let star = self.surface.stars[u as usize].iter().chain(&self.surface.stars[v as usize]);
        let kept: Vec<u32> = star.copied().filter(|facet| !shared.contains(facet)).collect();
        if !self.is_near(&place, u, v, &kept) {
            return;
        }
        shared.iter().for_each(|&facet| self.surface.remove(facet));
        for facet in kept {
            let corners = self.surface.corners(facet);
            if corners.contains(&v) {
                self.surface.remove(facet);
                self.surface.put(facet, corners.map(|vertex| if vertex == v { u } else { vertex }));
            }
        }
        self.surface.vertices[u as usize] = place;
        self.quadrics[u as usize] = self.quadrics[u as usize].plus(&self.quadrics[v as usize]);
        self.versions[u as usize] += self.versions[v as usize] + 1;
        self.offer(u, |_| true);
    }

    /// Whether the surface stays one when the edge shrinks: its ends have two neighbours in common (the link
    /// condition).
    fn is_disc(&self, u: u32, v: u32) -> bool {
        let (around_u, around_v) = (self.surface.around(u), self.surface.around(v));
        around_u.len() + around_v.len() > 8 && around_u.iter().filter(|w| around_v.contains(w)).count() == 2
    }

    /// Whether the facets that are kept neither turn over nor leave the true mesh when both ends move to
    /// `place`.
    fn is_near(&self, place: &Vec3, u: u32, v: u32, kept: &[u32]) -> bool {
        let moves = |vertex: u32| (vertex == u || vertex == v) && self.surface.point(vertex) != *place;
        let changed = kept.iter().map(|&facet| self.surface.corners(facet));
        let changed: Vec<_> = changed.filter(|corners| corners.iter().any(|&vertex| moves(vertex))).collect();
        let moved = |corners: &[u32; 3]| {
            corners.map(|vertex| if moves(vertex) { *place } else { self.surface.point(vertex) })
        };
        let stays = |corners: &[u32; 3]| {
            let Some(n) = unit_normal(moved(corners)) else { return false };
            let before = self.surface.normal(*corners);
            before.is_none_or(|before| before.dot(&n) > LEAST_TURN)
        };
        // Most of those that are not near are not so in their middle.
        let likely = |corners: &[u32; 3]| self.near.has(&(moved(corners).iter().sum::<Vec3>() / 3.0));
        changed.iter().all(stays)
            && self.near.has(place)
            && changed.iter().all(likely)
            && changed.iter().all(|corners| self.is_covered(moved(corners)))
    }

    /// Whether all of a facet is near the true mesh, which has its solid below it.
    fn is_covered(&self, corners: [Vec3; 3]) -> bool {
        let Some(n) = unit_normal(corners) else { return false };
        let mut is_near = true;
        on_facet(corners, SPACING * self.touch.radius, |p| is_near = is_near && self.near.has(p));
        // Facets that have turned over have the solid above them.
        let above = corners.iter().sum::<Vec3>() / 3.0 + n * (3.0 * self.tolerance);
        is_near && self.touch.height(&above) > 0.0
    }
}
