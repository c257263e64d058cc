//! Which hypotheses a study tests, chosen before looking.

use super::MeasureName;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which variants are compared with each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Pairs {
    /// Each with the first one.
    #[default]
    Baseline,
    /// Each with each.
    All,
}

impl Pairs {
    /// Every choice.
    pub const ALL: [Self; 2] = [Self::Baseline, Self::All];

    /// The name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::All => "all",
        }
    }
}

/// The band of practical equivalence unless a study says otherwise: a tenth of the first variant's median.
pub const DEFAULT_BAND: f64 = 0.1;

/// The family of hypotheses of a study: all pairs of variants (and, of a full factorial, its effects), in all
/// measures, on all scenarios, are corrected together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Hypotheses {
    /// Which variants are compared.
    pub pairs: Pairs,
    /// What is compared; every measure that the runs have where empty.
    pub measures: Vec<MeasureName>,
    /// Differences within this share of the first variant's median count as practically none (0..=1). Of the
    /// share of solved runs it is the share itself, of figures that are shares of a limit likewise.
    pub band: f64,
}

impl Default for Hypotheses {
    fn default() -> Self {
        Self { pairs: Pairs::Baseline, measures: Vec::new(), band: DEFAULT_BAND }
    }
}
