//! Mild dents filled by turning concave edges over.
//!
//! Two facets a-b-c and b-a-d that meet in a concave edge a-b leave a dent; with c-d in its place the edge is
//! convex, and the solid has grown by one tetrahedron. Where nothing forbids it this ends in the convex hull;
//! here it ends where a fingertip would feel it.

use super::editable::{Editable, unit_normal};
use super::near::Near;
use super::places::on_facet;
use super::touch::Touch;
use crate::clearance::Field;
use regrasp_api::{Mesh, Vec3};
use std::cell::Cell;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// An edge is concave if the far corner stands above the facet by more than this part of its distance.
const CONCAVE: f64 = 1e-7;
/// Places that are looked at on a new edge are at most this many radii apart ...
const SPACING: f64 = 0.08;
/// ... and no more than this many.
const MOST_PLACES: usize = 40;
/// How far (radii) a new facet may be from the mesh itself, in dents too narrow for the ball.
const WIDEST: f64 = 0.12;
/// A new facet may lean by the angle of half this cosine from those that it covers.
const LEAST_TURN: f64 = 0.2;
/// A ball on a new facet that enters the mesh deeper than this many radii (negative: inside) tells that the
/// facet has turned over.
const DEEPEST: f64 = -0.5;

struct Fill<'a> {
    surface: &'a mut Editable,
    touch: &'a Touch,
    /// How far (m) a fingertip on the new facets may be from the true mesh.
    tolerance: f64,
    /// Cheap bounds that decide nearly always.
    near: &'a Near<'a>,
    field: &'a Field,
    /// A facet of the true mesh at the last place.
    last: Cell<u32>,
    /// Concave edges that can be turned over, the shallowest first; ties in the order of the numbers.
    queue: BinaryHeap<Reverse<(u64, u32, u32)>>,
}

/// What fills the dent at an edge.
enum Filling {
    /// The edge turned over: its facets and their third corners.
    Turn { facets: [u32; 2], apexes: [u32; 2] },
    /// One facet instead of the three round a vertex.
    Lid { vertex: u32, corners: [u32; 3] },
}

/// Turns concave edges over as long as a fingertip on what is new is at most `tolerance` (m) from the true
/// mesh.
pub(super) fn fill(surface: &mut Editable, mesh: &Mesh, touch: &Touch, tolerance: f64) {
    let (near, field) = (Near::new(mesh, tolerance), touch.field());
    let mut run = Fill {
        surface,
        touch,
        tolerance,
        near: &near,
        field: &field,
        last: Cell::new(0),
        queue: BinaryHeap::new(),
    };
    let facets: Vec<[u32; 3]> = run.surface.facets.iter().flatten().copied().collect();
    for corners in facets {
        run.offer_all(corners);
    }
    while let Some(Reverse((_, a, b))) = run.queue.pop() {
        if let Some(filling) = run.filling(a, b) {
            run.apply(filling, [a, b]);
        }
    }
}

