//! The stable grasps that `regrasp plan --grasps` keeps.

use crate::{Failure, export};
use regrasp::api::Slot;
use regrasp::export::{GraspRecord, Grasps};
use regrasp::run::{Run, Setup, scenario::Scenario};
use std::path::Path;

/// Refuses the name of a file of grasps that is neither JSON nor NumPy's, before any work is done.
pub fn check(path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("json" | "npz") => Ok(()),
        _ => Err(Failure::bad_input(format!(
            "`--grasps {}`: the file's name must end with `.json` or `.npz`",
            path.display()
        ))),
    }
}

/// Keeps the stable grasps of the run's manipulation graph.
pub fn save(path: &Path, scenario: &Scenario, setup: &Setup<'_>, run: &Run) -> Result<usize, Failure> {
    let graph = &run.outcome.graph;
    let mut records = Vec::new();
    for (number, q) in graph.nodes().iter().enumerate() {
        let margin = setup.margin(q).map_err(Failure::refused)?;
        // A given start may be no stable grasp of the stability test at rest; the cache holds stable ones
        // alone.
        if margin > 0.0 {
            let component = graph.component(regrasp::api::NodeId(number as u32)).0 as usize;
            records.push(GraspRecord { q: q.clone(), component, margin });
        }
    }
    let id = |slot: Slot| setup.choices().choice(slot).id.as_str();
    let grasps = Grasps {
        scenario: &scenario.name,
        hand: &scenario.problem.hand,
        stability_test: id(Slot::StabilityTest),
        contact_model: id(Slot::ContactModel),
        grasps: &records,
    };
    let name = path.display().to_string();
    let file = match path.extension().and_then(|extension| extension.to_str()) {
        Some("npz") => grasps.npz(&name).map_err(Failure::bad_input)?,
        _ => grasps.json(&name),
    };
    export::write(path, &file.bytes)?;
    Ok(records.len())
}
