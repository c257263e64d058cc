//! A closed mesh with its tree: closest points, distances of segments, supporting planes, all exact.

use crate::border::{segment, vector};
use crate::outer::Outer;
use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::partitioning::BvhNode;
use parry3d_f64::query::details::closest_points_segment_segment;
use parry3d_f64::query::{ClosestPoints, PointQuery, PointQueryWithLocation};
use parry3d_f64::shape::{Segment, TriMesh, TriMeshFlags, Triangle};
use regrasp_api::{Mesh, Vec3};
use std::sync::OnceLock;

/// The facet that is likely to hold a closest point where nothing is known: one that faces it is looked for.
pub(crate) const ANYWHERE: u32 = u32::MAX;

/// With more vertices than this, the tree finds the outermost one faster than going through all.
const FEW_VERTICES: usize = 1000;

/// Below this distance (m) its direction is too uncertain to put up a plane by.
const TOUCHING: f64 = 1e-6;
/// What rounding may take from a distance (m).
const ROUNDING: f64 = 1e-12;

/// A closed mesh with its tree.
#[derive(Debug)]
pub(crate) struct Solid {
    pub(crate) vertices: Vec<Vec3>,
    facets: Vec<[u32; 3]>,
    /// With its tree, which takes longer to build than some plans to verify: made when it is first asked for.
    tree: OnceLock<TriMesh>,
    outer: Outer,
}

/// The closest point of a solid's surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    pub(crate) point: Vec3,
    pub(crate) inside: bool,
    pub(crate) facet: u32,
}

/// Where a segment comes closest to a solid's surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    /// The distance (m).
    pub(crate) distance: f64,
    /// The unit direction from the surface to the segment; zero where they meet.
    pub(crate) direction: Vec3,
    pub(crate) facet: u32,
    /// Whether a plane is known that has the solid on one side and the segment on the other.
    is_parted: bool,
}