impl Fill<'_> {
    fn offer_all(&mut self, corners: [u32; 3]) {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            if let Some(depth) = self.depth(a, b) {
                self.queue.push(Reverse((depth.to_bits(), a.min(b), a.max(b))));
            }
        }
    }

    /// How deep (m) the dent at an edge is: how far the edge lies below the one that would fill it; `None`
    /// where it is not concave.
    fn depth(&self, a: u32, b: u32) -> Option<f64> {
        let ((_, c), (_, d)) = (self.surface.beside(a, b)?, self.surface.beside(b, a)?);
        let [p, q, r, s] = [a, b, c, d].map(|vertex| self.surface.point(vertex));
        let n = unit_normal([p, q, r])?;
        if n.dot(&(s - p)) <= CONCAVE * (s - p).norm() {
            return None;
        }
        let across = (q - p).cross(&(s - r)).try_normalize(0.0)?;
        Some(across.dot(&(r - p)).abs())
    }

    /// What fills the dent at the edge a-b; `None` where there is none, or a fingertip would feel it.
    fn filling(&self, a: u32, b: u32) -> Option<Filling> {
        self.depth(a, b)?;
        for vertex in [a, b] {
            if self.surface.stars[vertex as usize].len() == 3 {
                return self.lid(vertex);
            }
        }
        let ((f, c), (g, d)) = (self.surface.beside(a, b)?, self.surface.beside(b, a)?);
        if c == d || self.surface.beside(c, d).is_some() || self.surface.beside(d, c).is_some() {
            return None;
        }
        let up = self.surface.normal([a, b, c])? + self.surface.normal([b, a, d])?;
        let (one, other) = ([a, d, c], [d, b, c]);
        let (n, m) = (self.surface.normal(one)?, self.surface.normal(other)?);
        if n.dot(&up) <= LEAST_TURN || m.dot(&up) <= LEAST_TURN {
            return None;
        }
        let bent = self.is_near_edge([c, d], &n, &m);
        let sides = [(a, d, n), (c, a, n), (d, b, m), (b, c, m)];
        let is_near = bent
            && self.is_near_facet(one, &n)
            && self.is_near_facet(other, &m)
            && sides.iter().all(|&(u, v, n)| self.is_near_side([u, v], &n));
        is_near.then_some(Filling::Turn { facets: [f, g], apexes: [c, d] })
    }

    /// The facet over a vertex with three facets.
    fn lid(&self, vertex: u32) -> Option<Filling> {
        let around = self.surface.around(vertex);
        let [x, y, z] = around[..].try_into().ok()?;
        let corners = if self.surface.beside(x, y)?.1 == vertex { [x, y, z] } else { [y, x, z] };
        // The other side of the lid must not be a facet: a tetrahedron would become flat.
        if self.surface.beside(corners[1], corners[0])?.1 == corners[2] {
            return None;
        }
        let n = self.surface.normal(corners)?;
        if n.dot(&(self.surface.point(vertex) - self.surface.point(x))) >= 0.0 {
            return None;
        }
        let sides = (0..3).all(|k| self.is_near_side([corners[k], corners[(k + 1) % 3]], &n));
        (sides && self.is_near_facet(corners, &n)).then_some(Filling::Lid { vertex, corners })
    }

    /// The same at a side of a new facet with the normal `n`, where it meets a facet that stays.
    fn is_near_side(&self, [u, v]: [u32; 2], n: &Vec3) -> bool {
        let Some((_, w)) = self.surface.beside(v, u) else { return false };
        let Some(m) = self.surface.normal([v, u, w]) else { return true };
        let rises = n.dot(&(self.surface.point(w) - self.surface.point(u))) > 0.0;
        rises || self.is_near_edge([u, v], n, &m)
    }

    /// Whether a ball that turns about an edge stays near the true mesh.
    fn is_near_edge(&self, ends: [u32; 2], n: &Vec3, m: &Vec3) -> bool {
        let [r, s] = ends.map(|vertex| self.surface.point(vertex));
        let pieces = ((s - r).norm() / (SPACING * self.touch.radius)).ceil().clamp(2.0, MOST_PLACES as f64);
        let Some(n) = (n + m).try_normalize(1e-9) else { return false };
        (1..pieces as usize).all(|i| self.is_near(&r.lerp(&s, i as f64 / pieces), &n))
    }

    fn is_near_facet(&self, corners: [u32; 3], n: &Vec3) -> bool {
        let mut is_near = true;
        let corners = corners.map(|vertex| self.surface.point(vertex));
        on_facet(corners, SPACING * self.touch.radius, |p| is_near = is_near && self.is_near(p, n));
        is_near
    }

    /// Whether a ball that touches at `p` is near the true mesh: not farther than the tolerance; its centre
    /// not inside, as it would be at a facet that has turned over; and `p` not so far from the mesh that the
    /// place is one between walls.
    fn is_near(&self, p: &Vec3, n: &Vec3) -> bool {
        // Where `p` itself is near, so is the ball, and only its centre may be where it should not.
        let radius = self.touch.radius;
        if self.near.has(p) && self.field.lower(&(p + n * radius)) > (1.0 + DEEPEST) * radius {
            return true;
        }
        let mut last = self.last.get();
        let gap = self.touch.gap(p, n, &mut last);
        self.last.set(last);
        gap <= self.tolerance
            && gap > DEEPEST * self.touch.radius
            && self.touch.height(p) < WIDEST * self.touch.radius
    }

    fn apply(&mut self, filling: Filling, [a, b]: [u32; 2]) {
        match filling {
            Filling::Turn { facets: [f, g], apexes: [c, d] } => {
                self.surface.remove(f);
                self.surface.remove(g);
                self.surface.put(f, [a, d, c]);
                self.surface.put(g, [d, b, c]);
                self.offer_all([a, d, c]);
                self.offer_all([d, b, c]);
            }
            Filling::Lid { vertex, corners } => {
                let facets = self.surface.stars[vertex as usize].clone();
                facets.iter().for_each(|&facet| self.surface.remove(facet));
                self.surface.put(facets[0], corners);
                self.offer_all(corners);
            }
        }
    }
}
