//! Grasps in bulk, as the bytes of an archive of numpy arrays.

use crate::errors;
use crate::roles::{Stash, with_stash};
use crate::run::Changes;
use crate::scenario::{Scenario, registry};
use crate::watch::{Watch, beside};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use regrasp::api::Refuse;
use regrasp::grasps::write::{Rows, Set, npz};
use regrasp::grasps::{
    BulkGrasp, Edge, GraspSource, GraspsError, Kept, Progress, Search, Sink, Wish, collect,
};
use regrasp::run::{Setup, scenario};
use std::io;
use std::sync::Arc;

/// What is asked for.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
    count: usize,
    seed: u64,
    spread: f64,
    per_pose: usize,
    per_facet: Option<usize>,
    fingers: Option<(usize, usize)>,
    graph: bool,
}

impl Asked {
    fn wish(&self) -> Wish {
        Wish {
            count: self.count,
            seed: self.seed,
            spread: self.spread,
            per_pose: self.per_pose,
            per_facets: self.per_facet,
            fingers: self.fingers,
            graph: self.graph,
        }
    }
}

/// Grasps in memory.
#[derive(Default)]
struct Held {
    grasps: Vec<BulkGrasp>,
    edges: Vec<Edge>,
}

impl Sink for Held {
    fn take(&mut self, kept: &Kept) -> Result<(), GraspsError> {
        self.grasps.extend(kept.grasps.iter().cloned());
        self.edges.extend(&kept.edges);
        Ok(())
    }
}

impl Rows for Held {
    fn each(&self, take: &mut dyn FnMut(&BulkGrasp) -> io::Result<()>) -> io::Result<()> {
        self.grasps.iter().try_for_each(take)
    }

    fn each_edge(&self, take: &mut dyn FnMut(&Edge) -> io::Result<()>) -> io::Result<()> {
        self.edges.iter().try_for_each(take)
    }
}

struct Silent;

impl Progress for Silent {
    fn found(&self, _grasps: u64, _poses: u64) {}
}

/// Distinct, verified grasps of a scenario's hand and object: the bytes of what `regrasp grasps` writes as
/// `.npz`; fewer than were asked for where there are no more, or the time is over.
#[pyfunction]
pub fn grasps<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    asked: Asked,
    threads: usize,
    changes: Changes,
) -> PyResult<Bound<'py, PyBytes>> {
    if !(1..=256).contains(&threads) {
        return Err(errors::argument(py, "threads", &threads.to_string(), "1..=256"));
    }
    changes.check(py)?;
    let problem = changes.apply(&scenario.0).map_err(|error| errors::host(py, &error))?;
    let watch = Watch::start(problem.problem.limits.budget.time_limit);
    let stash = Stash::new(&watch);
    let (theirs, plugins) = (Arc::clone(&watch), Arc::clone(&stash));
    let job = move || with_stash(&plugins, || found(&problem, &asked.wish(), threads, &theirs));
    let bytes = beside(py, &watch, None, job)?.map_err(|error| refused(py, &error, &stash))?;
    Ok(PyBytes::new(py, &bytes))
}

fn refused(py: Python<'_>, error: &GraspsError, stash: &Stash) -> PyErr {
    match error {
        GraspsError::Run(error) => errors::run(py, error, stash),
        GraspsError::Call(call) => errors::run(py, &regrasp::run::RunError::Call(call.clone()), stash),
        error => {
            let refusal = error.refusal();
            let text = |field: &Option<String>| field.clone().unwrap_or_default();
            errors::argument(py, &text(&refusal.key), &text(&refusal.value), &text(&refusal.range))
        }
    }
}

fn found(
    scenario: &scenario::Scenario,
    wish: &Wish,
    threads: usize,
    watch: &Watch,
) -> Result<Vec<u8>, GraspsError> {
    let setup = Setup::without_ends(scenario, &scenario.choices, &registry()?)?;
    let source = GraspSource::new(&setup, wish)?;
    let (mut search, mut held) = (Search::new(&source), Held::default());
    collect(&mut search, threads, watch, &Silent, &mut held)?;
    let (layout, mut bytes) = (source.layout(), Vec::new());
    let info = serde_json::json!({
        "format": "regrasp-grasps", "version": 2, "seed": wish.seed, "spread": wish.spread,
    });
    let (info, problem) = (info.to_string(), serde_json::json!(source.plan()).to_string());
    let set = Set {
        rows: &held,
        grasps: held.grasps.len() as u64,
        edges: wish.graph.then_some(held.edges.len() as u64),
        hand: &scenario.problem.hand,
        layout: &layout,
        info: &info,
        problem: &problem,
    };
    let written = npz(&set, &mut bytes);
    written.expect("memory can be written to");
    Ok(bytes)
}
