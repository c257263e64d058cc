//! Studies: every scenario, planned by every variant, with every seed.

use crate::errors;
use crate::roles::{Stash, with_stash};
use crate::scenario::{Scenario, registry};
use crate::watch::{Watch, beside};
use pyo3::prelude::*;
use regrasp::api::Interrupt;
use regrasp::host::{HostError, preset, slot_by_name};
use regrasp::run::scenario;
use regrasp::study::compare::{
    self, Change, Execution, Folder, Machine, PRESET, RunRecord, Seeds, Shard, StudyError, StudyProgress,
    StudyWish, fingerprint,
};
use serde_json::{Map, json};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

/// One level of a factor: slot, plugin, and settings as JSON; or `preset` and its name.
type Level = (String, Option<String>, Vec<(String, String)>);

/// What is to be compared, and where.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Request {
    /// For each factor its levels.
    factors: Vec<Vec<Level>>,
    seeds: u64,
    first_seed: u64,
    time_limit: Option<f64>,
    threads: usize,
    shard: Option<(u64, u64)>,
    skip_unsupported: bool,
    /// Versions of what computes besides this package, by name: files of plugins with their digests.
    versions: BTreeMap<String, String>,
    output: PathBuf,
}

impl Request {
    fn levels(&self) -> Result<Vec<Vec<compare::Level>>, HostError> {
        let level = |(slot, id, settings): &Level| {
            if slot == PRESET {
                return preset(id.as_deref().unwrap_or_default()).map(compare::Level::Preset);
            }
            let value = |text: &String| serde_json::from_str(text).unwrap_or_default();
            let settings: Map<_, _> = settings.iter().map(|(key, text)| (key.clone(), value(text))).collect();
            Ok(compare::Level::Change(Change { slot: slot_by_name(slot)?, id: id.clone(), settings }))
        };
        self.factors.iter().map(|levels| levels.iter().map(level).collect()).collect()
    }

    fn wish(&self) -> Result<StudyWish, HostError> {
        let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        let mut versions = self.versions.clone();
        versions.insert("regrasp".into(), env!("CARGO_PKG_VERSION").into());
        Ok(StudyWish {
            command: vec!["regrasp.compare".into()],
            versions,
            machine: machine(self.threads),
            started_s: seconds,
            shard: self.shard.map(|(part, of)| Shard { part, of }),
            variants: compare::factorial(&self.levels()?),
            seeds: Seeds { first: self.first_seed, count: self.seeds },
            time_limit_s: self.time_limit,
            skip_unsupported: self.skip_unsupported,
            hypotheses: compare::Hypotheses::default(),
        })
    }
}

fn machine(threads: usize) -> Machine {
    Machine {
        host: String::new(),
        os: std::env::consts::OS.to_owned(),
        arch: std::env::consts::ARCH.to_owned(),
        cpu: String::new(),
        cores: std::thread::available_parallelism().map_or(1, usize::from),
        threads,
    }
}

/// Counts the runs that have ended.
struct Count<'a> {
    watch: &'a Watch,
    done: AtomicUsize,
    total: AtomicUsize,
}

impl StudyProgress for Count<'_> {
    fn begin(&self, done: usize, total: usize) {
        self.done.store(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
    }

    fn ended(&self, _: &RunRecord) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.watch.study(done, self.total.load(Ordering::Relaxed));
    }
}

/// Makes what is missing of a study in its folder; true where all of it is there. `callback("study", 0,
/// done, total)`.
#[pyfunction]
pub fn run_study(
    py: Python<'_>,
    scenarios: Vec<PyRef<'_, Scenario>>,
    request: Request,
    callback: Option<&Bound<'_, PyAny>>,
) -> PyResult<bool> {
    let scenarios: Vec<_> = scenarios.iter().map(|scenario| scenario::Scenario::clone(&scenario.0)).collect();
    let wish = request.wish().map_err(|error| errors::host(py, &error))?;
    let registry = registry().map_err(|error| errors::run(py, &error, &Stash::default()))?;
    let watch = Watch::start(None);
    let (stash, theirs) = (Stash::new(&watch), Arc::clone(&watch));
    let job = move || {
        with_stash(&stash, || {
            let mut prepared = compare::prepare(wish, &scenarios, &registry)?;
            let mut folder = Folder::open(&request.output, &mut prepared.study)?;
            let progress = Count { watch: &theirs, done: AtomicUsize::new(0), total: AtomicUsize::new(0) };
            let (clock, interrupt): (&Watch, &dyn Interrupt) = (&theirs, theirs.as_ref());
            let with = Execution {
                threads: request.threads,
                clock,
                // Python's own memory is not the planner's.
                memory: None,
                interrupt,
                progress: &progress,
                audit: false,
                keep_plans: false,
                // Plugins in Python live in this process.
                isolate: None,
                isolate_all: false,
            };
            let complete = compare::execute(&prepared, &mut folder, &with)?;
            folder.finish(&prepared.study)?;
            Ok(complete)
        })
    };
    beside(py, &watch, callback, job)?.map_err(|error| refused(py, &error))
}

/// Joins the parts of a study into the folder `output`.
#[pyfunction]
pub fn merge_studies(py: Python<'_>, parts: Vec<PathBuf>, output: PathBuf) -> PyResult<()> {
    py.detach(|| compare::merge(&parts, &output)).map(drop).map_err(|error| refused(py, &error))
}

/// The digest of bytes that studies record of what computes.
#[pyfunction]
pub fn digest(bytes: &[u8]) -> String {
    fingerprint(bytes)
}

fn refused(py: Python<'_>, error: &StudyError) -> PyErr {
    errors::exception(py, "StudyError", &error.to_string(), &json!({}))
}
