//! How far points are from a surface.

use crate::clearance::MeshSolid;
use regrasp_api::{Mesh, Vec3};

/// The distance of each point from the surface of `mesh` (m); negative inside.
///
/// Cost: a microsecond or two for a point near the surface.
pub fn signed_distances(mesh: &Mesh, points: &[Vec3]) -> Vec<f64> {
    let solid = MeshSolid::new(mesh);
    // What is likely; farther points cost more, and are as exact.
    let near = 0.05 * mesh.radius();
    points.iter().map(|p| solid.signed_distance_within(p, near)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive_mesh;
    use regrasp_api::Primitive;

    #[test]
    fn points_about_a_box_are_as_far_as_they_are() {
        let half_size = Vec3::new(0.01, 0.02, 0.03);
        let mesh = primitive_mesh(&Primitive::Cuboid { half_size }, 12).unwrap();
        let points = [[0.0; 3], [0.0, 0.0, 0.031], [0.013, 0.024, 0.0], [0.0, 0.019, 0.0], [1.01, 0.0, 0.0]];
        let expected = [-0.01, 0.001, 0.005, -0.001, 1.0];
        let found = signed_distances(&mesh, &points.map(Vec3::from));
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
    }
}
