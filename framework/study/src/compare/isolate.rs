//! Runs in a process of their own: one that ends its process is a row of the study, not its end.

use super::{RunKey, RunRecord};
use regrasp_plan::Plan;
use serde::{Deserialize, Serialize};

/// A run that came to its end: what the process that made it hands back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Made {
    /// The row.
    pub record: RunRecord,
    /// The plan, where there is one.
    pub plan: Option<Plan>,
}

/// What became of a run in a process of its own.
#[derive(Clone, Debug, PartialEq)]
pub enum Isolated {
    /// It came to its end.
    Made(Box<Made>),
    /// The process ended before, as the text says.
    Died(String),
    /// The study was interrupted meanwhile.
    Interrupted,
}

/// Makes runs in processes of their own; the command line does, a library starts none.
pub trait Isolate: Sync {
    /// Makes one run.
    fn run(&self, key: RunKey) -> Isolated;
}
