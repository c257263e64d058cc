//! Closest points and signed distances by brute force: over all facets, or in closed form.

use regrasp_api::{Mesh, Primitive, Vec3};

/// The closest point of a surface, with the facet that holds it, and the signed distance (m; negative inside).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The facet; 0 for closed forms.
    pub facet: u32,
    /// The point (m).
    pub point: Vec3,
    /// The signed distance (m).
    pub distance: f64,
}

/// The closest point of the mesh to `p` (m, in the mesh's frame), the first of several; the sign by the normals that meet there.
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

/// The normals of the facets that meet at a point of the surface, weighted with their angles there: its sign tells inside from outside
/// (Bærentzen & Aanæs, "Signed distance computation using the angle weighted pseudonormal", IEEE TVCG 2005).
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

/// The closest point (m) of a facet to `p`: the foot on its plane if it lies inside, otherwise the best of the three edges' points.
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

/// The closest point of the closed form to `p` (m, in its frame).
pub fn closest_on_primitive(primitive: &Primitive, p: &Vec3) -> Closest {
    let (point, inside) = match *primitive {
        Primitive::Sphere { radius } => (along(p) * radius, p.norm() < radius),
        Primitive::Ellipsoid { semi_axes } => {
            let inside = p.component_div(&semi_axes).norm() < 1.0;
            (on_ellipsoid(&semi_axes, p), inside)
        }
        Primitive::Cuboid { half_size } => on_cuboid(&half_size, p),
        Primitive::Cylinder { radius, half_height } => {
            let rho = p.xy().norm();
            let (flat, inside) =
                on_cuboid(&Vec3::new(radius, f64::INFINITY, half_height), &Vec3::new(rho, 0.0, p.z));
            (around_z(p, flat.x, flat.z), inside)
        }
        Primitive::Capsule { radius, half_height } => {
            let axis = Vec3::new(0.0, 0.0, p.z.clamp(-half_height, half_height));
            (axis + along(&(p - axis)) * radius, (p - axis).norm() < radius)
        }
        Primitive::Torus { ring_radius, tube_radius } => {
            let ring = around_z(p, ring_radius, 0.0);
            (ring + along(&(p - ring)) * tube_radius, (p - ring).norm() < tube_radius)
        }
    };
    let distance = (p - point).norm();
    Closest { facet: 0, point, distance: if inside { -distance } else { distance } }
}

fn along(v: &Vec3) -> Vec3 {
    v.try_normalize(0.0).unwrap_or(Vec3::z())
}

/// The point at distance `rho` from the z axis and height `z`, on the side of `p`.
fn around_z(p: &Vec3, rho: f64, z: f64) -> Vec3 {
    let side = along(&Vec3::new(p.x, p.y, 0.0));
    Vec3::new(side.x * rho, side.y * rho, z)
}

fn on_cuboid(half: &Vec3, p: &Vec3) -> (Vec3, bool) {
    let mut point = p.zip_map(half, |x, h| x.clamp(-h, h));
    let inside = (0..3).all(|i| p[i].abs() < half[i]);
    if inside {
        let depth = |i: &usize| half[*i] - p[*i].abs();
        let nearest = (0..3).min_by(|i, j| depth(i).total_cmp(&depth(j))).unwrap_or(0);
        point[nearest] = half[nearest].copysign(p[nearest]);
    }
    (point, inside)
}

/// The closest point of an ellipsoid: x_i = a_i² p_i / (t + a_i²) with the largest root t of the condition that it lies on the surface
/// (Eberly, "Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid", 2013), by bisection.
fn on_ellipsoid(semi_axes: &Vec3, p: &Vec3) -> Vec3 {
    let square = semi_axes.component_mul(semi_axes);
    let at = |t: f64| p.zip_map(&square, |x, a| x * a / (t + a));
    let excess = |t: f64| at(t).component_div(semi_axes).norm_squared() - 1.0;
    let (mut low, mut high) = (-square.min(), square.max().sqrt() * (p.norm() + semi_axes.max()));
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
    at(high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_world::primitive_mesh;

    /// Whether the facets' solid angles add up to a full sphere (Van Oosterom & Strackee, "The solid angle of a plane triangle", IEEE
    /// Trans. Biomed. Eng. 1983).
    fn is_inside(mesh: &Mesh, p: &Vec3) -> bool {
        let angle = |facet: u32| {
            let [a, b, c] = mesh.corners(facet).map(|corner| corner - p);
            let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
            let below = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
            2.0 * a.dot(&b.cross(&c)).atan2(below)
        };
        let sum: f64 = (0..mesh.facets().len() as u32).map(angle).sum();
        sum > std::f64::consts::TAU
    }

    #[test]
    fn signs_are_those_of_the_winding_number() {
        let mut random = crate::law::random(6);
        for primitive in [
            Primitive::Cuboid { half_size: Vec3::new(0.02, 0.03, 0.04) },
            Primitive::Torus { ring_radius: 0.03, tube_radius: 0.01 },
        ] {
            let mesh = primitive_mesh(&primitive, 200).unwrap();
            for _ in 0..500 {
                let p = random.direction() * random.range(0.0, 0.06);
                let found = closest_on_mesh(&mesh, &p);
                assert_eq!(found.distance < 0.0, is_inside(&mesh, &p), "{primitive:?} at {p:?}: {found:?}");
            }
        }
    }

    #[test]
    fn fine_meshes_and_closed_forms_agree() {
        let mut random = crate::law::random(5);
        for primitive in [
            Primitive::Sphere { radius: 0.03 },
            Primitive::Ellipsoid { semi_axes: Vec3::new(0.04, 0.03, 0.025) },
            Primitive::Cuboid { half_size: Vec3::new(0.02, 0.03, 0.04) },
            Primitive::Cylinder { radius: 0.02, half_height: 0.03 },
            Primitive::Capsule { radius: 0.02, half_height: 0.03 },
            Primitive::Torus { ring_radius: 0.04, tube_radius: 0.01 },
        ] {
            let mesh = primitive_mesh(&primitive, 5000).unwrap();
            for _ in 0..40 {
                let p = random.direction() * random.range(0.0, 0.08);
                let (facets, form) = (closest_on_mesh(&mesh, &p), closest_on_primitive(&primitive, &p));
                let error = (facets.distance - form.distance).abs();
                assert!(error < 2e-4, "{primitive:?} at {p:?}: {facets:?} {form:?}");
            }
        }
    }
}
