//! A study from a program of one's own: no command line in between.

use regrasp::api::Uninterrupted;
use regrasp::host::Registry;
use regrasp::planner::{Clock, Silent};
use regrasp::run::scenario;
use regrasp::study::compare::{
    Change, Draft, Execution, Folder, Machine, RUN_THREAD, RunStatus, Seeds, execute, factorial, prepare,
};
use std::collections::BTreeMap;
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

fn draft(factors: &[Vec<Change>]) -> Draft {
    Draft {
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
    let mut prepared = prepare(draft(&[]), &scenarios, &registry).expect("the defaults work");
    let place = tempfile::tempdir().expect("a temporary folder");
    let mut folder = Folder::open(place.path(), &mut prepared.study).expect("the folder is new");
    let clock = Faulty(AtomicUsize::new(0));
    let with = Execution {
        threads: 1,
        clock: &clock,
        cancel: &Uninterrupted,
        progress: &Silent,
        audit: false,
        keep_plans: false,
        isolate: None,
        isolate_all: false,
    };
    assert!(execute(&prepared, &mut folder, &with).expect("the folder can be written to"));
    folder.finish(&prepared.study).expect("the folder can be written to");
    let records = folder.records();
    let seeds: Vec<u64> = records.iter().map(|record| record.seed).collect();
    assert_eq!(seeds, [3, 4, 5, 6]);
    assert_eq!(records[0].status, RunStatus::Panic);
    assert_eq!(records[0].message.as_deref().map(|text| text.contains("the clock broke")), Some(true));
    assert!(records[1..].iter().all(|record| record.is_success()));
}
