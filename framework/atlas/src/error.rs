//! Why an atlas cannot be made.

use regrasp_api::{Refusal, Refuse};
use regrasp_grasps::GraspsError;
use regrasp_plan::{JournalError, WriteError};
use regrasp_run::RunError;
use regrasp_run::scenario::ScenarioError;
use thiserror::Error;

/// Why an atlas cannot be made; that a hand cannot hold an object is no error.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AtlasError {
    /// A hand.
    #[error(transparent)]
    Hand(ScenarioError),
    /// The same hand twice.
    #[error("`hands`: `{name}` is given twice; name each hand once")]
    Twice {
        /// Its name.
        name: String,
    },
    /// A list without entries.
    #[error("`{key}`: there is nothing in the list; give one or more")]
    Nothing {
        /// Which.
        key: &'static str,
    },
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
    /// A run that cannot be made.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Start grasps.
    #[error(transparent)]
    Grasps(#[from] GraspsError),
    /// What was found so far.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// Writing.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl Refuse for AtlasError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Hand(error) => error.refusal(),
            Self::Twice { name } => Refusal::new("value", self).key("hands").value(name),
            Self::Nothing { key } => Refusal::new("value", self).key(*key),
            Self::Range { key, value, low, high } => {
                Refusal::new("range", self).key(*key).value(value).range(format!("{low}..={high}"))
            }
            Self::Run(error) => error.refusal(),
            Self::Grasps(error) => error.refusal(),
            Self::Journal(error) => error.refusal(),
            Self::Write(error) => error.refusal(),
        }
    }
}
