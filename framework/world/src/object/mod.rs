//! The object: from its description to mesh, mass and friction.

mod distance;
mod measure;
mod pattern;

pub use distance::signed_distances;
pub use measure::{Measures, measure};

use crate::error::{WorldError, check_range};
use regrasp_api::{
    MAX_FACETS, Mesh, MeshError, ObjectDescription, ObjectModel, ObjectShape, Primitive, Vec3,
};

/// Lengths of a primitive (m): beyond these, somebody has mistaken the unit by far.
const LENGTHS: (f64, f64) = (1e-6, 1e3);
/// The longest length of a primitive over its shortest.
const MAX_PROPORTION: f64 = 10_000.0;

/// The object of `description`, a mesh being given in place.
///
/// Errors name keys below `object`.
pub fn load_object(description: &ObjectDescription) -> Result<ObjectModel, WorldError> {
    check_body(description)?;
    let (mesh, primitive) = match &description.shape {
        ObjectShape::Mesh(source) => {
            (source.mesh().map_err(|error| WorldError::mesh("object.shape", error))?, None)
        }
        shape => {
            let (primitive, facets) = primitive(shape)?;
            let refused = |source| WorldError::Mesh { key: "object.shape".into(), source };
            (primitive_mesh(&primitive, facets).map_err(refused)?, Some(primitive))
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
    check_range("object.mass", description.mass, 1e-6, 1e3, " kg")?;
    check_range("object.friction", description.friction, 0.0, 10.0, "")
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

/// The closed form and wished number of facets of a shape that is not a mesh.
fn primitive(shape: &ObjectShape) -> Result<(Primitive, usize), WorldError> {
    let (primitive, facets) = match *shape {
        ObjectShape::Sphere { radius, facets } => {
            (Primitive::Sphere { radius: length("radius", radius)? }, facets)
        }
        ObjectShape::Ellipsoid { semi_axes, facets } => {
            (Primitive::Ellipsoid { semi_axes: lengths("semi_axes", semi_axes)? }, facets)
        }
        ObjectShape::Cuboid { size } => (Primitive::Cuboid { half_size: lengths("size", size)? / 2.0 }, 12),
        ObjectShape::Cylinder { radius, height, facets } => {
            let half_height = length("height", height)? / 2.0;
            (Primitive::Cylinder { radius: length("radius", radius)?, half_height }, facets)
        }
        ObjectShape::Capsule { radius, height, facets } => {
            let half_height = length("height", height)? / 2.0;
            (Primitive::Capsule { radius: length("radius", radius)?, half_height }, facets)
        }
        ObjectShape::Torus { ring_radius, tube_radius, facets } => {
            (torus(length("ring_radius", ring_radius)?, length("tube_radius", tube_radius)?)?, facets)
        }
        ObjectShape::Mesh(_) => unreachable!("the caller takes meshes apart"),
    };
    check_proportions(&primitive)?;
    if !(12..=MAX_FACETS).contains(&facets) {
        return Err(WorldError::range("object.shape.facets", facets, format!("12..={MAX_FACETS}")));
    }
    Ok((primitive, facets))
}

/// Refuses needles and sheets, whose facets would be slivers.
fn check_proportions(primitive: &Primitive) -> Result<(), WorldError> {
    let (shortest, longest) = match *primitive {
        Primitive::Sphere { .. } => return Ok(()),
        Primitive::Ellipsoid { semi_axes: v } | Primitive::Cuboid { half_size: v } => (v.min(), v.max()),
        Primitive::Cylinder { radius, half_height } | Primitive::Capsule { radius, half_height } => {
            (radius.min(half_height), radius.max(half_height))
        }
        Primitive::Torus { ring_radius, tube_radius } => (tube_radius, ring_radius),
    };
    if longest <= MAX_PROPORTION * shortest {
        return Ok(());
    }
    let reason = format!("the longest length is more than {MAX_PROPORTION} times the shortest");
    Err(WorldError::value("object.shape", reason))
}

fn torus(ring_radius: f64, tube_radius: f64) -> Result<Primitive, WorldError> {
    if tube_radius < 0.99 * ring_radius {
        return Ok(Primitive::Torus { ring_radius, tube_radius });
    }
    let reason = format!(
        "{tube_radius} m must be less than 0.99 × `ring_radius` = {ring_radius} m, or the ring closes"
    );
    Err(WorldError::value("object.shape.tube_radius", reason))
}

fn length(key: &str, value: f64) -> Result<f64, WorldError> {
    check_range(&format!("object.shape.{key}"), value, LENGTHS.0, LENGTHS.1, " m")?;
    Ok(value)
}

fn lengths(key: &str, values: [f64; 3]) -> Result<Vec3, WorldError> {
    for (i, value) in values.into_iter().enumerate() {
        length(&format!("{key}[{i}]"), value)?;
    }
    Ok(values.into())
}

#[cfg(test)]
mod tests;
