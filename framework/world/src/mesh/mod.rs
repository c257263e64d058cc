//! Meshes from STL, OBJ, PLY and COLLADA files or given in place.

mod collada;
mod obj;
mod ply;
mod polygon;
mod stl;
mod text;
mod weld;

use crate::error::WorldError;
use regrasp_api::{Mesh, MeshSource, Vec3};
use std::path::Path;

/// The most facets of one mesh: above this, planning would only be slow, and the file is probably a mistake.
pub const MAX_FACETS: usize = 2_000_000;
/// The largest mesh file (bytes): an ASCII STL of [`MAX_FACETS`] facets is smaller.
const MAX_BYTES: u64 = 1 << 30;

/// Vertices and facets as a file has them: in the file's unit (COLLADA: in metres), not yet checked.
type Raw = (Vec<Vec3>, Vec<[u32; 3]>);

/// The mesh of `source`, in metres; a file is looked for relative to the folder `base`.
///
/// Vertices of a file at equal coordinates are merged, and vertices that no facet uses are dropped. `key` is the path of
/// the source in its description, for messages.
pub fn load_mesh(source: &MeshSource, base: &Path, key: &str) -> Result<Mesh, WorldError> {
    match &source.file {
        None => in_place(source, key),
        Some(_) if !(source.vertices.is_empty() && source.facets.is_empty()) => {
            Err(WorldError::value(key, "give either `file`, or both `vertices` and `facets`"))
        }
        Some(file) => from_file(source, &base.join(file), key),
    }
}

/// The mesh given in place: what a plan file carries so that it stands alone.
pub(crate) fn in_memory(mesh: &Mesh) -> MeshSource {
    MeshSource {
        vertices: mesh.vertices().iter().map(|&v| v.into()).collect(),
        facets: mesh.facets().to_vec(),
        ..Default::default()
    }
}

fn in_place(source: &MeshSource, key: &str) -> Result<Mesh, WorldError> {
    if source.facets.is_empty() && source.vertices.is_empty() {
        return Err(WorldError::value(key, "give either `file`, or both `vertices` and `facets`"));
    }
    check_count(source.facets.len()).map_err(|reason| WorldError::value(format!("{key}.facets"), reason))?;
    let vertices = source.vertices.iter().map(|&v| v.into()).collect();
    let (vertices, facets) = adjusted((vertices, source.facets.clone()), source, key)?;
    Mesh::new(vertices, facets).map_err(|source| WorldError::Mesh { key: key.into(), source })
}

fn from_file(source: &MeshSource, path: &Path, key: &str) -> Result<Mesh, WorldError> {
    let fail = |reason| WorldError::File { key: format!("{key}.file"), path: path.into(), reason };
    let raw = read(path).map_err(fail)?;
    let (vertices, facets) = adjusted(weld::welded(raw), source, key)?;
    Mesh::new(vertices, facets).map_err(|source| WorldError::FileMesh {
        key: format!("{key}.file"),
        path: path.into(),
        source,
    })
}

/// Scaled and flipped as the source wants.
fn adjusted((mut vertices, mut facets): Raw, source: &MeshSource, key: &str) -> Result<Raw, WorldError> {
    let scale = source.scale.unwrap_or(1.0);
    crate::error::check_range(&format!("{key}.scale"), scale, 1e-9, 1e9, "")?;
    vertices.iter_mut().for_each(|v| *v *= scale);
    if source.flip.unwrap_or(false) {
        facets.iter_mut().for_each(|facet| facet.swap(1, 2));
    }
    Ok((vertices, facets))
}

/// Vertices and facets as a file has them, vertices at equal coordinates merged: for uses that need no closed surface, such as a hull.
pub(crate) fn read_points(path: &Path) -> Result<Raw, String> {
    read(path).map(weld::welded)
}

fn read(path: &Path) -> Result<Raw, String> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let parse = match extension.as_str() {
        "stl" => stl::parse,
        "obj" => obj::parse,
        "ply" => ply::parse,
        "dae" => collada::parse,
        _ => return Err(format!("`.{extension}` is not one of .stl, .obj, .ply, .dae; convert the file")),
    };
    let size = std::fs::metadata(path).map_err(|error| error.to_string())?.len();
    if size > MAX_BYTES {
        return Err(format!("{size} bytes are more than the largest allowed {MAX_BYTES}; simplify the mesh"));
    }
    let raw = parse(&std::fs::read(path).map_err(|error| error.to_string())?)?;
    check_count(raw.1.len())?;
    Ok(raw)
}

fn check_count(facets: usize) -> Result<(), String> {
    if facets <= MAX_FACETS {
        return Ok(());
    }
    Err(format!("{facets} facets are more than the largest allowed {MAX_FACETS}; simplify the mesh"))
}

#[cfg(test)]
mod tests;
