//! Convex hulls and convex pieces of meshes, by parry3d.

use parry3d_f64::math::Vector;
use parry3d_f64::transformation::try_convex_hull;
use parry3d_f64::transformation::vhacd::{VHACD, VHACDParameters};
use regrasp_api::{Mesh, Vec3};

/// Points are rounded to multiples of this (m) first: what is nearly in one plane makes slivers.
const GRID: f64 = 1e-6;

/// The convex hull; `None` where the points have no volume.
pub fn convex_hull(points: &[Vec3]) -> Option<Mesh> {
    let mut rounded: Vec<[i64; 3]> =
        points.iter().map(|p| (p / GRID).map(|x| x.round() as i64).into()).collect();
    rounded.sort_unstable();
    rounded.dedup();
    let points: Vec<Vector> = rounded
        .iter()
        .map(|p| Vector::new(p[0] as f64 * GRID, p[1] as f64 * GRID, p[2] as f64 * GRID))
        .collect();
    let (vertices, facets) = try_convex_hull(&points).ok()?;
    Mesh::new(vertices.iter().map(|v| Vec3::new(v.x, v.y, v.z)).collect(), facets).ok()
}

/// Approximate convex pieces of a mesh, at most `most` (K. Mamou, "Volumetric hierarchical approximate convex decomposition", in Game Engine
/// Gems 3, 2016).
pub fn convex_pieces(vertices: &[Vec3], facets: &[[u32; 3]], most: usize) -> Vec<Mesh> {
    let points: Vec<Vector> = vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
    let parameters = VHACDParameters { max_convex_hulls: most as u32, ..Default::default() };
    let parts = VHACD::decompose(&parameters, &points, facets, true);
    let hulls = parts.compute_exact_convex_hulls(&points, facets);
    let corners = |vertices: &[Vector]| vertices.iter().map(|v| Vec3::new(v.x, v.y, v.z)).collect::<Vec<_>>();
    hulls.iter().filter_map(|(vertices, _)| convex_hull(&corners(vertices))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Vec<Vec3> {
        (0..8).map(|i| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 0.02).collect()
    }

    #[test]
    fn the_hull_of_a_cube_with_points_inside_and_on_it_is_the_cube() {
        let mut points = cube();
        points.extend([Vec3::repeat(0.01), Vec3::new(0.01, 0.01, 0.0), Vec3::new(0.02, 0.01, 0.01)]);
        points.extend(cube());
        let mesh = convex_hull(&points).unwrap();
        let volume: f64 = mesh.mass_properties().volume;
        assert!((volume - 8e-6).abs() < 1e-12, "{volume}");
        assert!(mesh.is_locally_convex());
    }

    #[test]
    fn points_without_volume_have_no_hull() {
        let flat: Vec<Vec3> = cube().into_iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect();
        assert!(convex_hull(&flat).is_none());
        assert!(convex_hull(&flat[..2]).is_none() && convex_hull(&[]).is_none());
    }

    #[test]
    fn an_angle_iron_comes_apart_in_pieces_that_leave_its_corner_free() {
        let bar = |size: Vec3, center: Vec3| {
            let mesh =
                crate::primitive_mesh(&regrasp_api::Primitive::Cuboid { half_size: size / 2.0 }, 12).unwrap();
            (mesh.vertices().iter().map(|v| v + center).collect::<Vec<_>>(), mesh.facets().to_vec())
        };
        let (mut vertices, mut facets) = bar(Vec3::new(0.06, 0.01, 0.01), Vec3::new(0.03, 0.0, 0.0));
        let (more, others) = bar(Vec3::new(0.01, 0.06, 0.01), Vec3::new(0.0, 0.03, 0.0));
        facets.extend(others.iter().map(|facet| facet.map(|v| v + vertices.len() as u32)));
        vertices.extend(more);
        let volume = |meshes: &[Mesh]| meshes.iter().map(|mesh| mesh.mass_properties().volume).sum::<f64>();
        let whole = [convex_hull(&vertices).unwrap()];
        let parts = convex_pieces(&vertices, &facets, 8);
        assert!(parts.len() >= 2 && volume(&parts) < 0.7 * volume(&whole), "{} pieces", parts.len());
    }
}
