//! What was found so far, on disk: one line for each trial that has ended.

use crate::{Protocol, SuiteError, Trial};
use regrasp_plan::Journal;
use regrasp_run::scenario::Scenario;
use serde_json::json;
use std::path::Path;

/// Opens the journal of this protocol, run in this way, or begins it; the trials that have ended. `anew`
/// throws away what there is. Refuses that of other problems: files may have changed since.
pub fn journal(
    path: &Path,
    protocol: &Protocol,
    scenarios: &[Scenario],
    way: &str,
    anew: bool,
) -> Result<(Journal, Vec<Trial>), SuiteError> {
    let plugins = |scenario: &Scenario| format!("{:?}", scenario.choices);
    let head = json!({
        "format": "regrasp-suite-part",
        "version": 1,
        "regrasp": env!("CARGO_PKG_VERSION"),
        "protocol": protocol,
        "problems": scenarios.iter().map(|scenario| &scenario.problem).collect::<Vec<_>>(),
        "plugins": scenarios.iter().map(plugins).collect::<Vec<_>>(),
        "way": way,
    });
    Ok(Journal::open(path, &head, anew)?)
}
