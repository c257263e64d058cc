//! Where a mesh comes from.

use crate::{Mesh, MeshError, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The most facets of one mesh: above this, planning would only be slow, and the file is probably a mistake.
pub const MAX_FACETS: usize = 2_000_000;

/// What a mesh's `scale` may be (no unit).
const SCALES: (f64, f64) = (1e-9, 1e9);

/// Where a mesh comes from: a file, or the mesh itself (as plan files carry it).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MeshSource {
    /// An STL, OBJ, PLY or COLLADA file, relative to the file that names it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(example = &"part.stl")]
    pub file: Option<String>,
    /// What lengths are multiplied with (no unit): 0.001 for a file in millimetres. Default 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-9, max = 1e9), extend("x-unit" = "1"))]
    #[schemars(example = 0.001)]
    pub scale: Option<f64>,
    /// Turns the mesh inside out after reading. Default false.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(example = true)]
    pub flip: Option<bool>,
    /// Vertices (m), instead of a file.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("examples" = [[[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.0, 0.02, 0.0], [0.0, 0.0, 0.02]]]))]
    #[schemars(extend("x-unit" = "m"))]
    pub vertices: Vec<[f64; 3]>,
    /// Facets as counter-clockwise indices of vertices seen from outside, instead of a file.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("examples" = [[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]]))]
    pub facets: Vec<[u32; 3]>,
}

impl MeshSource {
    /// The mesh written out: what a plan file carries so that it stands alone.
    pub fn of(mesh: &Mesh) -> Self {
        Self {
            vertices: mesh.vertices().iter().map(|&v| v.into()).collect(),
            facets: mesh.facets().to_vec(),
            ..Self::default()
        }
    }

    /// Whether vertices or facets are given.
    pub fn is_written_out(&self) -> bool {
        !(self.vertices.is_empty() && self.facets.is_empty())
    }

    /// The mesh that is given in place; one of a file must have been read before.
    pub fn mesh(&self) -> Result<Mesh, MeshSourceError> {
        match &self.file {
            Some(_) if self.is_written_out() => Err(MeshSourceError::Choice),
            Some(file) => Err(MeshSourceError::File(file.clone())),
            None if !self.is_written_out() => Err(MeshSourceError::Choice),
            None => {
                let vertices = self.vertices.iter().map(|&v| v.into()).collect();
                self.adjusted(vertices, self.facets.clone())
            }
        }
    }

    /// The mesh of these vertices (in the unit that `scale` makes metres of) and facets, scaled and turned as
    /// the source wants.
    pub fn adjusted(
        &self,
        mut vertices: Vec<Vec3>,
        mut facets: Vec<[u32; 3]>,
    ) -> Result<Mesh, MeshSourceError> {
        if facets.len() > MAX_FACETS {
            return Err(MeshSourceError::TooMany(facets.len()));
        }
        let scale = self.scale.unwrap_or(1.0);
        if !(SCALES.0..=SCALES.1).contains(&scale) {
            return Err(MeshSourceError::Scale(scale));
        }
        vertices.iter_mut().for_each(|v| *v *= scale);
        if self.flip.unwrap_or(false) {
            facets.iter_mut().for_each(|facet| facet.swap(1, 2));
        }
        Ok(Mesh::new(vertices, facets)?)
    }
}

/// Why a mesh source gives no mesh.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MeshSourceError {
    /// Neither a file nor vertices and facets, or both.
    #[error("give either `file`, or both `vertices` and `facets`")]
    Choice,
    /// The mesh is in a file.
    #[error("the mesh is in the file `{0}`, which must be read first")]
    File(String),
    /// A scale out of range.
    #[error("`scale` = {0} is outside 1e-9..=1e9")]
    Scale(f64),
    /// More facets than [`MAX_FACETS`].
    #[error("{0} facets are more than the largest allowed {MAX_FACETS}; simplify the mesh")]
    TooMany(usize),
    /// No sound mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}
