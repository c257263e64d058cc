//! Every kind of shape, and what each is in closed form.

use super::MeshSource;
use crate::{Pose, Primitive, Rotation, Vec3};
use nalgebra::Unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A shape of a link, the palm or an obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    /// A ball about the origin.
    Sphere {
        /// Radius (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        radius: f64,
    },
    /// A box about the origin, along the axes.
    Box {
        /// Edge lengths (m).
        #[schemars(inner(range(min = 1e-6, max = 1e3)), extend("x-unit" = "m"))]
        size: [f64; 3],
    },
    /// All points within `radius` of a segment.
    Capsule {
        /// One end of the segment (m).
        #[schemars(inner(range(min = -1e3, max = 1e3)), extend("x-unit" = "m"))]
        from: [f64; 3],
        /// The other end (m).
        #[schemars(inner(range(min = -1e3, max = 1e3)), extend("x-unit" = "m"))]
        to: [f64; 3],
        /// Radius (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        radius: f64,
    },
    /// A cylinder about the origin, along z.
    Cylinder {
        /// Radius (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        #[schemars(example = 0.008)]
        radius: f64,
        /// Length along z (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        #[schemars(example = 0.12)]
        height: f64,
    },
    /// Everything with `normal · x ≤ offset`.
    HalfSpace {
        /// Outward normal (a direction, of any length).
        #[schemars(extend("examples" = [[0.0, 0.0, 1.0]]))]
        #[schemars(extend("x-unit" = "1"))]
        normal: [f64; 3],
        /// Distance of the plane from the origin along the normal (m).
        #[schemars(range(min = -1e3, max = 1e3), extend("x-unit" = "m"))]
        #[schemars(example = 0.0)]
        offset: f64,
    },
    /// A closed mesh.
    Mesh(MeshSource),
}

/// The shape of the object: a primitive, turned into a closed mesh about the origin, or a mesh.
///
/// `facets` is the wished number of facets; the mesh has the nearest number that the shape's pattern allows.
/// The planner and the verifier take the facets as the true surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum ObjectShape {
    /// A ball.
    Sphere {
        /// Radius (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        radius: f64,
        /// Wished number of facets.
        #[serde(default = "default_facets")]
        #[schemars(range(min = 12, max = 2_000_000))]
        facets: usize,
    },
    /// An ellipsoid along the axes.
    Ellipsoid {
        /// Half the length along x, y and z (m).
        #[schemars(inner(range(min = 1e-6, max = 1e3)), extend("x-unit" = "m"))]
        semi_axes: [f64; 3],
        /// Wished number of facets.
        #[serde(default = "default_facets")]
        #[schemars(range(min = 12, max = 2_000_000))]
        facets: usize,
    },
    /// A box along the axes: 12 facets.
    Cuboid {
        /// Edge lengths (m).
        #[schemars(inner(range(min = 1e-6, max = 1e3)), extend("x-unit" = "m"))]
        size: [f64; 3],
    },
    /// A cylinder along z.
    Cylinder {
        /// Radius (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        radius: f64,
        /// Length along z (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        height: f64,
        /// Wished number of facets.
        #[serde(default = "default_facets")]
        #[schemars(range(min = 12, max = 2_000_000))]
        facets: usize,
    },
    /// A cylinder along z with half balls at its ends.
    Capsule {
        /// Radius (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        #[schemars(example = 0.02)]
        radius: f64,
        /// Length of the cylindrical part along z (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        #[schemars(example = 0.04)]
        height: f64,
        /// Wished number of facets.
        #[serde(default = "default_facets")]
        #[schemars(range(min = 12, max = 2_000_000))]
        facets: usize,
    },
    /// A ring about z.
    Torus {
        /// Distance of the tube's centre from the z axis (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        ring_radius: f64,
        /// Radius of the tube (m).
        #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "m"))]
        tube_radius: f64,
        /// Wished number of facets.
        #[serde(default = "default_facets")]
        #[schemars(range(min = 12, max = 2_000_000))]
        facets: usize,
    },
    /// A mesh.
    Mesh(MeshSource),
}

fn default_facets() -> usize {
    1280
}

