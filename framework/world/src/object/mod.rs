//! The object: from its description to mesh, mass and friction.

mod distance;
mod measure;
mod pattern;

pub use distance::signed_distances;
pub use measure::{Measures, measure};

use crate::error::WorldError;
use regrasp_api::{
    Mesh, MeshError, MeshSourceError, ObjectDescription, ObjectModel, Primitive, check_described, check_field,
};

/// The longest length of a primitive over its shortest.
const MAX_PROPORTION: f64 = 10_000.0;

/// The object of `description`, a mesh being given in place.
///
/// Errors name keys below `object`.
pub fn load_object(description: &ObjectDescription) -> Result<ObjectModel, WorldError> {
    check_body(description)?;
    const KEY: &str = "object.shape";
    let refused = |error| WorldError::mesh(KEY, error);
    let (mesh, primitive) = match description.shape.primitive() {
        Err(source) => (source.mesh().map_err(refused)?, None),
        Ok((primitive, facets)) => {
            check_described(&description.shape, KEY)?;
            check_proportions(&primitive)?;
            let mesh = primitive_mesh(&primitive, facets).map_err(MeshSourceError::Mesh).map_err(refused)?;
            (mesh, Some(primitive))
        }
    };
    Ok(ObjectModel::new(mesh, primitive, description.mass, description.friction))
}

/// The object of `description` whose mesh was read from the file that it names.
pub fn object_of_mesh(description: &ObjectDescription, mesh: Mesh) -> Result<ObjectModel, WorldError> {
    check_body(description)?;
    Ok(ObjectModel::new(mesh, None, description.mass, description.friction))
}

fn check_body(description: &ObjectDescription) -> Result<(), WorldError> {
    check_field::<ObjectDescription>("mass", &description.mass, "object.mass")?;
    Ok(check_field::<ObjectDescription>("friction", &description.friction, "object.friction")?)
}

/// A closed, outward mesh of `primitive` with about `facets` facets (12 for a cuboid), its vertices on the
/// true surface.
///
/// Sphere and ellipsoid have 20 · 4^k facets (an icosahedron, quartered), the others 2 for each cell of a
/// grid. Lengths that are not positive and finite, or differ by many orders of magnitude, are refused as the
/// mesh's fault.
pub fn primitive_mesh(primitive: &Primitive, facets: usize) -> Result<Mesh, MeshError> {
    let (vertices, facets) = pattern::facets_of(primitive, facets);
    Mesh::new(vertices, facets)
}

/// Refuses needles and sheets, whose facets would be slivers, and rings that close.
fn check_proportions(primitive: &Primitive) -> Result<(), WorldError> {
    let (shortest, longest) = match *primitive {
        Primitive::Sphere { .. } => return Ok(()),
        Primitive::Ellipsoid { semi_axes: v } | Primitive::Cuboid { half_size: v } => (v.min(), v.max()),
        Primitive::Cylinder { radius, half_height } | Primitive::Capsule { radius, half_height } => {
            (radius.min(half_height), radius.max(half_height))
        }
        Primitive::Torus { ring_radius, tube_radius } if tube_radius >= 0.99 * ring_radius => {
            let reason = format!(
                "{tube_radius} m must be less than 0.99 × `ring_radius` = {ring_radius} m, or the ring closes"
            );
            return Err(WorldError::value("object.shape.tube_radius", reason));
        }
        Primitive::Torus { ring_radius, tube_radius } => (tube_radius, ring_radius),
    };
    if longest <= MAX_PROPORTION * shortest {
        return Ok(());
    }
    let reason = format!("the longest length is more than {MAX_PROPORTION} times the shortest");
    Err(WorldError::value("object.shape", reason))
}

#[cfg(test)]
mod tests;
