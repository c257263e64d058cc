//! Small geometry of meshes and triangles.

// ANCHOR: geometry
use regrasp_api::{Mesh, Vec3};

/// An edge at which the normal turns by more than this is sharp (rad): 30°.
const SHARP: f64 = std::f64::consts::PI / 6.0;

/// Every facet.
pub(crate) fn facets(mesh: &Mesh) -> impl Iterator<Item = u32> + use<> {
    0..mesh.facets().len() as u32
}

/// The ends of the edges at which the normal turns by more than [`SHARP`].
pub(crate) fn sharp_edges(mesh: &Mesh) -> Vec<[Vec3; 2]> {
    let of_facet = |facet: u32| {
        let corners = mesh.corners(facet);
        let sharp = (0..3).filter(move |&k| mesh.neighbors(facet)[k].bend.abs() > SHARP);
        sharp.map(move |k| [corners[k], corners[(k + 1) % 3]])
    };
    facets(mesh).flat_map(of_facet).collect()
}

/// The point between `a` and `b` closest to `p`.
pub(crate) fn closest_on_segment(a: &Vec3, b: &Vec3, p: &Vec3) -> Vec3 {
    let along = b - a;
    a + along * ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0)
}

/// The point of a triangle closest to `p`: its foot on the plane if that lies inside, else on the nearest
/// side.
pub(crate) fn closest_on_facet(corners: &[Vec3; 3], p: &Vec3) -> Vec3 {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a));
    let inside = |a: &Vec3, b: &Vec3| normal.dot(&(b - a).cross(&(p - a))) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) {
        return p - normal * (normal.dot(&(p - a)) / normal.norm_squared());
    }
    let sides = [(a, b), (b, c), (c, a)].map(|(a, b)| closest_on_segment(a, b, p));
    let far = |q: &&Vec3| (*q - p).norm_squared();
    *sides.iter().min_by(|q, r| far(q).total_cmp(&far(r))).expect("a triangle has three sides")
}
// ANCHOR_END: geometry