/// What a shape is, whatever files call it: the one list of kinds that readers of shapes go by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form<'a> {
    /// A solid in closed form, and the pose of its frame in the shape's.
    Primitive(Primitive, Pose),
    /// Everything with `normal · x ≤ offset` (m); the normal has length 1, or is not a number where the
    /// description's is zero.
    HalfSpace {
        /// Outward normal.
        normal: Vec3,
        /// Distance of the plane from the origin along the normal.
        offset: f64,
    },
    /// A closed mesh.
    Mesh(&'a MeshSource),
}

impl Shape {
    /// What the shape is.
    pub fn form(&self) -> Form<'_> {
        let here = |primitive| Form::Primitive(primitive, Pose::identity());
        match self {
            Self::Sphere { radius } => here(Primitive::Sphere { radius: *radius }),
            Self::Box { size } => here(Primitive::Cuboid { half_size: Vec3::from(*size) / 2.0 }),
            Self::Cylinder { radius, height } => {
                here(Primitive::Cylinder { radius: *radius, half_height: height / 2.0 })
            }
            Self::Capsule { from, to, radius } => capsule(&Vec3::from(*from), &Vec3::from(*to), *radius),
            Self::HalfSpace { normal, offset } => {
                Form::HalfSpace { normal: Vec3::from(*normal).normalize(), offset: *offset }
            }
            Self::Mesh(source) => Form::Mesh(source),
        }
    }
}

impl ObjectShape {
    /// The solid in closed form and the wished number of its facets, or the mesh.
    pub fn primitive(&self) -> Result<(Primitive, usize), &MeshSource> {
        Ok(match *self {
            Self::Sphere { radius, facets } => (Primitive::Sphere { radius }, facets),
            Self::Ellipsoid { semi_axes, facets } => {
                (Primitive::Ellipsoid { semi_axes: semi_axes.into() }, facets)
            }
            Self::Cuboid { size } => (Primitive::Cuboid { half_size: Vec3::from(size) / 2.0 }, 12),
            Self::Cylinder { radius, height, facets } => {
                (Primitive::Cylinder { radius, half_height: height / 2.0 }, facets)
            }
            Self::Capsule { radius, height, facets } => {
                (Primitive::Capsule { radius, half_height: height / 2.0 }, facets)
            }
            Self::Torus { ring_radius, tube_radius, facets } => {
                (Primitive::Torus { ring_radius, tube_radius }, facets)
            }
            Self::Mesh(ref source) => return Err(source),
        })
    }
}

fn capsule(from: &Vec3, to: &Vec3, radius: f64) -> Form<'static> {
    let length = (to - from).norm();
    // Below a nanometre there is no direction to speak of.
    if length < 1e-9 {
        let X = Pose::translation(from.x, from.y, from.z);
        return Form::Primitive(Primitive::Sphere { radius }, X);
    }
    let X = along((from + to) / 2.0, &((to - from) / length));
    Form::Primitive(Primitive::Capsule { radius, half_height: length / 2.0 }, X)
}

/// The pose at `p` whose z axis is the unit vector `axis`.
pub fn along(p: Vec3, axis: &Vec3) -> Pose {
    let turn = Rotation::rotation_between_axis(&Vec3::z_axis(), &Unit::new_unchecked(*axis));
    // Opposite directions have no shortest turn: any half turn about a horizontal axis will do.
    let turn = turn.unwrap_or_else(|| Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI));
    Pose::from_parts(p.into(), turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn capsules_keep_their_ends() {
        for to in [Vec3::new(0.0, 0.0, -0.05), Vec3::new(0.03, 0.0, 0.04), Vec3::new(0.0, 0.0, 0.05)] {
            let shape = Shape::Capsule { from: [0.0; 3], to: to.into(), radius: 0.01 };
            let Form::Primitive(Primitive::Capsule { half_height, .. }, X) = shape.form() else {
                panic!("a capsule")
            };
            let end = X * nalgebra::Point3::new(0.0, 0.0, half_height);
            assert!((end.coords - to).norm() < 1e-12, "{to:?}");
        }
        let ball = Shape::Capsule { from: [1.0, 0.0, 0.0], to: [1.0, 0.0, 0.0], radius: 0.01 };
        assert!(matches!(ball.form(), Form::Primitive(Primitive::Sphere { .. }, _)));
    }
}
