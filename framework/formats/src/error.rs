//! Why a file is refused.

use regrasp_api::{MeshError, MeshSourceError, Refusal, Refuse};
use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a mesh is refused: each message names the key or the file, the value and what is allowed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FormatError {
    /// A value that cannot be used; the text says why.
    #[error("`{key}`: {reason}")]
    Value {
        /// The path of the key.
        key: String,
        /// Why, and what to do.
        reason: String,
    },
    /// A number outside its range.
    #[error("`{key}` = {value} is outside {range}")]
    Range {
        /// The path of the key.
        key: String,
        /// The value that was given.
        value: f64,
        /// The allowed range.
        range: &'static str,
    },
    /// A file that cannot be read.
    #[error("`{key}`: cannot read `{}`: {reason}", path.display())]
    File {
        /// The path of the key.
        key: String,
        /// The file, as it was looked for.
        path: PathBuf,
        /// Why, with the line where there is one.
        reason: String,
    },
    /// A file whose mesh cannot be used.
    #[error("`{key}`: the mesh of `{}` is refused: {source}{}", path.display(), remedy(source))]
    FileMesh {
        /// The path of the key.
        key: String,
        /// The file.
        path: PathBuf,
        /// What is wrong with the mesh, and the fix.
        source: Box<MeshError>,
    },
    /// A mesh given in place that cannot be used.
    #[error("`{key}`: the mesh is refused: {source}")]
    Mesh {
        /// The path of the key.
        key: String,
        /// What is wrong with the mesh, and the fix.
        source: MeshError,
    },
}

/// What helps beside the remedy that the fault names itself.
fn remedy(fault: &MeshError) -> &'static str {
    match fault {
        MeshError::Open { .. }
        | MeshError::TJunction { .. }
        | MeshError::Seam { .. }
        | MeshError::Duplicated { .. }
        | MeshError::NotManifold { .. } => {
            ", or let `regrasp object FILE --repair -o clean.stl` make a closed surface of it"
        }
        _ => "",
    }
}

impl FormatError {
    /// A source, at `key`, that gives no mesh; `path` is the file that was read, if there is one.
    pub(crate) fn source(key: &str, path: Option<&Path>, error: MeshSourceError) -> Self {
        match (error, path) {
            (MeshSourceError::Mesh(source), Some(path)) => {
                Self::FileMesh { key: format!("{key}.file"), path: path.into(), source: Box::new(source) }
            }
            (MeshSourceError::Mesh(source), None) => Self::Mesh { key: key.into(), source },
            (MeshSourceError::Scale(value), _) => {
                Self::Range { key: format!("{key}.scale"), value, range: "1e-9..=1e9" }
            }
            (error @ MeshSourceError::TooMany(_), None) => {
                Self::Value { key: format!("{key}.facets"), reason: error.to_string() }
            }
            (error, _) => Self::Value { key: key.into(), reason: error.to_string() },
        }
    }
}

impl Refuse for FormatError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Value { key, .. } => Refusal::new("value", self).key(key),
            Self::Range { key, value, range } => {
                Refusal::new("out-of-range", self).key(key).value(value).range(range)
            }
            Self::File { key, path, .. } => Refusal::new("file", self).key(key).value(path.display()),
            Self::FileMesh { key, path, .. } => Refusal::new("mesh", self).key(key).value(path.display()),
            Self::Mesh { key, .. } => Refusal::new("mesh", self).key(key),
        }
    }
}

/// Why a robot's file is refused: the file, the line where there is one, what is wrong there and what
/// probably mends it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotFileError {
    /// The file.
    pub file: PathBuf,
    /// The line, counted from 1.
    pub line: Option<usize>,
    /// The key of whoever names the file that would mend it, such as `tips`.
    pub key: Option<&'static str>,
    /// What is wrong, and the likely fix.
    pub message: String,
}

impl Refuse for RobotFileError {
    fn refusal(&self) -> Refusal {
        let refusal = Refusal::new("robot-file", &self.message).file(self.file.display()).line(self.line);
        Refusal { key: self.key.map(str::to_owned), ..refusal }
    }
}

impl fmt::Display for RobotFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n  --> {}", self.message, self.file.display())?;
        self.line.map_or(Ok(()), |line| write!(f, ":{line}"))
    }
}

impl std::error::Error for RobotFileError {}

/// A fault within one file: its line, if it has one, and what is wrong.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{message}")]
pub struct RobotFault {
    /// The line, counted from 1.
    pub line: Option<usize>,
    /// The key of whoever names the file that would mend it, such as `tips`.
    pub key: Option<&'static str>,
    /// What is wrong, and the likely fix.
    pub message: String,
}

impl RobotFault {
    /// A fault of the element that begins in `line`.
    pub fn at(line: usize, message: impl Into<String>) -> Self {
        Self { line: Some(line), key: None, message: message.into() }
    }

    /// A fault of the file as a whole.
    pub fn of_file(message: impl Into<String>) -> Self {
        Self { line: None, key: None, message: message.into() }
    }

    /// A fault that a key of whoever names the file would mend.
    pub fn of_key(key: &'static str, message: impl Into<String>) -> Self {
        Self { key: Some(key), ..Self::of_file(message) }
    }

    /// The fault, of this file.
    pub fn within(self, file: &Path) -> RobotFileError {
        RobotFileError { file: file.to_owned(), line: self.line, key: self.key, message: self.message }
    }
}
