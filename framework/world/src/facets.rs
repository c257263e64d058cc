//! The facets of shapes.

use crate::error::WorldError;
use crate::object::primitive_mesh;
use nalgebra::Point3;
use regrasp_api::{Form, Mesh, MeshSourceError, Shape};

/// Facets of a round solid that is drawn or simulated by them.
const FACETS: usize = 320;

/// The facets of a shape described at `key`, in its own frame; the vertices of a round one lie on it. A
/// half-space has none and is refused.
pub fn shape_mesh(shape: &Shape, key: &str) -> Result<Mesh, WorldError> {
    let refused = |error| WorldError::mesh(key, error);
    match shape.form() {
        Form::Mesh(source) => source.mesh().map_err(refused),
        Form::HalfSpace { .. } => Err(WorldError::value(key, "a half-space has no facets")),
        Form::Primitive(primitive, X) => {
            let about_origin = primitive_mesh(&primitive, FACETS);
            let moved = |mesh: Mesh| {
                let vertices = mesh.vertices().iter().map(|v| (X * Point3::from(*v)).coords).collect();
                Mesh::new(vertices, mesh.facets().to_vec())
            };
            about_origin.and_then(moved).map_err(MeshSourceError::Mesh).map_err(refused)
        }
    }
}
