//! Errors of the planner as exceptions with their data as fields.

use crate::roles::Stash;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use regrasp::api::{Refusal, Refuse};
use regrasp::host::HostError;
use regrasp::run::RunError;
use regrasp::run::scenario::ScenarioError;
use serde_json::{Value, json};

/// An exception of the package: the class of this name in `regrasp._errors`, its message, and its fields as
/// a JSON object.
pub fn exception(py: Python<'_>, class: &str, message: &str, fields: &Value) -> PyErr {
    let made = py
        .import("regrasp._errors")
        .and_then(|module| module.call_method1("make", (class, message, fields.to_string())));
    match made {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}

/// What a refusal says, as the fields of an exception.
fn fields(refusal: &Refusal) -> Value {
    json!({
        "code": refusal.code, "file": refusal.file, "line": refusal.line, "key": refusal.key,
        "value": refusal.value, "range": refusal.range, "remedy": refusal.remedy,
    })
}

/// The exception for a scenario that is refused.
pub fn scenario(py: Python<'_>, error: &ScenarioError) -> PyErr {
    exception(py, "ScenarioError", &error.to_string(), &fields(&error.refusal()))
}

/// The exception for a plugin that is refused.
pub fn host(py: Python<'_>, error: &HostError) -> PyErr {
    let mut fields = fields(&error.refusal());
    match error {
        HostError::UnknownPlugin { slot, id, near, known } => {
            let remedy = if near.is_empty() { known } else { near };
            fields["slot"] = json!(slot.name());
            fields["plugin"] = json!(id);
            fields["remedy"] = json!(remedy.join(", "));
        }
        HostError::UnknownSlot { name, near } => {
            fields["slot"] = json!(name);
            fields["remedy"] = json!(near.join(", "));
        }
        HostError::WrongSlot { slot, id, .. } => {
            fields["slot"] = json!(slot.name());
            fields["plugin"] = json!(id);
        }
        HostError::Settings { id, .. } | HostError::Build { id, .. } => fields["plugin"] = json!(id),
        _ => {}
    }
    exception(py, "PluginError", &error.to_string(), &fields)
}

/// The exception for a run that cannot be made; one that a plugin raised comes through as it is.
pub fn run(py: Python<'_>, error: &RunError, stash: &Stash) -> PyErr {
    stash.find(py, &error.to_string()).unwrap_or_else(|| of_run(py, error))
}

fn of_run(py: Python<'_>, error: &RunError) -> PyErr {
    match error {
        RunError::Scenario(error) => scenario(py, error),
        RunError::Host(error) => host(py, error),
        RunError::Call(_) => exception(py, "PluginError", &error.to_string(), &fields(&error.refusal())),
        error => exception(py, "RegraspError", &error.to_string(), &fields(&error.refusal())),
    }
}

/// The exception for a plan file that cannot be read, written or shown.
pub fn plan_file(py: Python<'_>, error: &impl ToString) -> PyErr {
    exception(py, "PlanFileError", &error.to_string(), &json!({}))
}

/// The exception for an argument that is refused.
pub fn argument(py: Python<'_>, key: &str, value: &str, range: &str) -> PyErr {
    let message = format!("`{key}` = {value} is outside {range}");
    exception(py, "ArgumentError", &message, &json!({"key": key, "value": value, "range": range}))
}

/// The exception for a panic that left the planner: a defect of the program.
pub fn defect(payload: &(dyn std::any::Any + Send)) -> PyErr {
    let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
    PyRuntimeError::new_err(format!("a defect of the planner, please report it: {text}"))
}
