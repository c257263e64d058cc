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

/// Where two facets cross; `None` where they share an edge, only touch, or are apart.
fn crossing(mesh: &Mesh, a: u32, b: u32, deep: f64) -> Option<Vec3> {
    let (of_a, of_b) = (mesh.facets()[a as usize], mesh.facets()[b as usize]);
    if of_a.iter().filter(|vertex| of_b.contains(vertex)).count() > 1 {
        return None;
    }
    pierced(mesh, (a, &of_a), (b, &of_b), deep).or_else(|| pierced(mesh, (b, &of_b), (a, &of_a), deep))
}

/// Where an edge of the facet `a` goes through the facet `b`.
fn pierced(mesh: &Mesh, (a, of_a): (u32, &[u32; 3]), (b, of_b): (u32, &[u32; 3]), deep: f64) -> Option<Vec3> {
    let (ends, corners, n) = (mesh.corners(a), mesh.corners(b), mesh.normal(b));
    (0..3).find_map(|k| {
        let next = (k + 1) % 3;
        if of_b.contains(&of_a[k]) || of_b.contains(&of_a[next]) {
            return None;
        }
        let (p, q) = (ends[k], ends[next]);
        let (from, to) = (n.dot(&(p - corners[0])), n.dot(&(q - corners[0])));
        if from * to >= 0.0 || from.abs() <= deep || to.abs() <= deep {
            return None;
        }
        let x = p.lerp(&q, from / (from - to));
        let inside = |i: usize| {
            let side = corners[(i + 1) % 3] - corners[i];
            n.cross(&side).dot(&(x - corners[i])) > deep * side.norm()
        };
        (0..3).all(inside).then_some(x)
    })
}