impl Solid {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let (vertices, facets) = (mesh.vertices().to_vec(), mesh.facets().to_vec());
        Self { vertices, facets, tree: OnceLock::new(), outer: Outer::new(mesh) }
    }

    pub(crate) fn surface(&self) -> &TriMesh {
        self.tree.get_or_init(|| {
            let vertices = self.vertices.iter().map(vector).collect();
            TriMesh::with_flags(vertices, self.facets.clone(), TriMeshFlags::ORIENTED)
                .expect("a mesh has facets, and this flag asks for nothing of them")
        })
    }

    fn triangle(&self, facet: u32) -> Triangle {
        let facet = &self.facets[(facet as usize).min(self.facets.len() - 1)];
        let [a, b, c] = facet.map(|corner| vector(&self.vertices[corner as usize]));
        Triangle::new(a, b, c)
    }

    /// The closest point of the surface. `near` is a facet that is likely to hold it; it changes the cost
    /// alone.
    pub(crate) fn closest(&self, p: &Vec3, near: u32) -> Closest {
        let near = if near == ANYWHERE { self.outer.facing(p) } else { near };
        match self.outer.closest(&self.vertices, p, near) {
            Some((point, facet)) => Closest { point, inside: false, facet },
            None => self.search(p, near),
        }
    }

    /// The closest point by a search of the tree.
    pub(crate) fn search(&self, p: &Vec3, near: u32) -> Closest {
        let p = vector(p);
        let bound = self.triangle(near).project_local_point(p, false).point;
        // The facet's own distance must stay within the bound, rounding included.
        let bound = (bound - p).length() * (1.0 + 1e-9) + 1e-12;
        let found = self.surface().project_local_point_and_get_location_with_max_dist(p, false, bound);
        let (projection, (facet, _)) =
            found.unwrap_or_else(|| self.surface().project_local_point_and_get_location(p, false));
        Closest { point: from_vector(projection.point), inside: projection.is_inside, facet }
    }

    pub(crate) fn facet_count(&self) -> u32 {
        self.facets.len() as u32
    }

    /// The corners of a facet (m), and its outward normal.
    pub(crate) fn corners(&self, facet: u32) -> ([Vec3; 3], Vec3) {
        let Triangle { a, b, c } = self.triangle(facet);
        let [a, b, c] = [a, b, c].map(from_vector);
        ([a, b, c], (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vec3::zeros))
    }

    /// The area of the surface (m²).
    pub(crate) fn area(&self) -> f64 {
        (0..self.facet_count()).map(|facet| self.triangle(facet).area()).sum()
    }

    pub(crate) fn contains(&self, p: &Vec3) -> bool {
        self.closest(p, ANYWHERE).inside
    }

    /// Where a segment comes closest to the surface; `near` as for [`Self::closest`].
    pub(crate) fn gap_to_segment(&self, p: &Vec3, q: &Vec3, near: u32) -> Gap {
        self.gap_below(p, q, near, f64::INFINITY).unwrap_or_else(|farther| farther)
    }

    /// The same where the distance is below `most` (m); else an upper bound of it, where `near` is.
    pub(crate) fn gap_below(&self, p: &Vec3, q: &Vec3, near: u32, most: f64) -> Result<Gap, Gap> {
        let near = if near == ANYWHERE { self.outer.facing(&((p + q) / 2.0)) } else { near };
        match self.gap_at_end(p, q, near).or_else(|| self.gap_at_end(q, p, near)) {
            Some(gap) if gap.distance < most => Ok(gap),
            Some(gap) => Err(gap),
            None => self.search_below(p, q, near, most),
        }
    }

    /// Whether any of a segment is inside, which does not meet the surface; `gap` is where it is near.
    pub(crate) fn swallows(&self, p: &Vec3, q: &Vec3, gap: &Gap) -> bool {
        let is_parted = |n: &Vec3| n.dot(p).min(n.dot(q)) > self.support(n) + ROUNDING;
        !gap.is_parted && !is_parted(&gap.direction) && self.contains(p)
    }

    /// The same where it is the end `p` that comes closest, and no search is needed: all of the mesh is on
    /// one side of a plane, and `q` on the other.
    fn gap_at_end(&self, p: &Vec3, q: &Vec3, near: u32) -> Option<Gap> {
        let (point, facet) = self.outer.closest(&self.vertices, p, near)?;
        let away = p - point;
        let gap = || Gap { is_parted: true, ..Gap::new(away.norm(), vector(&away), facet) };
        (away.dot(&(q - p)) >= 0.0).then(gap)
    }

    /// The same by a search of the tree, unless `near` is seen to hold it.
    #[cfg(test)]
    pub(crate) fn search_segment(&self, p: &Vec3, q: &Vec3, near: u32) -> Gap {
        self.search_below(p, q, near, f64::INFINITY).unwrap_or_else(|farther| farther)
    }

    fn search_below(&self, p: &Vec3, q: &Vec3, near: u32, most: f64) -> Result<Gap, Gap> {
        let line = segment(p, q);
        let first = between(&self.triangle(near), &line);
        let is_far = !self.is_least(p, q, first);
        let (near, first) = if is_far { self.descend(near, &line) } else { (near, first) };
        let at_first = |is_parted: bool| {
            let gap = Gap { is_parted, ..Gap::new(first.0, first.1, near) };
            if first.0 < most { Ok(gap) } else { Err(gap) }
        };
        if !is_far || self.is_least(p, q, first) {
            return at_first(true);
        }
        let (low, high) = (line.a.min(line.b), line.a.max(line.b));
        let bound = |node: &BvhNode, _: f64| {
            let half = (node.maxs() - node.mins()) * 0.5;
            // A ball around the node against the segment, and both boxes: long boxes suit the second, slanted
            // segments the first.
            let ball = line.distance_to_local_point(node.center(), true) - half.length();
            let boxes = (node.mins() - high).max(low - node.maxs()).max(Vector::ZERO).length();
            ball.max(boxes)
        };
        let leaf = |facet: u32, _: f64| Some(between(&self.triangle(facet), &line));
        match self.surface().bvh().find_best(first.0.min(most), bound, leaf) {
            Some((facet, (distance, away))) => Ok(Gap::new(distance, away, facet)),
            None => at_first(false),
        }
    }

    /// From a facet to those beside it, or beside these, as long as one is closer to a segment: where that
    /// ends, and how close it is.
    fn descend(&self, near: u32, line: &Segment) -> (u32, (f64, Vector)) {
        let near = near.min(self.facet_count() - 1);
        let mut best = (near, between(&self.triangle(near), line));
        loop {
            let beside = self.outer.beside(best.0);
            let beyond = beside.iter().flat_map(|&facet| self.outer.beside(facet));
            let better = |facet: &u32| {
                let gap = between(&self.triangle(*facet), line);
                (gap.0 < best.1.0).then_some((*facet, gap))
            };
            let closest = |a: &(u32, (f64, Vector)), b: &(u32, (f64, Vector))| a.1.0.total_cmp(&b.1.0);
            let next = beside.iter().filter_map(better).min_by(closest);
            match next.or_else(|| beyond.filter_map(|facet| better(&facet)).min_by(closest)) {
                Some(next) => best = next,
                None => return best,
            }
        }
    }

    /// Whether a distance found of a segment, with the vector to it from the surface, is the least: a plane
    /// across that vector has all vertices on the one side and the segment at that distance on the other.
    fn is_least(&self, p: &Vec3, q: &Vec3, (distance, away): (f64, Vector)) -> bool {
        let n = from_vector(away) / distance;
        let end = n.dot(p).min(n.dot(q));
        distance > TOUCHING && end - self.support(&n) >= distance - ROUNDING
    }

    /// The largest of `n · v` over the vertices.
    pub(crate) fn support(&self, n: &Vec3) -> f64 {
        if self.vertices.len() <= FEW_VERTICES {
            return highest(&self.vertices, n);
        }
        let n = vector(n);
        let bound = |node: &BvhNode, _: f64| {
            let half = (node.maxs() - node.mins()) * 0.5;
            -(n.dot(node.center()) + n.abs().dot(half))
        };
        let leaf = |facet: u32, _: f64| {
            let Triangle { a, b, c } = self.triangle(facet);
            Some(-n.dot(a).max(n.dot(b)).max(n.dot(c)))
        };
        self.surface().bvh().find_best(f64::MAX, bound, leaf).map_or(f64::INFINITY, |(_, lowest)| -lowest)
    }
}

