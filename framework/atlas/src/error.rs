//! Why an atlas cannot be made.

use regrasp_api::{Refusal, Refuse};
use regrasp_grasps::GraspsError;
use regrasp_plan::WriteError;
use regrasp_run::RunError;
use regrasp_run::scenario::ScenarioError;
use std::path::PathBuf;
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
    /// Reading or writing.
    #[error("`{}`: {cause}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        cause: std::io::Error,
    },
    /// What was kept of another atlas.
    #[error(
        "`{}` is the begun atlas of another command or of other hands; name another folder, or give \
         `--force`",
        path.display()
    )]
    OtherAtlas {
        /// The file.
        path: PathBuf,
    },
    /// A line that is no cell of this atlas.
    #[error("`{}`, line {line}: {reason}; delete the line, and its member is done again", path.display())]
    Journal {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
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
            Self::File { .. } => Refusal::new("file", self),
            Self::OtherAtlas { .. } => {
                Refusal::new("file", self).remedy("name another folder, or give `--force`")
            }
            Self::Journal { line, .. } => Refusal::new("file", self).line(Some(*line)),
            Self::Write(error) => error.refusal(),
        }
    }
}
