//! What a mesh is, in figures: for a user to see whether it was understood.

use crate::bodies::body_count;
use parry3d_f64::math::Vector;
use parry3d_f64::query::{Ray, RayCast};
use parry3d_f64::shape::TriMesh;
use regrasp_api::{Mesh, Vec3};

/// Edges at which the surface turns by more than this (rad) are sharp, as for the surface plugins by default.
const SHARP: f64 = std::f64::consts::PI / 6.0;
/// About how many places are looked at for the thinnest wall.
const PLACES: usize = 4000;

/// Figures of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Measures {
    /// Lowest coordinates (m).
    pub lower: Vec3,
    /// Highest coordinates (m).
    pub upper: Vec3,
    /// Connected surfaces: bodies and hollows.
    pub surfaces: usize,
    /// Handles: 0 for a ball, 1 for a ring or a mug; all surfaces together.
    pub genus: i64,
    /// Number of edges at which the surface turns by more than 30°.
    pub sharp_edges: usize,
    /// Their length together (m).
    pub sharp_length: f64,
    /// The thinnest wall found (m) and where; looked for at about four thousand places.
    pub thinnest: Option<(f64, Vec3)>,
}

/// Measures a mesh.
pub fn measure(mesh: &Mesh) -> Measures {
    let (mut lower, mut upper) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    for vertex in mesh.vertices() {
        (lower, upper) = (lower.inf(vertex), upper.sup(vertex));
    }
    let surfaces = body_count(mesh);
    let used = used_vertices(mesh) as i64;
    let (sharp_edges, sharp_length) = sharp(mesh);
    Measures {
        lower,
        upper,
        surfaces,
        // Euler: V - E + F = 2 - 2 g for each surface, and E = 3 F / 2.
        genus: surfaces as i64 - (used - mesh.facets().len() as i64 / 2) / 2,
        sharp_edges,
        sharp_length,
        thinnest: thinnest(mesh),
    }
}

fn used_vertices(mesh: &Mesh) -> usize {
    let mut used = vec![false; mesh.vertices().len()];
    mesh.facets().iter().flatten().for_each(|&vertex| used[vertex as usize] = true);
    used.into_iter().filter(|&used| used).count()
}

fn sharp(mesh: &Mesh) -> (usize, f64) {
    let (mut count, mut length) = (0, 0.0);
    for facet in 0..mesh.facets().len() as u32 {
        let corners = mesh.corners(facet);
        for (k, neighbor) in mesh.neighbors(facet).iter().enumerate() {
            if neighbor.facet > facet && neighbor.bend.abs() > SHARP {
                count += 1;
                length += (corners[(k + 1) % 3] - corners[k]).norm();
            }
        }
    }
    (count, length)
}

/// The shortest way straight in from a facet's middle to the other side.
fn thinnest(mesh: &Mesh) -> Option<(f64, Vec3)> {
    let glam = |v: &Vec3| Vector::new(v.x, v.y, v.z);
    let surface = TriMesh::new(mesh.vertices().iter().map(glam).collect(), mesh.facets().to_vec()).ok()?;
    let inset = 1e-9 * mesh.radius();
    let step = mesh.facets().len().div_ceil(PLACES);
    let wall = |facet: u32| {
        let [a, b, c] = mesh.corners(facet);
        let (middle, n) = ((a + b + c) / 3.0, mesh.normal(facet));
        let ray = Ray::new(glam(&(middle - n * inset)), glam(&-n));
        let way = surface.cast_local_ray(&ray, f64::MAX, false)?;
        Some((way + inset, middle))
    };
    (0..mesh.facets().len() as u32).step_by(step).filter_map(wall).min_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive_mesh;
    use regrasp_api::Primitive;

    #[test]
    fn a_box_a_ring_and_a_ball_are_measured() {
        let cuboid =
            primitive_mesh(&Primitive::Cuboid { half_size: Vec3::new(0.01, 0.02, 0.003) }, 12).unwrap();
        let measures = measure(&cuboid);
        assert_eq!((measures.surfaces, measures.genus, measures.sharp_edges), (1, 0, 12));
        assert!((measures.sharp_length - 4.0 * 0.066).abs() < 1e-12);
        assert!((measures.thinnest.unwrap().0 - 0.006).abs() < 1e-9);
        assert!((measures.upper - measures.lower - Vec3::new(0.02, 0.04, 0.006)).norm() < 1e-12);
        let ring = Primitive::Torus { ring_radius: 0.03, tube_radius: 0.01 };
        let measures = measure(&primitive_mesh(&ring, 1280).unwrap());
        assert_eq!((measures.surfaces, measures.genus, measures.sharp_edges), (1, 1, 0));
        assert!((measures.thinnest.unwrap().0 - 0.02).abs() < 1e-3);
    }
}