/// The largest of `n · v` over vertices.
pub(crate) fn highest(vertices: &[Vec3], n: &Vec3) -> f64 {
    // Four at a time, which wait for nothing.
    let mut most = [f64::NEG_INFINITY; 4];
    let mut chunks = vertices.chunks_exact(4);
    for four in &mut chunks {
        for (most, v) in most.iter_mut().zip(four) {
            let height = n.dot(v);
            *most = if height > *most { height } else { *most };
        }
    }
    let rest = chunks.remainder().iter().map(|v| n.dot(v));
    most.into_iter().chain(rest).fold(f64::NEG_INFINITY, f64::max)
}

impl Gap {
    /// Where nothing is known yet but that it may be at this facet.
    pub(crate) const fn somewhere(facet: u32) -> Self {
        Self { distance: 0.0, direction: Vec3::new(0.0, 0.0, 0.0), facet, is_parted: false }
    }

    fn new(distance: f64, away: Vector, facet: u32) -> Self {
        let direction = from_vector(away).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        Self { distance, direction, facet, is_parted: false }
    }
}

/// The distance of a triangle and a segment, with the vector from one to the other there.
///
/// If the segment does not pass through the triangle, one of the closest two points is an end of the segment
/// or lies on an edge of the triangle.
fn between(triangle: &Triangle, line: &Segment) -> (f64, Vector) {
    if pierces(triangle, line) {
        return (0.0, Vector::ZERO);
    }
    let ends = [line.a, line.b].map(|end| end - triangle.project_local_point(end, false).point);
    let edges = triangle.edges().map(|edge| {
        match closest_points_segment_segment(&ParryPose::IDENTITY, &edge, line, f64::MAX) {
            ClosestPoints::WithinMargin(on_edge, on_line) => on_line - on_edge,
            _ => Vector::ZERO,
        }
    });
    let all = ends.into_iter().chain(edges).map(|away| (away.length(), away));
    all.fold((f64::INFINITY, Vector::ZERO), |least, one| if one.0 < least.0 { one } else { least })
}

fn pierces(triangle: &Triangle, line: &Segment) -> bool {
    let Triangle { a, b, c } = *triangle;
    let n = (b - a).cross(c - a);
    let (from, to) = (n.dot(line.a - a), n.dot(line.b - a));
    if from * to > 0.0 || from == to {
        return false;
    }
    let x = line.a + (line.b - line.a) * (from / (from - to));
    [(a, b), (b, c), (c, a)].iter().all(|(u, v)| (*v - *u).cross(x - *u).dot(n) >= 0.0)
}

fn from_vector(v: Vector) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}
