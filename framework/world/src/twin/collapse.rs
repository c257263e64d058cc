//! Fewer facets, each near the true mesh.

use super::editable::{Editable, unit_normal};
use super::quadric::Quadric;
use super::touch::{Touch, on_facet};
use regrasp_api::Vec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A facet may turn by the angle of this cosine when a corner of it moves.
const LEAST_TURN: f64 = 0.3;
/// Places that are looked at on a new facet are at most this many radii apart.
const SPACING: f64 = 0.08;

/// A pair of vertices that may become one, cheapest first; ties in the order of the numbers.
type Pair = Reverse<(u64, u32, u32, u32)>;

struct Collapse<'a> {
    surface: &'a mut Editable,
    touch: &'a Touch,
    /// How far (m) the new facets may be from the true mesh.
    tolerance: f64,
    quadrics: Vec<Quadric>,
    /// How often each vertex has moved: pairs from before are out of date.
    versions: Vec<u32>,
    queue: BinaryHeap<Pair>,
}

/// Merges vertices, the least costly first, as long as the facets stay within `tolerance` (m) of the true
/// mesh.
pub(super) fn collapse(surface: &mut Editable, touch: &Touch, tolerance: f64) {
    let quadrics = quadrics(surface);
    let versions = vec![0; surface.vertices.len()];
    let mut run = Collapse { surface, touch, tolerance, quadrics, versions, queue: BinaryHeap::new() };
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
                // Errors are not negative: their bits order as they do.
                self.queue.push(Reverse((error.to_bits(), u.min(v), u.max(v), version)));
            }
        }
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
        judged.min_by(|a, b| a.1.total_cmp(&b.1)).expect("the middle is always near enough")
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
        let near = |p: &Vec3| self.touch.height(p).abs() <= self.tolerance;
        let stays = |&facet: &u32| {
            let corners = self.surface.corners(facet);
            let moved = corners
                .map(|vertex| if vertex == u || vertex == v { *place } else { self.surface.point(vertex) });
            let Some(n) = unit_normal(moved) else { return false };
            let before = self.surface.normal(corners);
            before.is_none_or(|before| before.dot(&n) > LEAST_TURN)
        };
        let covered = |&facet: &u32| {
            let corners = self.surface.corners(facet);
            let moved = corners
                .map(|vertex| if vertex == u || vertex == v { *place } else { self.surface.point(vertex) });
            let mut is_near = true;
            let Some(n) = unit_normal(moved) else { return false };
            // Facets that have turned over have the solid above them.
            let above = (moved[0] + moved[1] + moved[2]) / 3.0 + n * (3.0 * self.tolerance);
            if self.touch.height(&above) <= 0.0 {
                return false;
            }
            on_facet(moved, SPACING * self.touch.radius, |p| is_near = is_near && near(p));
            is_near
        };
        kept.iter().all(stays) && near(place) && kept.iter().all(covered)
    }
}
