//! Why grasps cannot be looked for, or kept.

use regrasp_api::{CallError, Refusal, Refuse};
use regrasp_export::ExportError;
use regrasp_physics::PhysicsError;
use regrasp_run::RunError;
use std::path::PathBuf;
use thiserror::Error;

/// Why grasps cannot be looked for, or kept; that there are none is no error.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GraspsError {
    /// Scenario or plugins.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A plugin failed.
    #[error("{0}")]
    Call(CallError),
    /// A wish outside its range.
    #[error("`{key}` = {value} is outside {low}..={high}")]
    Range {
        /// Which.
        key: &'static str,
        /// Its value.
        value: f64,
        /// The lowest allowed value.
        low: f64,
        /// The highest allowed value.
        high: f64,
    },
    /// More fingers than there are, or fewer than the contact model needs.
    #[error(
        "{least} to {most} fingers are to hold; the contact model needs {fewest}, the hand has {fingers}"
    )]
    Fingers {
        /// How few were to hold.
        least: usize,
        /// How many were to hold at most.
        most: usize,
        /// The contact model's fewest contacts.
        fewest: usize,
        /// The hand's fingers.
        fingers: usize,
    },
    /// The problem makes no sense to the verifier.
    #[error("the verifier cannot judge grasps of this problem: {0}")]
    Verifier(regrasp_verify::SeriesError),
    /// Forces.
    #[error("no grasp forces: {0}")]
    Physics(#[from] PhysicsError),
    /// The model of another program.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// Reading or writing.
    #[error("`{}`: {cause}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        cause: std::io::Error,
    },
    /// What was kept of another search.
    #[error("`{}` is the begun search for other grasps; delete it, or give `--force`", path.display())]
    OtherSearch {
        /// The file.
        path: PathBuf,
    },
}

impl From<CallError> for GraspsError {
    fn from(error: CallError) -> Self {
        Self::Call(error)
    }
}

impl Refuse for GraspsError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Run(error) => error.refusal(),
            Self::Call(error) => error.refusal(),
            Self::Range { key, value, low, high } => {
                Refusal::new("range", self).key(*key).value(value).range(format!("{low}..={high}"))
            }
            Self::Fingers { least, most, fewest, fingers } => Refusal::new("range", self)
                .key("fingers")
                .value(format!("{least}..={most}"))
                .range(format!("{fewest}..={fingers}")),
            Self::Verifier(_) | Self::Physics(_) => Refusal::new("problem", self),
            Self::Export(_) => Refusal::new("export", self),
            Self::File { .. } => Refusal::new("file", self),
            Self::OtherSearch { .. } => Refusal::new("file", self).remedy("delete it, or give `--force`"),
        }
    }
}
