//! Shapes, objects and obstacles.

use super::{ContactSurface, MeshSource, PoseDescription};
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

/// A shape with its place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlacedShape {
    /// The shape.
    pub shape: Shape,
    /// Its pose in the frame of what it belongs to.
    #[serde(default)]
    pub pose: PoseDescription,
}

/// Something fixed to the hand's frame that nothing may touch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObstacleDescription {
    /// What reports call it.
    #[serde(default)]
    pub name: String,
    /// The shape.
    pub shape: Shape,
    /// Its pose in the hand's frame.
    #[serde(default)]
    pub pose: PoseDescription,
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

/// The object that the hand holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObjectDescription {
    /// What reports call it.
    #[serde(default = "default_object_name")]
    pub name: String,
    /// Its shape, in the object's frame O.
    #[schemars(extend("x-example" = "shape = { kind = \"sphere\", radius = 0.03 }"))]
    pub shape: ObjectShape,
    /// Mass (kg), uniformly spread.
    #[serde(default = "default_mass")]
    #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "kg"))]
    pub mass: f64,
    /// Coefficient of friction between object and fingertips (no unit).
    #[schemars(range(min = 0.0, max = 10.0), extend("x-unit" = "1", "x-example" = "friction = 0.8"))]
    pub friction: f64,
    /// What fingertips touch: `"auto"`, `"exact"` or `{ tolerance = 3e-4 }` (m). Default `"auto"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(example = &"exact")]
    pub contact_surface: Option<ContactSurface>,
    /// Whether bodies of the mesh that do not touch are fixed to each other all the same. Default false: they
    /// are refused.
    #[serde(default, skip_serializing_if = "is_false")]
    #[schemars(example = true)]
    pub assembly: bool,
}

fn is_false(yes: &bool) -> bool {
    !yes
}

fn default_facets() -> usize {
    1280
}

fn default_object_name() -> String {
    "object".into()
}

fn default_mass() -> f64 {
    0.1
}
