//! Closest points and signed distances in closed form; those over all facets are the audit's.

use regrasp_api::{Mesh, Primitive, Vec3};
pub use regrasp_audit::{Closest, closest_on_facet, closest_on_mesh, closest_on_segment};

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

/// The closest point of an ellipsoid: x_i = a_i² p_i / (t + a_i²) with the largest root t of the condition
/// that it lies on the surface (Eberly, "Distance from a point to an ellipse, an ellipsoid, or a
/// hyperellipsoid", 2013), by bisection.
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

/// The facets that hold a point.
pub(super) fn facets_at(mesh: &Mesh, p: &Vec3) -> Vec<u32> {
    let near = |&facet: &u32| (closest_on_facet(mesh, facet, p) - p).norm() < 1e-9;
    (0..mesh.facets().len() as u32).filter(near).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Mesh;
    use regrasp_world::primitive_mesh;

    /// Whether the facets' solid angles add up to a full sphere (Van Oosterom & Strackee, "The solid angle of
    /// a plane triangle", IEEE Trans. Biomed. Eng. 1983).
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
