//! Objects and obstacles.

use super::{ContactSurface, ObjectShape, PoseDescription, Shape};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

fn default_object_name() -> String {
    "object".into()
}

fn default_mass() -> f64 {
    0.1
}
