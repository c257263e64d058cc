//! Studies from a program of one's own: no command line in between.

use regrasp::Stopwatch;
use regrasp::api::{Slot, Uninterrupted};
use regrasp::host::Registry;
use regrasp::planner::{Clock, Silent};
use regrasp::run::scenario;
use regrasp::study::compare::{
    Change, Execution, Folder, Level, Machine, RUN_THREAD, RunStatus, Seeds, StudyWish, execute, factorial,
    prepare,
};
use regrasp_example_plugins as _;
use std::collections::BTreeMap;
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// A clock whose fifth reading by a run panics: a fault of the framework, not of a plugin.
struct Faulty(AtomicUsize);

impl Clock for Faulty {
    fn seconds(&self) -> f64 {
        if thread::current().name() == Some(RUN_THREAD) {
            assert_ne!(self.0.fetch_add(1, Ordering::Relaxed), 5, "the clock broke");
        }
        0.0
    }
}

/// How a study of a test is carried out.
fn with(clock: &(dyn Clock + Sync)) -> Execution<'_> {
    Execution {
        threads: 1,
        clock,
        memory: None,
        interrupt: &Uninterrupted,
        progress: &Silent,
        audit: false,
        keep_plans: false,
        isolate: None,
        isolate_all: false,
    }
}

fn wish(factors: &[Vec<Level>]) -> StudyWish {
    StudyWish {
        command: vec!["a test".into()],
        versions: BTreeMap::new(),
        machine: Machine::default(),
        started_s: 0,
        shard: None,
        variants: factorial(factors),
        seeds: Seeds { first: 3, count: 4 },
        time_limit_s: None,
        skip_unsupported: false,
        hypotheses: Default::default(),
    }
}

#[test]
fn a_panic_of_the_framework_is_a_row_and_the_study_goes_on() {
    let registry = Registry::linked().expect("the built-in plugins differ");
    let scenarios = [scenario::load("sphere-free", &registry).expect("it is built in")];
    let mut prepared = prepare(wish(&[]), &scenarios, &registry).expect("the defaults work");
    let place = tempfile::tempdir().expect("a temporary folder");
    let mut folder = Folder::open(place.path(), &mut prepared.study).expect("the folder is new");
    let clock = Faulty(AtomicUsize::new(0));
    assert!(execute(&prepared, &mut folder, &with(&clock)).expect("the folder can be written to"));
    folder.finish(&prepared.study).expect("the folder can be written to");
    let records = folder.records();
    let seeds: Vec<u64> = records.iter().map(|record| record.seed).collect();
    assert_eq!(seeds, [3, 4, 5, 6]);
    assert_eq!(records[0].status, RunStatus::Panic);
    assert_eq!(records[0].message.as_deref().map(|text| text.contains("the clock broke")), Some(true));
    assert!(records[1..].iter().all(|record| record.is_success()));
}

/// The cells of a line; a comma between quotes ends none.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        quoted ^= c == '"';
        match (c, cells.last_mut()) {
            (',', _) if !quoted => cells.push(String::new()),
            (c, Some(cell)) => cell.push(c),
            _ => {}
        }
    }
    cells
}

/// Two of the example plugins note figures of their own: they have columns, and boxes with a test.
#[test]
fn figures_of_example_plugins_are_in_the_report() {
    let registry = Registry::linked().expect("the plugins differ");
    let scenarios = [scenario::load("sphere", &registry).expect("it is built in")];
    let change =
        |slot, id: &str| Level::Change(Change { slot, id: Some(id.into()), settings: Default::default() });
    let factors =
        [vec![change(Slot::TransferPlanner, "guarded")], vec![change(Slot::RegraspPlanner, "roadmap")]];
    let mut prepared = prepare(wish(&factors), &scenarios, &registry).expect("the plugins are linked");
    let place = tempfile::tempdir().expect("a temporary folder");
    let mut folder = Folder::open(place.path(), &mut prepared.study).expect("the folder is new");
    assert!(
        execute(&prepared, &mut folder, &with(&Stopwatch::start())).expect("the folder can be written to")
    );
    folder.finish(&prepared.study).expect("the folder can be written to");
    let read = |name: &str| fs::read_to_string(place.path().join(name)).expect("it was written");
    let (runs, report) = (read("runs.csv"), read("report.html"));
    let head = runs.lines().next().expect("a header");
    for (slot, figure) in [("transfer", "joint_reserve"), ("regrasp", "roadmap_nodes")] {
        let column = format!("local-planner.{slot}.note.{figure}");
        let place = head.split(',').position(|name| name == column);
        let place = place.unwrap_or_else(|| panic!("`{column}` is no column of {head}"));
        let values = runs.lines().skip(1).map(|line| cells(line).swap_remove(place));
        assert!(values.filter(|value| value.parse::<f64>().is_ok()).count() >= 3, "{column}: {runs}");
        assert!(report.contains(&format!("{figure} (local-planner.{slot})")), "{figure}");
    }
}
