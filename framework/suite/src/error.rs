//! Why a protocol cannot be run.

use regrasp_api::{Refusal, Refuse, did_you_mean, near};
use regrasp_host::HostError;
use regrasp_plan::StateError;
use regrasp_run::RunError;
use regrasp_run::scenario::ScenarioError;
use std::sync::Arc;
use thiserror::Error;

/// Why a protocol cannot be run; that a problem is not solved is no error.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum SuiteError {
    /// No such protocol.
    #[error("there is no protocol `{name}`; {}", hint(name, known))]
    Unknown {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<&'static str>,
    },
    /// A file.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// A preset.
    #[error("`{series}`: {error}")]
    Preset {
        /// The series.
        series: String,
        /// What is wrong.
        error: Arc<HostError>,
    },
    /// A run that cannot be made.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A plan whose end cannot be read.
    #[error(transparent)]
    Plan(#[from] StateError),
    /// A replay that cannot be made.
    #[error("a plan of `{series}` cannot be replayed: {}", why.message)]
    Replay {
        /// The series.
        series: String,
        /// Why, as whoever replays says it in fields.
        why: Box<Refusal>,
    },
}

fn hint(name: &str, known: &[&str]) -> String {
    match did_you_mean(&near(name, known.iter().copied())) {
        none if none.is_empty() => format!("there are: {}", known.join(", ")),
        hint => hint,
    }
}

impl Refuse for SuiteError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Unknown { name, known } => {
                Refusal::new("unknown", self).key("protocol").value(name).range(known.join(", "))
            }
            Self::Scenario(error) => error.refusal(),
            Self::Preset { error, .. } => error.refusal().told(self),
            Self::Run(error) => error.refusal(),
            Self::Plan(_) => Refusal::new("replay", self),
            Self::Replay { why, .. } => (**why).clone().told(self),
        }
    }
}
