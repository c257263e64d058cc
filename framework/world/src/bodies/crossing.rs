//! Facets that cross each other.

use super::BodyFault;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use regrasp_api::{Mesh, Vec3};
use std::f64::consts::PI;

/// Facets that reach through each other by less than this part of the mesh's size touch.
const DEEP: f64 = 1e-6;
/// The line that two facets share is the same for both to so many times that.
const BESIDE: f64 = 20.0;
/// Two facets that meet at an angle (rad) below this lie back to back.
const FOLDED: f64 = 1e-6;

/// Pairs of facets that are looked at together: as many as fit into little memory.
const BATCH: usize = 1 << 20;
/// Fewer pairs are no work for a second thread.
const FEW: usize = 20_000;

/// Refuses a mesh whose surfaces cross.
pub(super) fn check(mesh: &Mesh, part_of: &[u32], count: usize) -> Result<(), BodyFault> {
    let facets = 0..mesh.facets().len() as u32;
    facets.clone().try_for_each(|facet| folded(mesh, facet))?;
    let tree = Bvh::from_iter(BvhBuildStrategy::Binned, facets.map(|f| (f as usize, bounds(mesh, f))));
    let mut found =
        Found { deep: DEEP * mesh.radius(), mesh, part_of, crossings: 0, first: None, overlap: None };
    let mut batch = Vec::with_capacity(BATCH.min(16 * mesh.facets().len()));
    tree.traverse_bvtt_single_tree::<false>(&mut BvhWorkspace::default(), &mut |a, b| {
        batch.push((a.min(b), a.max(b)));
        if batch.len() == BATCH {
            found.look(&batch);
            batch.clear();
        }
    });
    found.look(&batch);
    if let Some((pair, at)) = found.overlap {
        let [a, b] = found.parts(pair).map(|part| part as usize + 1);
        return Err(BodyFault::Overlap { first: a.min(b), second: a.max(b), count, at: at.into() });
    }
    let first = found.first.map(|(_, at)| BodyFault::Crossing { count: found.crossings, at: at.into() });
    first.map_or(Ok(()), Err)
}

/// Two facets, that of the smaller number first.
type Pair = (u32, u32);

/// What was found so far; of several places the one of the first pair, in whatever order they come.
#[derive(Clone, Copy)]
struct Found<'a> {
    mesh: &'a Mesh,
    part_of: &'a [u32],
    deep: f64,
    /// How often facets of one body cross, and where first.
    crossings: usize,
    first: Option<(Pair, Vec3)>,
    /// Where facets of different bodies do.
    overlap: Option<(Pair, Vec3)>,
}

impl Found<'_> {
    fn parts(&self, pair: Pair) -> [u32; 2] {
        [self.part_of[pair.0 as usize], self.part_of[pair.1 as usize]]
    }

    /// Looks at pairs of facets whose boxes meet.
    fn look(&mut self, pairs: &[Pair]) {
        if pairs.len() < FEW {
            return self.look_at(pairs);
        }
        let (some, others) = pairs.split_at(pairs.len() / 2);
        let mut other = Self { crossings: 0, first: None, overlap: None, ..*self };
        std::thread::scope(|scope| {
            scope.spawn(|| other.look_at(others));
            self.look_at(some);
        });
        self.crossings += other.crossings;
        self.first = earlier(self.first, other.first);
        self.overlap = earlier(self.overlap, other.overlap);
    }

    fn look_at(&mut self, pairs: &[Pair]) {
        for &pair in pairs {
            let Some(at) = crossing(self.mesh, pair.0, pair.1, self.deep) else { continue };
            let [a, b] = self.parts(pair);
            if a == b {
                self.crossings += 1;
                self.first = earlier(self.first, Some((pair, at)));
            } else {
                self.overlap = earlier(self.overlap, Some((pair, at)));
            }
        }
    }
}

fn earlier(a: Option<(Pair, Vec3)>, b: Option<(Pair, Vec3)>) -> Option<(Pair, Vec3)> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.0 < a.0 { b } else { a }),
        (a, b) => a.or(b),
    }
}

fn bounds(mesh: &Mesh, facet: u32) -> Aabb {
    let [a, b, c] = mesh.corners(facet).map(|v| Vector::new(v.x, v.y, v.z));
    Aabb::new(a.min(b).min(c), a.max(b).max(c))
}

fn folded(mesh: &Mesh, facet: u32) -> Result<(), BodyFault> {
    let fold = mesh.neighbors(facet).iter().position(|neighbor| neighbor.bend.abs() > PI - FOLDED);
    let corners = mesh.corners(facet);
    fold.map_or(Ok(()), |k| Err(BodyFault::Fold { at: ((corners[k] + corners[(k + 1) % 3]) / 2.0).into() }))
}

/// Where two facets cross: the middle of the piece of line that they share. `None` where they share an edge,
/// only touch, or are apart.
fn crossing(mesh: &Mesh, a: u32, b: u32, deep: f64) -> Option<Vec3> {
    let (of_a, of_b) = (mesh.facets()[a as usize], mesh.facets()[b as usize]);
    if of_a.iter().filter(|vertex| of_b.contains(vertex)).count() > 1 {
        return None;
    }
    // Both cuts lie on the line in which the two planes meet.
    let ([p, q], [r, s]) = (cut(mesh, a, b, deep)?, cut(mesh, b, a, deep)?);
    let length = (q - p).norm();
    if length <= deep {
        return None;
    }
    let along = (q - p) / length;
    // They do not where a plane hardly leans from the other, and a corner that counts as on it is far from
    // the line: then the facets lie side by side.
    let beside = |x: &Vec3| along.cross(&(x - p)).norm();
    if beside(&r).max(beside(&s)) > BESIDE * deep {
        return None;
    }
    let (r, s) = ((r - p).dot(&along), (s - p).dot(&along));
    let (from, to) = (r.min(s).max(0.0), r.max(s).min(length));
    (to - from > deep).then(|| p + along * (0.5 * (from + to)))
}

/// The piece of the plane of `other` within a facet whose surface goes through that plane there: across the
/// facet itself, or along an edge of it, beyond which the surface goes on at the other side.
fn cut(mesh: &Mesh, facet: u32, other: u32, deep: f64) -> Option<[Vec3; 2]> {
    let (n, on) = (mesh.normal(other), mesh.corners(other)[0]);
    let height = |p: &Vec3| n.dot(&(p - on));
    let side = |h: f64| if h.abs() <= deep { 0.0 } else { h.signum() };
    let corners = mesh.corners(facet);
    let heights = corners.map(|p| height(&p));
    let sides = heights.map(side);
    if let Some(k) = (0..3).find(|&k| sides[k] == 0.0 && sides[(k + 1) % 3] == 0.0) {
        let across = mesh.neighbors(facet)[k];
        let tip = mesh.corners(across.facet)[(usize::from(across.edge) + 2) % 3];
        let through = sides[(k + 2) % 3] * side(height(&tip)) < 0.0;
        return through.then_some([corners[k], corners[(k + 1) % 3]]);
    }
    let mut ends = (0..3).filter_map(|k| {
        let next = (k + 1) % 3;
        match sides[k] * sides[next] {
            _ if sides[k] == 0.0 => Some(corners[k]),
            opposite if opposite < 0.0 => {
                Some(corners[k].lerp(&corners[next], heights[k] / (heights[k] - heights[next])))
            }
            _ => None,
        }
    });
    Some([ends.next()?, ends.next()?])
}
