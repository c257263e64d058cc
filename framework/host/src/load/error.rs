//! Why a library of plugins is refused.

use regrasp_api::{Refusal, Refuse};
use std::fmt;
use std::path::PathBuf;
use thiserror::Error;

/// One line of the fingerprint that differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// What the line is about.
    pub key: String,
    /// This program's value; `None` where it has no such line.
    pub program: Option<String>,
    /// The library's value; `None` where it has no such line.
    pub library: Option<String>,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = |value: &Option<String>| value.clone().unwrap_or_else(|| "(nothing)".into());
        let (program, library) = (side(&self.program), side(&self.library));
        write!(f, "  {}\n    this program: {program}\n    the library:  {library}", self.key)
    }
}

/// A library is refused. Nothing was loaded, except where the variant says so.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    #[error("`{}` cannot be read: {cause}", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's word.
        cause: String,
    },
    /// The file is no shared library.
    #[error("`{}` is not a shared library (ELF, Mach-O or PE): {cause}", .path.display())]
    NotALibrary {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        cause: String,
    },
    /// The library exports no plugins.
    #[error(
        "`{}` is a library without Regrasp plugins; the crate of a plugin library is of type `cdylib` and \
            says \
         `regrasp_abi::export_plugins!(my_plugin::ENTRY);` (`regrasp new-plugin` writes one)",
        .path.display()
    )]
    NoPlugins {
        /// The file.
        path: PathBuf,
    },
    /// The library was built for another version of the plugin contract.
    #[error(
        "`{}` was built for version {library} of the plugin contract, this program has version {program}; \
         adapt the plugin, then rebuild it:\n  {rebuild}",
        .path.display()
    )]
    Contract {
        /// The file.
        path: PathBuf,
        /// This program's version.
        program: String,
        /// The library's version.
        library: String,
        /// The command that rebuilds the plugin.
        rebuild: String,
    },
    /// The library was built by another compiler, for another target, or from other sources of the contract.
    #[error(
        "`{}` was not built alike with this program; what differs:\n{}\nrebuild the plugin (and this \
            program, if the framework's sources \
         changed since it was built):\n  {rebuild}",
        .path.display(),
        lines(.differences)
    )]
    Fingerprint {
        /// The file.
        path: PathBuf,
        /// The lines that differ.
        differences: Vec<Difference>,
        /// The command that rebuilds the plugin.
        rebuild: String,
    },
    /// Two plugins share an id.
    #[error(
        "two plugins have the id `{id}`: one is from {first}, the other from {second}; rename one of them"
    )]
    Duplicate {
        /// The id.
        id: String,
        /// Where the plugin comes from that was there before.
        first: String,
        /// Where the other comes from.
        second: String,
    },
    /// The system cannot load the library: another library that it needs is missing.
    #[error("`{}` cannot be loaded: {cause}", .path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// The system's word.
        cause: String,
    },
    /// What was loaded is not what was read before: the file was replaced in between. Its plugins are not
    /// used.
    #[error("`{}` changed while it was being loaded; try again", .path.display())]
    Changed {
        /// The file.
        path: PathBuf,
    },
}

fn lines(differences: &[Difference]) -> String {
    differences.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

impl Refuse for LoadError {
    fn refusal(&self) -> Refusal {
        let (code, path) = match self {
            Self::Unreadable { path, .. } => ("unreadable", path),
            Self::NotALibrary { path, .. } => ("not-a-library", path),
            Self::NoPlugins { path, .. } => ("no-plugins", path),
            Self::Contract { path, .. } => ("library-contract", path),
            Self::Fingerprint { path, .. } => ("library-fingerprint", path),
            Self::Duplicate { id, .. } => return Refusal::new("duplicate-plugin", self).value(id),
            Self::Open { path, .. } => ("library-open", path),
            Self::Changed { path, .. } => ("library-changed", path),
        };
        let remedy = match self {
            Self::Contract { rebuild, .. } | Self::Fingerprint { rebuild, .. } => rebuild.as_str(),
            _ => "",
        };
        Refusal::new(code, self).file(path.display()).remedy(remedy)
    }
}
