//! The files of each format.

use crate::names::file_stem;
use crate::{ExportError, File, Format, Scene};

impl Scene<'_> {
    /// The files of one format. `stem` begins their names; what no file's name may hold is replaced.
    pub fn export(&self, format: Format, stem: &str) -> Result<Vec<File>, ExportError> {
        let stem = &file_stem(stem);
        match format {
            Format::Gltf => Ok(crate::gltf::files(self, stem)),
            Format::Urdf => Ok(crate::urdf::files(self, stem)),
            Format::Mjcf => Ok(crate::mjcf::files(self, stem)),
            Format::Csv => Ok(crate::csv::files(self, stem)),
            Format::Npz => crate::npy::files(self, stem),
        }
    }
}
