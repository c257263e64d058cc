//! Why a roadmap is refused.

use regrasp_api::{Refusal, Refuse};
use regrasp_plan::WriteError;
use std::path::PathBuf;
use thiserror::Error;

/// What to do where a file is of no use.
const GROW: &str = "grow one with `regrasp roadmap SCENARIO -o FILE`";

/// A roadmap's file is refused.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RoadmapError {
    /// Reading.
    #[error("`{}`: {cause}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        cause: std::io::Error,
    },
    /// Something else.
    #[error("`{}` is no roadmap; {GROW}", path.display())]
    Foreign {
        /// Which file.
        path: PathBuf,
    },
    /// Written by a program that keeps roadmaps in another form.
    #[error(
        "`{}` is a roadmap of version {found}, and this program reads version {known}; {GROW}",
        path.display()
    )]
    Version {
        /// Which file.
        path: PathBuf,
        /// Its version.
        found: u32,
        /// The version that is read.
        known: u32,
    },
    /// Cut short.
    #[error("`{}` is cut short: it has {found} bytes of {needed}; copy it again, or {GROW}", path.display())]
    Truncated {
        /// Which file.
        path: PathBuf,
        /// Bytes that are there.
        found: u64,
        /// Bytes that should be there.
        needed: u64,
    },
    /// Changed since it was written.
    #[error("`{}` is damaged: {what}; copy it again, or {GROW}", path.display())]
    Damaged {
        /// Which file.
        path: PathBuf,
        /// What is wrong with it.
        what: &'static str,
    },
    /// Of another problem.
    #[error("`{}` was grown {}; {}", path.display(), difference.said(), difference.remedy())]
    Other {
        /// Which file.
        path: PathBuf,
        /// What is different.
        difference: Difference,
    },
    /// Writing.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// What a roadmap and a scenario do not share.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// The hand: the roadmap's, and the scenario's.
    Hand(String, String),
    /// The object: the roadmap's, and the scenario's.
    Object(String, String),
    /// Obstacles, gravity, load, limits, or plugins.
    Settings,
    /// Seed or workspace: it can be planned through, but not grown on.
    Sampling,
}

impl Difference {
    fn said(&self) -> String {
        match self {
            Self::Hand(of, here) if of == here => format!("for another hand of the name `{of}`"),
            Self::Hand(of, here) => format!("for the hand `{of}`, and the scenario's is `{here}`"),
            Self::Object(of, here) if of == here => {
                format!("for another object of the name `{of}`: its shape, mass or friction is different")
            }
            Self::Object(of, here) => format!("for the object `{of}`, and the scenario's is `{here}`"),
            Self::Settings => {
                "with other obstacles, gravity, `[hold]`, limits or plugins than the scenario's".into()
            }
            Self::Sampling => "with another seed, or in another workspace".into(),
        }
    }

    fn remedy(&self) -> String {
        match self {
            Self::Sampling => {
                "give the seed and workspace that it was grown with, name another file, or begin anew with \
                 `--force`"
                    .into()
            }
            _ => GROW.into(),
        }
    }

    fn key(&self) -> &'static str {
        match self {
            Self::Hand(..) => "hand",
            Self::Object(..) => "object",
            Self::Settings => "limits",
            Self::Sampling => "workspace",
        }
    }
}

impl Refuse for RoadmapError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::File { .. } | Self::Foreign { .. } => Refusal::new("file", self),
            Self::Version { found, known, .. } => Refusal::new("version", self).value(found).range(known),
            Self::Truncated { found, needed, .. } => {
                Refusal::new("truncated", self).value(found).range(needed)
            }
            Self::Damaged { .. } => Refusal::new("damaged", self),
            Self::Other { difference, .. } => {
                Refusal::new("other-roadmap", self).key(difference.key()).remedy(difference.remedy())
            }
            Self::Write(error) => error.refusal(),
        }
    }
}
