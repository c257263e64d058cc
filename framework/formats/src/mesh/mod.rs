//! Meshes from STL, OBJ, PLY, COLLADA, glTF and 3MF files or given in place.

mod collada;
mod gather;
mod gltf;
mod heal;
mod kind;
mod obj;
mod ply;
mod polygon;
mod reason;
mod stl;
mod text;
mod threemf;
mod weld;

use crate::error::FormatError;
use kind::Kind;
use regrasp_api::{MAX_FACETS, Mesh, MeshError, MeshSource, MeshSourceError, Vec3};
use std::path::Path;

/// The largest mesh file (bytes): an ASCII STL of [`MAX_FACETS`] facets is smaller.
const MAX_BYTES: u64 = 1 << 30;

/// Coordinates are within this (m).
const FARTHEST: f64 = 1e6;
/// No object is smaller (m).
const SMALLEST: f64 = 1e-8;

/// Vertices and facets as a file has them: in the file's unit (COLLADA, glTF and 3MF: in metres), not yet
/// checked.
type Raw = (Vec<Vec3>, Vec<[u32; 3]>);

/// A mesh of a file, and what was done to close it.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadMesh {
    /// The mesh, in metres.
    pub mesh: Mesh,
    /// Facets without area that were left out.
    pub dropped: usize,
    /// How far apart (m) vertices could be that were made one: 0 where only equal ones were.
    pub welded: f64,
    /// How many vertices went into others that were not equal.
    pub merged: usize,
}

impl ReadMesh {
    /// What was done, for people; nothing where nothing was.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        match self.dropped {
            0 => {}
            1 => remarks.push("a facet without area was left out; the rest is closed".into()),
            count => remarks.push(format!("{count} facets without area were left out; the rest is closed")),
        }
        let within = self.welded;
        match self.merged {
            0 => {}
            1 => remarks.push(format!(
                "a vertex became one with another within {within:.1e} m: only that closes the mesh"
            )),
            count => remarks.push(format!(
                "{count} vertices became one with others within {within:.1e} m: only that closes the mesh"
            )),
        }
        remarks
    }
}

/// The mesh of `source`, in metres; a file is looked for relative to the folder `base`.
///
/// Vertices of a file at equal coordinates are merged; those that differ by less than a hundred-thousandth of
/// the mesh's size are too where only that closes the mesh. Facets without area are left out where the rest
/// stays closed, and vertices that no facet uses. `key` is the path of the source in its description, for
/// messages.
pub fn load_mesh(source: &MeshSource, base: &Path, key: &str) -> Result<Mesh, FormatError> {
    read_mesh(source, base, key).map(|read| read.mesh)
}

/// The same, with what was done to close it.
pub fn read_mesh(source: &MeshSource, base: &Path, key: &str) -> Result<ReadMesh, FormatError> {
    match &source.file {
        Some(file) if !source.is_written_out() => from_file(source, &base.join(file), key),
        _ => {
            let mesh = source.mesh().map_err(|error| FormatError::source(key, None, error))?;
            Ok(ReadMesh { mesh, dropped: 0, welded: 0.0, merged: 0 })
        }
    }
}

fn from_file(source: &MeshSource, path: &Path, key: &str) -> Result<ReadMesh, FormatError> {
    let fail = |reason| FormatError::File { key: format!("{key}.file"), path: path.into(), reason };
    let raw = weld::welded(read(path).map_err(fail)?);
    let scale = source.scale.unwrap_or(1.0);
    check_size(&raw.0, scale).map_err(fail)?;
    let ((vertices, facets), dropped) = heal::healed(raw.clone());
    let error = match source.adjusted(vertices.clone(), facets.clone()) {
        Ok(mesh) => return Ok(ReadMesh { mesh, dropped, welded: 0.0, merged: 0 }),
        Err(error) => error,
    };
    let MeshSourceError::Mesh(fault) = error else { return Err(FormatError::source(key, Some(path), error)) };
    if let Some(read) = nearly_closed(source, &raw) {
        return Ok(read);
    }
    let vertices: Vec<Vec3> = vertices.iter().map(|v| v * scale).collect();
    // With `flip` the facets were turned: which body is meant is not told then.
    let is_inward = matches!(fault, MeshError::InsideOut { .. }) && source.flip != Some(true);
    if let Some(reason) = is_inward.then(|| reason::inward_body(&vertices, &facets)).flatten() {
        return Err(fail(reason));
    }
    let true_fault = MeshSourceError::Mesh(reason::reason(&vertices, &facets, fault));
    Err(FormatError::source(key, Some(path), true_fault))
}

/// Refuses sizes that no object has; a scale out of range is refused as such later.
fn check_size(vertices: &[Vec3], scale: f64) -> Result<(), String> {
    if !(1e-9..=1e9).contains(&scale) || vertices.is_empty() {
        return Ok(());
    }
    let low = vertices.iter().copied().reduce(|a, b| a.inf(&b)).unwrap_or_default() * scale;
    let high = vertices.iter().copied().reduce(|a, b| a.sup(&b)).unwrap_or_default() * scale;
    let (farthest, size) = (low.amax().max(high.amax()), (high - low).max());
    let hint = "lengths are in metres: see `scale`";
    if farthest > FARTHEST {
        return Err(format!(
            "a coordinate of {farthest:e} m is outside -{FARTHEST:e}..={FARTHEST:e}; {hint}"
        ));
    }
    if size < SMALLEST {
        return Err(format!("the mesh is {size:e} m large, less than {SMALLEST:e}; {hint}"));
    }
    Ok(())
}

/// The mesh with vertices that differ by rounding made one, if that makes it sound.
fn nearly_closed(source: &MeshSource, raw: &Raw) -> Option<ReadMesh> {
    let size = raw.0.iter().map(|v| v.amax()).fold(0.0, f64::max);
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    [0.1 * weld::NEARLY_EQUAL, weld::NEARLY_EQUAL].into_iter().find_map(|part| {
        let within = part * size;
        let near = weld::welded_within(raw.clone(), within);
        let merged = raw.0.len() - near.0.len();
        let ((vertices, facets), dropped) = heal::healed(near);
        let mesh = source.adjusted(vertices, facets).ok()?;
        Some(ReadMesh { mesh, dropped, welded: within * source.scale.unwrap_or(1.0), merged })
    })
}

/// Vertices and facets as a file has them, vertices at equal coordinates merged: for uses that need no
/// closed surface, such as a hull.
pub fn read_points(path: &Path) -> Result<Raw, FormatError> {
    let fail = |reason| FormatError::File { key: "mesh".into(), path: path.into(), reason };
    read(path).map(weld::welded).map_err(fail)
}

fn read(path: &Path) -> Result<Raw, String> {
    let kind = Kind::of_name(path)?;
    let bytes = regrasp_api::read_at_most(path, MAX_BYTES).map_err(|error| match error.kind() {
        std::io::ErrorKind::FileTooLarge => format!("{error}; simplify the mesh"),
        _ => error.to_string(),
    })?;
    let bytes = text::plain(bytes);
    let raw = kind.parse(&bytes, path).map_err(|reason| match Kind::of_content(&bytes) {
        Some(other) if other != kind => {
            format!(
                "{reason}; its content looks like {}: give it the ending `.{}`",
                other.name(),
                other.ending()
            )
        }
        _ => reason,
    })?;
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
mod scenes;
#[cfg(test)]
mod tests;
