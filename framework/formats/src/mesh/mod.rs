//! Meshes from STL, OBJ, PLY and COLLADA files or given in place.

mod collada;
mod heal;
mod obj;
mod ply;
mod polygon;
mod reason;
mod stl;
mod text;
mod weld;

use crate::error::FormatError;
use regrasp_api::{MAX_FACETS, Mesh, MeshSource, MeshSourceError, Vec3};
use std::path::Path;

/// The largest mesh file (bytes): an ASCII STL of [`MAX_FACETS`] facets is smaller.
const MAX_BYTES: u64 = 1 << 30;

/// Vertices and facets as a file has them: in the file's unit (COLLADA: in metres), not yet checked.
type Raw = (Vec<Vec3>, Vec<[u32; 3]>);

/// The mesh of `source`, in metres; a file is looked for relative to the folder `base`.
///
/// Vertices of a file at equal coordinates are merged; those that differ by less than a millionth of the
/// mesh's size are too where only that closes the mesh. Facets without area are left out where the rest stays
/// closed, and vertices that no facet uses. `key` is the path of the source in its description, for messages.
pub fn load_mesh(source: &MeshSource, base: &Path, key: &str) -> Result<Mesh, FormatError> {
    match &source.file {
        Some(file) if !source.is_written_out() => from_file(source, &base.join(file), key),
        _ => source.mesh().map_err(|error| FormatError::source(key, None, error)),
    }
}

/// Vertices nearer than this, as part of the mesh's size, are one if that closes the mesh.
const NEARLY_EQUAL: f64 = 1e-6;

fn from_file(source: &MeshSource, path: &Path, key: &str) -> Result<Mesh, FormatError> {
    let fail = |reason| FormatError::File { key: format!("{key}.file"), path: path.into(), reason };
    let raw = weld::welded(read(path).map_err(fail)?);
    let (first, _) = heal::healed(raw.clone());
    let error = match source.adjusted(first.0.clone(), first.1.clone()) {
        Ok(mesh) => return Ok(mesh),
        Err(error) => error,
    };
    let MeshSourceError::Mesh(fault) = error else { return Err(FormatError::source(key, Some(path), error)) };
    if let Some(mesh) = nearly_closed(source, raw) {
        return Ok(mesh);
    }
    let scale = source.scale.unwrap_or(1.0);
    let vertices: Vec<Vec3> = first.0.iter().map(|v| v * scale).collect();
    let true_fault = MeshSourceError::Mesh(reason::reason(&vertices, &first.1, fault));
    Err(FormatError::source(key, Some(path), true_fault))
}

/// The mesh with vertices that differ by rounding made one, if that makes it sound.
fn nearly_closed(source: &MeshSource, raw: Raw) -> Option<Mesh> {
    let size = raw.0.iter().map(|v| v.amax()).fold(0.0, f64::max);
    if size <= 0.0 {
        return None;
    }
    let ((vertices, facets), _) = heal::healed(weld::welded_within(raw, NEARLY_EQUAL * size));
    source.adjusted(vertices, facets).ok()
}

/// Vertices and facets as a file has them, vertices at equal coordinates merged: for uses that need no
/// closed surface, such as a hull.
pub fn read_points(path: &Path) -> Result<Raw, FormatError> {
    let fail = |reason| FormatError::File { key: "mesh".into(), path: path.into(), reason };
    read(path).map(weld::welded).map_err(fail)
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
    let bytes = regrasp_api::read_at_most(path, MAX_BYTES).map_err(|error| match error.kind() {
        std::io::ErrorKind::FileTooLarge => format!("{error}; simplify the mesh"),
        _ => error.to_string(),
    })?;
    let raw = parse(&text::plain(bytes))?;
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
mod dialects;
#[cfg(test)]
mod tests;
