//! Planning.

use crate::plan::Plan;
use crate::roles::{Stash, with_stash};
use crate::scenario::{Scenario, registry};
use crate::watch::{Watch, beside};
use crate::{answer, errors};
use pyo3::prelude::*;
use regrasp::host::{Choices, HostError, preset, slot_by_name};
use regrasp::run::{Run, RunError, RunOptions, Setup, scenario};
use std::sync::Arc;

/// What a run gives: its plan if there is one, and the rest as JSON.
#[pyclass(frozen, module = "regrasp._regrasp")]
pub struct Solved {
    /// The plan, certificate included.
    #[pyo3(get)]
    plan: Option<Py<Plan>>,
    /// How the run ended, with its figures.
    #[pyo3(get)]
    summary: String,
}

/// What a caller changes in a scenario.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Changes {
    /// A preset's name; it comes first.
    preset: Option<String>,
    /// Slot and plugin.
    uses: Vec<(String, String)>,
    /// Slot, key and value as JSON.
    settings: Vec<(String, String, String)>,
    /// Seconds.
    time_limit: Option<f64>,
    /// Nodes for each goal.
    max_nodes: Option<usize>,
}

impl Changes {
    /// The scenario with these changes.
    pub fn apply(&self, scenario: &Arc<scenario::Scenario>) -> Result<Arc<scenario::Scenario>, HostError> {
        let budget = &scenario.problem.limits.budget;
        let same_budget = self.max_nodes.is_none_or(|nodes| nodes == budget.max_nodes)
            && self.time_limit.is_none_or(|limit| Some(limit) == budget.time_limit);
        if same_budget && self.preset.is_none() && self.uses.is_empty() && self.settings.is_empty() {
            return Ok(Arc::clone(scenario));
        }
        let mut changed = scenario::Scenario::clone(scenario);
        let budget = &mut changed.problem.limits.budget;
        budget.max_nodes = self.max_nodes.unwrap_or(budget.max_nodes);
        budget.time_limit = self.time_limit.or(budget.time_limit);
        self.choose(&mut changed.choices)?;
        Ok(Arc::new(changed))
    }

    fn choose(&self, choices: &mut Choices) -> Result<(), HostError> {
        if let Some(name) = &self.preset {
            preset(name)?.apply(choices);
        }
        for (slot, id) in &self.uses {
            choices.use_plugin(slot_by_name(slot)?, id);
        }
        for (slot, key, value) in &self.settings {
            let value = serde_json::from_str(value).unwrap_or_default();
            choices.set(slot_by_name(slot)?, key, value);
        }
        Ok(())
    }

    /// Refuses limits outside of their ranges.
    pub fn check(&self, py: Python<'_>) -> PyResult<()> {
        if let Some(limit) = self.time_limit.filter(|limit| !(0.001..=1e7).contains(limit)) {
            return Err(errors::argument(py, "time_limit", &limit.to_string(), "0.001..=10000000 s"));
        }
        if let Some(nodes) = self.max_nodes.filter(|nodes| !(1..=10_000_000).contains(nodes)) {
            return Err(errors::argument(py, "max_nodes", &nodes.to_string(), "1..=10000000"));
        }
        Ok(())
    }
}

/// Plans and verifies, without the GIL; `callback(stage, goal, nodes, components)` is told how far it is.
#[pyfunction]
pub fn solve(
    py: Python<'_>,
    scenario: &Scenario,
    seed: u64,
    threads: usize,
    changes: Changes,
    callback: Option<&Bound<'_, PyAny>>,
) -> PyResult<Solved> {
    changes.check(py)?;
    if !(1..=256).contains(&threads) {
        return Err(errors::argument(py, "threads", &threads.to_string(), "1..=256"));
    }
    let scenario = changes.apply(&scenario.0).map_err(|error| errors::host(py, &error))?;
    let watch = Watch::start(scenario.problem.limits.budget.time_limit);
    let (theirs, problem) = (Arc::clone(&watch), Arc::clone(&scenario));
    let stash = Stash::new(&watch);
    let plugins = Arc::clone(&stash);
    let job = move || with_stash(&plugins, || run(&problem, seed, threads, &theirs));
    let mut run = beside(py, &watch, callback, job)?.map_err(|error| errors::run(py, &error, &stash))?;
    let plan = run.plan.take();
    let summary = answer::summary(&scenario, &run).to_string();
    Ok(Solved { plan: plan.map(|plan| Py::new(py, Plan::new(plan))).transpose()?, summary })
}

fn run(scenario: &scenario::Scenario, seed: u64, threads: usize, watch: &Watch) -> Result<Run, RunError> {
    let setup = Setup::new(scenario, &scenario.choices, &registry()?)?;
    setup.run(&RunOptions { seed, threads, stop: watch, clock: watch, progress: watch })
}
