//! Scenarios, checked.

use crate::errors;
use crate::roles::{self, Stash};
use pyo3::prelude::*;
use regrasp::host::Registry;
use regrasp::run::RunError;
use regrasp::run::scenario::{self, SCENARIOS};
use serde_json::{Map, Value, json};
use std::path::PathBuf;
use std::sync::Arc;

/// A checked scenario: it stands alone, with no file left to read.
#[pyclass(frozen, module = "regrasp._regrasp")]
pub struct Scenario(pub Arc<scenario::Scenario>);

/// The plugins that a scenario may name.
pub fn registry() -> Result<Registry, RunError> {
    let linked = Registry::linked()?;
    Ok(Registry::new(linked.entries().chain(roles::entries()))?)
}

#[pymethods]
impl Scenario {
    /// The built-in scenario of this name, or else the file.
    #[staticmethod]
    fn load(py: Python<'_>, name: &str) -> PyResult<Self> {
        let registry = registry().map_err(|error| errors::run(py, &error, &Stash::default()))?;
        let loaded = py.detach(|| scenario::load(name, &registry));
        loaded.map(|loaded| Self(Arc::new(loaded))).map_err(|error| errors::scenario(py, &error))
    }

    /// A scenario from TOML or JSON text; `file` is what messages call it, `folder` where its files are
    /// looked for.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, file: &str, folder: PathBuf) -> PyResult<Self> {
        let registry = registry().map_err(|error| errors::run(py, &error, &Stash::default()))?;
        let parsed = py.detach(|| scenario::from_text(file, text, &folder, &registry));
        parsed.map(|parsed| Self(Arc::new(parsed))).map_err(|error| errors::scenario(py, &error))
    }

    /// What was chosen because neither the scenario nor its files say it.
    fn remarks(&self) -> Vec<String> {
        self.0.remarks.clone()
    }

    /// Name, summary, source, the resolved problem and the plugins, as JSON.
    fn describe(&self) -> String {
        let scenario = &self.0;
        let plugins = scenario.choices.iter().map(|(slot, choice)| (slot.name().to_owned(), json!(choice)));
        json!({
            "name": scenario.name,
            "summary": scenario.summary,
            "source": scenario.source,
            "problem": scenario.problem,
            "plugins": Value::Object(plugins.collect::<Map<_, _>>()),
        })
        .to_string()
    }
}

/// Name, summary and TOML text of every built-in scenario.
#[pyfunction]
pub fn scenarios() -> Vec<(&'static str, &'static str)> {
    SCENARIOS.iter().map(|built_in| (built_in.name, built_in.text)).collect()
}
