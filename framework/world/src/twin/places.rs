//! Where a ball can touch a surface: on facets, over convex edges and vertices, and in dents on both sides.

use regrasp_api::{Mesh, Vec3, tangents};

/// Calls `visit` with points and normals on a facet and its sides at which a ball of a radius (m) may touch a
/// surface, no farther apart than `spacing` (m). With [`on_vertices`] they are all over it.
pub(super) fn of_facet(
    mesh: &Mesh,
    facet: u32,
    (radius, spacing): (f64, f64),
    visit: &mut dyn FnMut(u32, &Vec3, &Vec3),
) {
    let n = mesh.normal(facet);
    on_facet(mesh.corners(facet), spacing, |p| visit(facet, p, &n));
    for (side, neighbor) in mesh.neighbors(facet).iter().enumerate() {
        if neighbor.bend < 0.0 {
            in_dent(mesh, (facet, side), radius, spacing, visit);
        } else if neighbor.bend > 0.0 && neighbor.facet > facet {
            let middle = (n + mesh.normal(neighbor.facet)).normalize();
            along(mesh, (facet, side), spacing, |p| visit(facet, p, &middle));
        }
    }
}

/// Points all over a triangle: the middles of the triangles into which it falls.
pub(super) fn on_facet([a, b, c]: [Vec3; 3], spacing: f64, mut visit: impl FnMut(&Vec3)) {
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    let n = (longest / spacing).ceil().clamp(1.0, 1000.0) as usize;
    let at = |i: f64, j: f64| a + (b - a) * (i / n as f64) + (c - a) * (j / n as f64);
    for i in 0..n {
        for j in 0..n - i {
            let (x, y) = (i as f64, j as f64);
            visit(&at(x + 1.0 / 3.0, y + 1.0 / 3.0));
            if j + 1 < n - i {
                visit(&at(x + 2.0 / 3.0, y + 2.0 / 3.0));
            }
        }
    }
}

/// Points of a facet in the square of a size (m) round one of its points, `spacing` (m) apart, with the
/// facet's normal.
pub(super) fn round_place(
    mesh: &Mesh,
    (facet, p): (u32, &Vec3),
    (size, spacing): (f64, f64),
    visit: &mut dyn FnMut(&Vec3, &Vec3),
) {
    let (corners, n) = (mesh.corners(facet), mesh.normal(facet));
    let [x, y] = tangents(&n).map(|tangent| tangent * spacing);
    let each = (size / (2.0 * spacing)).ceil() as i32;
    for i in -each..=each {
        for j in -each..=each {
            let p = p + x * f64::from(i) + y * f64::from(j);
            if is_on(corners, &n, &p) {
                visit(&p, &n);
            }
        }
    }
}

/// Whether a point of a triangle's plane is on the triangle.
fn is_on(corners: [Vec3; 3], n: &Vec3, p: &Vec3) -> bool {
    (0..3).all(|k| n.dot(&(corners[(k + 1) % 3] - corners[k]).cross(&(p - corners[k]))) >= 0.0)
}

/// Points along a side of a facet.
fn along(mesh: &Mesh, (facet, side): (u32, usize), spacing: f64, mut visit: impl FnMut(&Vec3)) {
    let corners = mesh.corners(facet);
    let (from, to) = (corners[side], corners[(side + 1) % 3]);
    let pieces = ((to - from).norm() / spacing).ceil().max(1.0) as usize;
    for piece in 0..pieces {
        visit(&from.lerp(&to, (piece as f64 + 0.5) / pieces as f64));
    }
}

/// Where a ball in the dent at a facet's side touches the facet, as far as that is on it: there it lies
/// deepest.
fn in_dent(
    mesh: &Mesh,
    (facet, side): (u32, usize),
    radius: f64,
    spacing: f64,
    visit: &mut dyn FnMut(u32, &Vec3, &Vec3),
) {
    let (corners, n) = (mesh.corners(facet), mesh.normal(facet));
    let inward = n.cross(&(corners[(side + 1) % 3] - corners[side])).normalize();
    let off = inward * (radius * (0.5 * mesh.neighbors(facet)[side].bend).tan().abs());
    along(mesh, (facet, side), 0.5 * spacing, |p| {
        let p = p + off;
        if is_on(corners, &n, &p) {
            visit(facet, &p, &n);
        }
    });
}

/// The vertices with the mean normals there; not where a concave edge ends: there the ball touches elsewhere.
pub(super) fn on_vertices(mesh: &Mesh, visit: &mut dyn FnMut(u32, &Vec3, &Vec3)) {
    let mut around = vec![Some((0, Vec3::zeros())); mesh.vertices().len()];
    for facet in 0..mesh.facets().len() as u32 {
        let (corners, vertices) = (mesh.corners(facet), mesh.facets()[facet as usize]);
        for (k, neighbor) in mesh.neighbors(facet).iter().enumerate() {
            let (vertex, end) = (vertices[k] as usize, vertices[(k + 1) % 3] as usize);
            if neighbor.bend < 0.0 {
                (around[vertex], around[end]) = (None, None);
            }
            let more = mesh.normal(facet) * corner_angle(corners, k);
            around[vertex] = around[vertex].map(|(_, sum)| (facet, sum + more));
        }
    }
    for (p, around) in mesh.vertices().iter().zip(around) {
        let Some((facet, sum)) = around else { continue };
        if let Some(n) = sum.try_normalize(1e-9) {
            visit(facet, p, &n);
        }
    }
}

fn corner_angle(corners: [Vec3; 3], k: usize) -> f64 {
    let (u, v) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
    u.cross(&v).norm().atan2(u.dot(&v))
}
