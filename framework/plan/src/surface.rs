//! The surfaces that the program derived from the scenario's object.

use regrasp_api::Mesh;
use serde::{Deserialize, Serialize};

/// What the program derived from the scenario's object.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectRecord {
    /// The facets of a primitive, on which its contacts live; absent where the scenario's object is a mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<Facets>,
    /// The twin of a rough mesh; absent where contacts live on the object's own surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_surface: Option<ContactSurface>,
}

/// A closed mesh in the object's frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Facets {
    /// The vertices (m).
    pub vertices: Vec<[f64; 3]>,
    /// The facets: three vertices each, counter-clockwise from outside.
    pub facets: Vec<[u32; 3]>,
}

impl From<&Mesh> for Facets {
    fn from(mesh: &Mesh) -> Self {
        let vertices = mesh.vertices().iter().map(|&v| v.into()).collect();
        Self { vertices, facets: mesh.facets().to_vec() }
    }
}

/// A twin of the object's surface, smooth at the scale of a fingertip: contacts live there. Clearance, mass
/// and what may not be entered are those of the object's own surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactSurface {
    /// The twin's vertices in the object's frame (m).
    pub vertices: Vec<[f64; 3]>,
    /// Its facets: three vertices each, counter-clockwise from outside.
    pub facets: Vec<[u32; 3]>,
    /// A digest of the mesh that it was made from, in hexadecimal digits.
    pub digest: String,
    /// How far a fingertip that touches the twin is at most from touching the object's own surface, and how
    /// deep it enters it (m).
    pub bound: f64,
}
