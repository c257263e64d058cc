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

/// Hulls of at most as many corners stay as they are.
const FEW: usize = 48;
/// The most corners of a coarse hull.
const MANY: usize = 160;

/// The convex hull by few of its corners, and how far (m) the true one stands out of it: at most
/// `tolerance`, unless that takes more than 160 corners. `None` where the points have no volume.
pub fn coarse_hull(points: &[Vec3], tolerance: f64) -> Option<(Mesh, f64)> {
    let whole = convex_hull(&outer(points))?;
    let all = whole.vertices();
    if all.len() <= FEW {
        return Some((whole, 0.0));
    }
    let mut chosen: Vec<Vec3> = extremes(all, 1);
    let mut left = all.to_vec();
    loop {
        let coarse = convex_hull(&chosen)?;
        let planes = planes(&coarse);
        let allowed = tolerance - GRID;
        let depths = left.iter().map(|p| (beyond(&planes, p), *p));
        let mut out: Vec<(f64, Vec3)> = depths.filter(|(depth, _)| *depth > allowed).collect();
        // The hull grows: what is within it stays there, and need not be looked at again.
        left = out.iter().map(|(_, p)| *p).collect();
        out.sort_by(|a, b| b.0.total_cmp(&a.0));
        if out.is_empty() || chosen.len() >= MANY {
            // Of the points as they were given, not as they were rounded.
            let worst = points.iter().map(|p| beyond(&planes, p)).fold(0.0, f64::max);
            return Some((coarse, worst));
        }
        // A few at a time, no two of them close together: one corner takes care of what lies about it.
        let mut added: Vec<Vec3> = Vec::new();
        for (depth, p) in out {
            let apart = 8.0 * depth.max(tolerance);
            if added.iter().all(|other| (other - p).norm() > apart) {
                added.push(p);
            }
            if added.len() == 8 {
                break;
            }
        }
        chosen.extend(added);
    }
}

/// The points that can be corners of the hull: those inside a hull of a few extreme ones are left out.
fn outer(points: &[Vec3]) -> Vec<Vec3> {
    if points.len() < 500 {
        return points.to_vec();
    }
    let Some(inner) = convex_hull(&extremes(points, 2)) else { return points.to_vec() };
    let planes = planes(&inner);
    points.iter().filter(|p| beyond(&planes, p) > -GRID).copied().collect()
}

/// The points that lie farthest in the directions of a cube's surface, a grid of 2 · `half` + 1 points to an
/// edge (26 or 98 in all).
fn extremes(points: &[Vec3], half: i32) -> Vec<Vec3> {
    let steps = || -half..=half;
    let directions = steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| [x, y, z])));
    let on_the_cube = directions.filter(|n: &[i32; 3]| n.iter().any(|x| x.abs() == half));
    let farthest = |n: [i32; 3]| {
        let n = Vec3::from(n.map(f64::from));
        points.iter().copied().max_by(|a, b| a.dot(&n).total_cmp(&b.dot(&n)))
    };
    on_the_cube.filter_map(farthest).collect()
}

/// Unit normals and heights of a mesh's facets.
fn planes(mesh: &Mesh) -> Vec<(Vec3, f64)> {
    let plane = |facet: u32| {
        let n = mesh.normal(facet);
        (n, n.dot(&mesh.corners(facet)[0]))
    };
    (0..mesh.facets().len() as u32).map(plane).collect()
}

/// By how much (m) a point stands out of the planes; negative inside.
fn beyond(planes: &[(Vec3, f64)], p: &Vec3) -> f64 {
    planes.iter().map(|(n, height)| n.dot(p) - height).fold(f64::NEG_INFINITY, f64::max)
}

/// Approximate convex pieces of a mesh, at most `most` (K. Mamou, "Volumetric hierarchical approximate
/// convex decomposition", in Game Engine Gems 3, 2016).
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
    fn a_coarse_hull_stays_within_its_tolerance_and_keeps_the_corners_of_a_box() {
        let ball: Vec<Vec3> = (0..4000)
            .map(|i| {
                let (z, turn) = (1.0 - 2.0 * (f64::from(i) + 0.5) / 4000.0, 2.399_963 * f64::from(i));
                let r = (1.0 - z * z).sqrt();
                Vec3::new(r * turn.cos(), r * turn.sin(), z) * 0.008
            })
            .collect();
        let (coarse, error) = coarse_hull(&ball, 2.5e-4).unwrap();
        assert!(error <= 2.5e-4 && coarse.vertices().len() <= 168, "{error} {}", coarse.vertices().len());
        let planes = planes(&coarse);
        let worst = ball.iter().map(|p| beyond(&planes, p)).fold(0.0, f64::max);
        assert_eq!(worst, error);
        // Where the farthest point stands out by just the tolerance, one more corner ends it.
        let (_, finer) = coarse_hull(&ball, error).unwrap();
        assert!(finer <= error, "{finer}");
        // Where that takes too many corners, the error that is left is told.
        let (coarse, error) = coarse_hull(&ball, 1e-4).unwrap();
        assert!(error > 1e-4 && error < 2.5e-4 && coarse.vertices().len() >= MANY, "{error}");
        let (whole, error) = coarse_hull(&cube(), 1e-4).unwrap();
        assert_eq!((whole.vertices().len(), error), (8, 0.0));
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
