//! The laws of each role, and the list of plugins.

use crate::errors;
use crate::roles::{Stash, with_stash};
use crate::scenario::registry;
use crate::watch::{Watch, beside};
use pyo3::prelude::*;
use regrasp_conformance::{Demands, Outcome, check_with};
use serde_json::{Value, json};
use std::sync::Arc;

/// Puts a plugin through every law of its role; the report as JSON.
#[pyfunction]
pub fn conformance(
    py: Python<'_>,
    id: &str,
    settings: String,
    geodesic_tolerance: Option<f64>,
) -> PyResult<String> {
    let registry = registry().map_err(|error| errors::run(py, &error, &Stash::default()))?;
    let found = registry.find(id);
    let entry = found.ok_or_else(|| {
        errors::exception(py, "PluginError", &format!("there is no plugin `{id}`"), &json!({"plugin": id}))
    })?;
    let watch = Watch::start(None);
    let stash = Stash::new(&watch);
    let mut demands = Demands { settings, ..Demands::default() };
    demands.geodesic_tolerance = geodesic_tolerance.unwrap_or(demands.geodesic_tolerance);
    let report =
        beside(py, &watch, None, move || with_stash(&Arc::clone(&stash), || check_with(entry, &demands)))?;
    let row = |check: &regrasp_conformance::Check| {
        let (outcome, words) = match &check.outcome {
            Outcome::Passed => ("passed", ""),
            Outcome::Failed(words) => ("failed", words.as_str()),
            Outcome::NotApplicable(words) => ("not-applicable", words.as_str()),
        };
        json!({"name": check.name, "why": check.why, "outcome": outcome, "words": words})
    };
    let rows: Vec<Value> = report.checks.iter().map(row).collect();
    Ok(json!({"plugin": report.plugin, "checks": rows}).to_string())
}

/// Every plugin: id, slots, summary, references, and the JSON schema of its settings.
#[pyfunction]
pub fn plugins(py: Python<'_>) -> PyResult<String> {
    let registry = registry().map_err(|error| errors::run(py, &error, &Stash::default()))?;
    let row = |entry: &regrasp::api::Entry| {
        let schema: Value = serde_json::from_str(&(entry.schema)()).unwrap_or_default();
        let slots: Vec<&str> = entry.slots.iter().map(|slot| slot.name()).collect();
        json!({
            "id": entry.id, "slots": slots, "summary": entry.summary, "references": entry.references,
            "schema": schema,
        })
    };
    Ok(Value::Array(registry.entries().map(row).collect()).to_string())
}
