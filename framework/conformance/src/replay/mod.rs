//! The call that broke a law in a real run, made again as a test.
//!
//! `regrasp plan … --audit-save case.json` keeps the first breach: the call with its input, and the whole
//! problem. Put the file beside the plugin's tests, and say
//!
//! ```text
//! #[test]
//! fn the_call_of_last_tuesday_keeps_the_law() {
//!     regrasp_conformance::assert_replay_keeps(&my_plugin::ENTRY, include_str!("case.json"));
//! }
//! ```
//!
//! The test fails until the plugin is mended, and stays as the test of that. Hand, object, obstacles, limits
//! and the plugin's settings are the file's. What a sampler or local planner asks of the other roles is
//! answered by the kit's references, which may lead it another way; a strategy's call needs the graph of its
//! run, and only the run itself (`regrasp plan … --audit` with the same seed) makes it again.

mod call;
mod input;

use crate::fixtures::Bench;
use regrasp_api::{BuildError, Entry, Problem, Slot, take_fault};
use regrasp_audit::{Auditor, Breach};
use serde_json::Value;
use thiserror::Error;

/// A case that cannot be replayed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ReplayError {
    /// Not a file that `--audit-save` wrote.
    #[error("`{key}`: {reason}; give the file that `regrasp plan … --audit-save FILE` wrote, as it is")]
    Form {
        /// Where in the file.
        key: String,
        /// What is wrong there.
        reason: String,
    },
    /// The plugin that broke the law fills another role.
    #[error("the case is of the slot `{slot}`, which `{plugin}` does not fill")]
    OtherRole {
        /// The slot.
        slot: &'static str,
        /// The plugin.
        plugin: &'static str,
    },
    /// A call that needs more than its input.
    #[error("`{call}` needs the graph of its run; run `regrasp plan … --audit` with the same seed")]
    NeedsTheRun {
        /// The method.
        call: String,
    },
    /// The plugin cannot be built for the problem.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// Makes the call of a case again with the plugin of `entry`, and gives the breach if it breaks a law still.
pub fn replay(entry: &Entry, case: &str) -> Result<Option<Breach>, ReplayError> {
    let case: Value = serde_json::from_str(case).map_err(|error| form("", error.to_string()))?;
    if case["format"] != "regrasp-audit-case" {
        return Err(form("format", "it is not `regrasp-audit-case`"));
    }
    let problem: Problem = parsed(&case["scenario"]["problem"], "scenario.problem")?;
    let slot: Slot = parsed(&case["breach"]["slot"], "breach.slot")?;
    if !entry.slots.contains(&slot) {
        return Err(ReplayError::OtherRole { slot: slot.name(), plugin: entry.id });
    }
    let bench = Bench::of(&problem).map_err(|error| form("scenario.problem", error.to_string()))?;
    let settings = &case["scenario"]["plugins"][slot.name()]["settings"];
    let settings = if settings.is_null() { String::new() } else { settings.to_string() };
    let auditor = Auditor::new(&bench.world.object, bench.radius(), [(slot, entry.id.to_owned())]);
    call::make(entry, &settings, slot, &bench, &auditor, &case["breach"])?;
    // Where a call returns no `Result`, the breach is this thread's fault.
    take_fault();
    Ok(auditor.breach())
}

/// Panics with the breach if the call of a case breaks a law still, or cannot be made.
pub fn assert_replay_keeps(entry: &Entry, case: &str) {
    match replay(entry, case) {
        Ok(None) => {}
        Ok(Some(breach)) => panic!("{}", breach.error()),
        Err(error) => panic!("{error}"),
    }
}

fn form(key: &str, reason: impl Into<String>) -> ReplayError {
    ReplayError::Form { key: key.to_owned(), reason: reason.into() }
}

fn parsed<T: serde::de::DeserializeOwned>(value: &Value, key: &str) -> Result<T, ReplayError> {
    serde_json::from_value(value.clone()).map_err(|error| form(key, error.to_string()))
}
