//! Closest points of a mesh, by brute force over all facets: the truth that answers are held against.

use regrasp_api::{Mesh, Vec3};

/// The closest point of a surface, with the facet that holds it, and the signed distance (m; negative
/// inside).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The facet; 0 for closed forms.
    pub facet: u32,
    /// The point (m).
    pub point: Vec3,
    /// The signed distance (m).
    pub distance: f64,
}

/// The closest point of the mesh to `p` (m, in the mesh's frame), the first of several; the sign by the
/// normals that meet there.
pub fn closest_on_mesh(mesh: &Mesh, p: &Vec3) -> Closest {
    let mut best = Closest { facet: 0, point: Vec3::zeros(), distance: f64::INFINITY };
    for facet in 0..mesh.facets().len() as u32 {
        if plane_distance(mesh, facet, p) < best.distance {
            let point = closest_on_facet(mesh, facet, p);
            let distance = (point - p).norm();
            if distance < best.distance {
                best = Closest { facet, point, distance };
            }
        }
    }
    if (p - best.point).dot(&pseudonormal(mesh, &best.point)) < 0.0 {
        best.distance = -best.distance;
    }
    best
}

/// The distance (m) of a point from a facet's plane.
fn plane_distance(mesh: &Mesh, facet: u32, p: &Vec3) -> f64 {
    let corner = mesh.vertices()[mesh.facets()[facet as usize][0] as usize];
    mesh.normal(facet).dot(&(p - corner)).abs()
}

/// The normals of the facets that meet at a point of the surface, weighted with their angles there: its sign
/// tells inside from outside (Bærentzen & Aanæs, "Signed distance computation using the angle weighted
/// pseudonormal", IEEE TVCG 2005).
fn pseudonormal(mesh: &Mesh, point: &Vec3) -> Vec3 {
    let mut sum = Vec3::zeros();
    for facet in 0..mesh.facets().len() as u32 {
        let near = plane_distance(mesh, facet, point) < SAME;
        if !near || (closest_on_facet(mesh, facet, point) - point).norm() > SAME {
            continue;
        }
        let corners = mesh.corners(facet);
        let angle = match corners.iter().position(|corner| (corner - point).norm() < SAME) {
            Some(k) => (corners[(k + 1) % 3] - corners[k]).angle(&(corners[(k + 2) % 3] - corners[k])),
            None => std::f64::consts::PI,
        };
        sum += mesh.normal(facet) * angle;
    }
    sum
}

/// Points closer than this (m) are one.
const SAME: f64 = 1e-10;

/// The closest point (m) of a facet to `p`: the foot on its plane if it lies inside, otherwise the best of
/// the three edges' points.
pub fn closest_on_facet(mesh: &Mesh, facet: u32, p: &Vec3) -> Vec3 {
    let (corners, n) = (mesh.corners(facet), mesh.normal(facet));
    let foot = p - n * n.dot(&(p - corners[0]));
    let edges = [0, 1, 2].map(|k| (corners[k], corners[(k + 1) % 3]));
    if edges.iter().all(|(a, b)| (b - a).cross(&(foot - a)).dot(&n) >= 0.0) {
        return foot;
    }
    let [x, y, z] = edges.map(|(a, b)| closest_on_segment(&a, &b, p));
    let nearer = |a: Vec3, b: Vec3| if (a - p).norm_squared() <= (b - p).norm_squared() { a } else { b };
    nearer(nearer(x, y), z)
}

/// The closest point (m) to `p` of the segment from `a` to `b`.
pub fn closest_on_segment(a: &Vec3, b: &Vec3, p: &Vec3) -> Vec3 {
    let along = b - a;
    a + along * ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0)
}
