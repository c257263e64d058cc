//! What can go wrong with a plan file, and what to do about it.

use regrasp_api::{Refusal, Refuse};
use std::{io, path::PathBuf};
use thiserror::Error;

/// A plan file cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// There is no such file.
    #[error("`{}` does not exist; `plan SCENARIO -o PLAN` makes a plan file", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// The file cannot be read.
    #[error("`{}` cannot be read: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The path is a folder.
    #[error("`{}` is a folder; give the plan file in it", path.display())]
    IsFolder {
        /// The folder.
        path: PathBuf,
    },
    /// The file is empty.
    #[error("`{}` is empty; `plan SCENARIO -o PLAN` makes a plan file", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The text ends in the middle.
    #[error(
        "`{}` is truncated: it ends in line {line}, in the middle of the plan; copy it again or make it \
            anew", path.display()
    )]
    Truncated {
        /// The file.
        path: PathBuf,
        /// The last line, counted from 1.
        line: usize,
    },
    /// Not JSON.
    #[error(
        "`{}` is not JSON: {message}; {}",
        path.display(),
        if path.extension().is_some_and(|extension| extension == "toml") {
            "of a scenario, `plan SCENARIO -o PLAN` makes a plan file"
        } else {
            "a plan file is made by `plan SCENARIO -o PLAN`"
        }
    )]
    Syntax {
        /// The file.
        path: PathBuf,
        /// What and where.
        message: String,
    },
    /// JSON, but not a plan.
    #[error(
        "`{}` is not a plan file: `format` is {found}, not \"regrasp-plan\"; a plan file is made by `plan \
            SCENARIO -o PLAN`",
        path.display()
    )]
    Format {
        /// The file.
        path: PathBuf,
        /// What it says instead.
        found: String,
    },
    /// A plan of another version.
    #[error(
        "`{}` is a plan of format version {found}, this program reads versions {} to {known}; use the \
            program that made it, or plan again",
        path.display(),
        crate::OLDEST_VERSION
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// The file's version.
        found: String,
        /// The newest that this program reads.
        known: u32,
    },
    /// A plan whose content does not have the format's form.
    #[error("`{}` does not have the form of a plan: {message}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What and where.
        message: String,
    },
}

/// A plan file cannot be written. What was in its place before is untouched.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// A number of the plan is NaN or infinite, which the format cannot hold.
    #[error("the plan is not written: {place} is not a finite number")]
    NotFinite {
        /// Which number.
        place: String,
    },
    /// The disk is full.
    #[error("`{}` is not written: no space is left there; free some or choose another place", path.display())]
    DiskFull {
        /// The file.
        path: PathBuf,
    },
    /// The folder does not exist.
    #[error("`{}` is not written: its folder does not exist; create it first", path.display())]
    NoFolder {
        /// The file.
        path: PathBuf,
    },
    /// The path is a folder.
    #[error("`{}` is not written: it is a folder; give a file name", path.display())]
    IsFolder {
        /// The folder.
        path: PathBuf,
    },
    /// Anything else.
    #[error("`{}` is not written: {source}", path.display())]
    Failed {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

impl Refuse for ReadError {
    fn refusal(&self) -> Refusal {
        let (code, path) = match self {
            Self::Missing { path } => ("missing-file", path),
            Self::Unreadable { path, .. } => ("unreadable", path),
            Self::IsFolder { path } => ("is-folder", path),
            Self::Empty { path } => ("empty-file", path),
            Self::Truncated { path, .. } => ("truncated", path),
            Self::Syntax { path, .. } => ("syntax", path),
            Self::Format { path, .. } => ("not-a-plan", path),
            Self::Version { path, .. } => ("plan-version", path),
            Self::Content { path, .. } => ("plan-content", path),
        };
        let refusal = Refusal::new(code, self).file(path.display());
        match self {
            Self::Truncated { line, .. } => refusal.line(Some(*line)),
            Self::Format { found, .. } => refusal.key("format").value(found),
            Self::Version { found, known, .. } => {
                refusal.key("version").value(found).range(format!("{}..={known}", crate::OLDEST_VERSION))
            }
            _ => refusal,
        }
    }
}

impl Refuse for WriteError {
    fn refusal(&self) -> Refusal {
        let (code, path) = match self {
            Self::NotFinite { place } => return Refusal::new("not-finite", self).key(place),
            Self::DiskFull { path } => ("disk-full", path),
            Self::NoFolder { path } => ("no-folder", path),
            Self::IsFolder { path } => ("is-folder", path),
            Self::Failed { path, .. } => ("not-written", path),
        };
        Refusal::new(code, self).file(path.display())
    }
}
