//! Why a URDF is refused.

use std::fmt;
use std::path::{Path, PathBuf};

/// Why a URDF is refused: the file, the line where there is one, what is wrong there and what probably mends it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UrdfError {
    /// The file.
    pub file: PathBuf,
    /// The line, counted from 1.
    pub line: Option<usize>,
    /// What is wrong, and the likely fix.
    pub message: String,
}

impl fmt::Display for UrdfError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n  --> {}", self.message, self.file.display())?;
        self.line.map_or(Ok(()), |line| write!(f, ":{line}"))
    }
}

impl std::error::Error for UrdfError {}

/// A fault within one file: its line, if it has one, and what is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    pub line: Option<usize>,
    pub message: String,
}

impl Fault {
    /// A fault of the element that begins in `line`.
    pub fn at(line: usize, message: impl Into<String>) -> Self {
        Self { line: Some(line), message: message.into() }
    }

    /// A fault of the file as a whole.
    pub fn of_file(message: impl Into<String>) -> Self {
        Self { line: None, message: message.into() }
    }

    pub fn within(self, file: &Path) -> UrdfError {
        UrdfError { file: file.to_owned(), line: self.line, message: self.message }
    }
}
