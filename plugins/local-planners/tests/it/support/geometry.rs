//! Distances by brute force, independent of the surface plugin.

use regrasp_api::{Mesh, Pose, Vec3};

pub fn to_hand(X_HO: &Pose, p_O: &Vec3) -> Vec3 {
    X_HO.rotation * p_O + X_HO.translation.vector
}

pub fn to_object(X_HO: &Pose, p_H: &Vec3) -> Vec3 {
    X_HO.rotation.inverse() * (p_H - X_HO.translation.vector)
}

/// The closest point of the mesh, over all facets.
pub fn closest(mesh: &Mesh, p: &Vec3) -> Vec3 {
    (0..mesh.facets().len() as u32)
        .map(|facet| on_facet(mesh, facet, p))
        .min_by(|a, b| (a - p).norm_squared().total_cmp(&(b - p).norm_squared()))
        .unwrap()
}

/// The foot on the facet's plane if it lies inside, otherwise the best of the three edges' points.
fn on_facet(mesh: &Mesh, facet: u32, p: &Vec3) -> Vec3 {
    let (corners, n) = (mesh.corners(facet), mesh.normal(facet));
    let foot = p - n * n.dot(&(p - corners[0]));
    let edges = [0, 1, 2].map(|k| (corners[k], corners[(k + 1) % 3]));
    if edges.iter().all(|(a, b)| (b - a).cross(&(foot - a)).dot(&n) >= 0.0) {
        return foot;
    }
    edges
        .iter()
        .map(|(a, b)| a + (b - a) * ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0))
        .min_by(|a, b| (a - p).norm_squared().total_cmp(&(b - p).norm_squared()))
        .unwrap()
}
