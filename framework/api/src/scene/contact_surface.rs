//! What a fingertip feels of a rough object.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What contacts live on: the object's mesh, or a twin of it that is smooth at the scale of a fingertip.
///
/// Clearance and mass are always those of the mesh. A plan file holds the twin beside the scenario.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ContactSurface {
    /// `"auto"` or `"exact"`.
    Word(ContactSurfaceWord),
    /// The coarsest twin that is as near as this, whatever the mesh.
    Within(Nearness),
}

/// How the contact surface is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ContactSurfaceWord {
    /// The mesh itself where it is smooth at the scale of a fingertip, else a twin (the default).
    Auto,
    /// The mesh itself.
    Exact,
}

/// How near a twin of the object's mesh must be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nearness {
    /// How far a fingertip that touches the twin may be from touching the mesh, and how deep it may enter it
    /// (m).
    #[schemars(range(min = 1e-6, max = 0.01), extend("x-unit" = "m"))]
    #[schemars(example = 3e-4)]
    pub tolerance: f64,
}
