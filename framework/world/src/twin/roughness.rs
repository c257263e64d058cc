//! How rough a mesh is at the scale of a fingertip.

use crate::clearance::MeshSolid;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::Segment;
use regrasp_api::{Mesh, Vec3};

/// A concave edge that bends by less (rad) than this lets the contact of a 10 mm ball jump by less than the
/// rolling allows.
const FLAT: f64 = 1e-3;
/// A place is rough if a concave edge is nearer to it than this many radii.
const NEAR: f64 = 0.25;
/// About how many places are looked at.
const PLACES: f64 = 1500.0;

/// The share of the places where a ball of a radius (m) can touch that lie within a quarter of the radius
/// from a concave edge: from there the ball cannot roll on.
pub fn roughness(mesh: &Mesh, radius: f64) -> f64 {
    let edges = concave_edges(mesh);
    if edges.is_empty() {
        return 0.0;
    }
    let solid = MeshSolid::new(mesh);
    let boxes =
        edges.iter().enumerate().map(|(i, edge)| (i, Aabb::new(edge.a.min(edge.b), edge.a.max(edge.b))));
    let tree = Bvh::from_iter(BvhBuildStrategy::Binned, boxes);
    let area: f64 = (0..mesh.facets().len() as u32).map(|facet| mesh.area(facet)).sum();
    let (mut touched, mut rough) = (0.0, 0.0);
    let mut visit = |p: &Vec3, n: &Vec3, weight: f64| {
        let center = p + n * radius;
        if solid.signed_distance_within(&center, 1.01 * radius) < radius - 1e-6 {
            return;
        }
        touched += weight;
        let p = Vector::new(p.x, p.y, p.z);
        let reach = Vector::splat(NEAR * radius);
        let around = Aabb::new(p - reach, p + reach);
        let near = |edge: u32| edges[edge as usize].distance_to_local_point(p, true) < NEAR * radius;
        if tree.intersect_aabb(&around).any(near) {
            rough += weight;
        }
    };
    sampled(mesh, area, &mut visit);
    if touched > 0.0 { rough / touched } else { 1.0 }
}

/// Calls `visit` with about [`PLACES`] points of the facets, their normals and the area (m²) that each stands
/// for.
fn sampled(mesh: &Mesh, area: f64, visit: &mut dyn FnMut(&Vec3, &Vec3, f64)) {
    let share = area / PLACES;
    let mut rest = 0.0;
    for facet in 0..mesh.facets().len() as u32 {
        rest += mesh.area(facet);
        if rest < share {
            continue;
        }
        let count = (rest / share).floor();
        rest -= count * share;
        let [a, b, c] = mesh.corners(facet);
        // Points of a sequence that fills a square evenly (Roberts, "The unreasonable effectiveness of
        // quasirandom sequences", 2018), folded.
        for i in 0..count as usize {
            let (mut u, mut v) =
                ((0.5 + i as f64 * 0.754_877_666).fract(), (0.5 + i as f64 * 0.569_840_29).fract());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            visit(&(a + (b - a) * u + (c - a) * v), &mesh.normal(facet), share);
        }
    }
}

fn concave_edges(mesh: &Mesh) -> Vec<Segment> {
    let mut edges = Vec::new();
    for facet in 0..mesh.facets().len() as u32 {
        let corners = mesh.corners(facet);
        for (k, neighbor) in mesh.neighbors(facet).iter().enumerate() {
            if neighbor.bend < -FLAT && neighbor.facet > facet {
                let [a, b] = [corners[k], corners[(k + 1) % 3]].map(|v| Vector::new(v.x, v.y, v.z));
                edges.push(Segment::new(a, b));
            }
        }
    }
    edges
}
