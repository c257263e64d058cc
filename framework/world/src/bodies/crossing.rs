//! Facets that cross each other.

use super::BodyFault;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
use regrasp_api::{Mesh, Vec3};
use std::f64::consts::PI;

/// Facets that reach through each other by less than this part of the mesh's size touch.
const DEEP: f64 = 1e-6;
/// Two facets that meet at an angle (rad) below this lie back to back.
const FOLDED: f64 = 1e-6;

/// Refuses a mesh whose surfaces cross.
pub(super) fn check(mesh: &Mesh, part_of: &[u32], count: usize) -> Result<(), BodyFault> {
    let (mut crossings, mut first) = (0, None);
    let deep = DEEP * mesh.radius();
    let boxes: Vec<Aabb> = (0..mesh.facets().len() as u32).map(|facet| bounds(mesh, facet)).collect();
    let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
    for (facet, around) in (0u32..).zip(&boxes) {
        folded(mesh, facet)?;
        for other in tree.intersect_aabb(around).filter(|&other| other > facet) {
            let Some(at) = crossing(mesh, facet, other, deep) else { continue };
            let [a, b] = [facet, other].map(|f| part_of[f as usize] as usize + 1);
            if a != b {
                return Err(BodyFault::Overlap { first: a.min(b), second: a.max(b), count, at: at.into() });
            }
            crossings += 1;
            first.get_or_insert(at);
        }
    }
    first.map_or(Ok(()), |at| Err(BodyFault::Crossing { count: crossings, at: at.into() }))
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
