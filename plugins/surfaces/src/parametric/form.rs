//! The primitives as exact surfaces.

use super::cuboid::Cuboid;
use super::curve::{Curve, Form};
use super::smooth::{Ellipsoid, Geodesics, Torus};
use super::sphere::Sphere;
use super::tube::{Cap, Tube};
use regrasp_api::{Primitive, Vec3};

/// One of the primitives as an exact surface: normals, shortest paths and straight walks.
#[derive(Debug)]
pub struct ClosedForm(Box<dyn Form>);

impl ClosedForm {
    /// The surface of a primitive.
    pub fn new(primitive: &Primitive) -> Self {
        Self(match *primitive {
            Primitive::Sphere { radius } => Box::new(Sphere { radius }),
            Primitive::Cuboid { half_size } => Box::new(Cuboid { half: half_size }),
            Primitive::Cylinder { radius, half_height } => {
                Box::new(Tube { radius, half_height, cap: Cap::Flat })
            }
            Primitive::Capsule { radius, half_height } => {
                Box::new(Tube { radius, half_height, cap: Cap::Round })
            }
            Primitive::Ellipsoid { semi_axes } => Box::new(Geodesics(Ellipsoid { semi_axes })),
            Primitive::Torus { ring_radius, tube_radius } => {
                Box::new(Geodesics(Torus { ring: ring_radius, tube: tube_radius }))
            }
        })
    }

    /// The point (m) of the surface that stands for one near it: along the ray from the centre or the axis.
    pub fn outward(&self, p: &Vec3) -> Vec3 {
        self.0.outward(p)
    }

    /// Where the ray begins that leads through a point of the surface to the facets.
    pub(super) fn core(&self, p: &Vec3) -> Vec3 {
        self.0.core(p)
    }

    /// The outward unit normal at a point of the surface; on an edge that of one of its faces.
    pub fn normal(&self, p: &Vec3) -> Vec3 {
        self.0.normal(p)
    }

    /// The shortest path between two points of the surface, with points at most `spacing` (m) apart.
    ///
    /// The same from `b` to `a`, backwards and bit for bit.
    pub fn shortest(&self, a: &Vec3, b: &Vec3, spacing: f64, curve: &mut Curve) {
        let is_before = a.iter().zip(b).map(|(x, y)| x.total_cmp(y)).find(|order| order.is_ne());
        let (first, last) = if is_before == Some(std::cmp::Ordering::Greater) { (b, a) } else { (a, b) };
        self.0.shortest(first, last, spacing, curve);
        if first != a {
            curve.points.reverse();
        }
    }

    /// The straightest path from a point of the surface along the tangential part of a direction, of the
    /// given length (m).
    pub fn walk(&self, from: &Vec3, direction: &Vec3, distance: f64, spacing: f64, curve: &mut Curve) {
        curve.restart(from);
        if direction.norm() > 0.0 && distance > 0.0 {
            self.0.walk(from, direction, distance, spacing, curve);
        }
    }
}
