//! The runs of a study on several threads, each run on one of its own.

use super::timed::{self, Meter};
use super::{Folder, Prepared, RunKey, RunName, RunRecord, StudyError};
use regrasp_api::{Interrupt, take_fault};
use regrasp_plan::{Plan, StoppedBy};
use regrasp_planner::{Clock, Silent};
use regrasp_run::{RunOptions, Setup, Stop};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

/// How the threads are called that make runs: a program that wants to hear nothing of their panics, which become rows, can tell by this.
pub const RUN_THREAD: &str = "regrasp-run";

/// What a thread that plans may use: as much as the main thread of a program has.
const STACK: usize = 8 << 20;

/// Told how far a study is; all methods do nothing by default.
pub trait StudyProgress {
    /// Of `total` runs, `done` are there from before.
    fn begin(&self, done: usize, total: usize) {
        let _ = (done, total);
    }
    /// A run has ended and is kept.
    fn ended(&self, record: &RunRecord) {
        let _ = record;
    }
}

/// Tells nobody.
impl StudyProgress for Silent {}

/// What the runs of a study need.
#[derive(Clone, Copy)]
pub struct Execution<'a> {
    /// How many runs are made at once.
    pub threads: usize,
    /// Times runs, and ends them at the time limit.
    pub clock: &'a dyn Clock,
    /// Ends the study; runs that it ends are not kept.
    pub cancel: &'a dyn Interrupt,
    /// Told how far the study is.
    pub progress: &'a dyn StudyProgress,
}

/// Makes the runs that the folder does not hold yet, and keeps each there as soon as it has ended.
///
/// True where all are there at the end, false where [`Execution::cancel`] came before.
pub fn execute(
    prepared: &Prepared<'_>,
    folder: &mut Folder,
    with: &Execution<'_>,
) -> Result<bool, StudyError> {
    let mut keys = prepared.study.keys();
    let total = keys.len();
    keys.retain(|key| !folder.holds(*key));
    // Runs that are compared follow each other, so that whatever slows the machine down for a while slows down all of them; with each seed
    // another variant is first, since the first meets cold caches.
    let variants = prepared.study.variants.len() as u64;
    keys.sort_by_key(|key| (key.scenario, key.seed, key.seed.wrapping_add(key.variant as u64) % variants));
    with.progress.begin(total - keys.len(), total);
    let job = Job {
        prepared,
        clock: with.clock,
        cancel: with.cancel,
        tick_s: timed::tick_s(with.clock),
        keys,
        next: AtomicUsize::new(0),
        failed: AtomicBool::new(false),
    };
    make_and_keep(&job, folder, with)?;
    Ok(job.keys.iter().all(|key| folder.holds(*key)))
}

/// Makes the job's runs on several threads, and keeps them on this one.
fn make_and_keep(job: &Job<'_>, folder: &mut Folder, with: &Execution<'_>) -> Result<(), StudyError> {
    thread::scope(|scope| {
        let (sender, ended) = mpsc::channel();
        for _ in 0..with.threads.clamp(1, job.keys.len().max(1)) {
            let sender = sender.clone();
            let builder = thread::Builder::new().name(RUN_THREAD.into()).stack_size(STACK);
            // Where the system grants no more threads those that there are do the work; without any the first run is never made.
            let _ = builder.spawn_scoped(scope, move || job.work(&sender));
        }
        drop(sender);
        let kept = ended.iter().try_for_each(|run: Ended| {
            folder.keep(&job.prepared.study, run.key, &run.record, run.plan.as_ref())?;
            with.progress.ended(&run.record);
            Ok(())
        });
        job.failed.store(kept.is_err(), Ordering::Relaxed);
        kept
    })
}

/// A run that came to its end.
struct Ended {
    key: RunKey,
    record: RunRecord,
    /// The plan, where the study keeps it.
    plan: Option<Plan>,
}

/// Ends a run at its time limit, or with the study.
struct Deadline<'a> {
    clock: &'a dyn Clock,
    at_s: Option<f64>,
    cancel: &'a dyn Interrupt,
}

impl Interrupt for Deadline<'_> {
    fn interrupted(&self) -> bool {
        self.cancel.interrupted() || self.at_s.is_some_and(|at| self.clock.seconds() >= at)
    }
}

impl Stop for Deadline<'_> {
    fn cause(&self) -> StoppedBy {
        if self.cancel.interrupted() { StoppedBy::Interrupt } else { StoppedBy::TimeLimit }
    }
}

/// What the threads share.
struct Job<'a> {
    prepared: &'a Prepared<'a>,
    clock: &'a dyn Clock,
    cancel: &'a dyn Interrupt,
    /// How long reading the clock takes (s).
    tick_s: f64,
    /// The runs to be made, in this order.
    keys: Vec<RunKey>,
    /// Index of the run that is to be made next.
    next: AtomicUsize,
    /// Whether a run could not be kept, so that the others need not be made.
    failed: AtomicBool,
}

impl Job<'_> {
    /// Makes runs until none is left or the study ends.
    fn work(&self, ended: &mpsc::Sender<Ended>) {
        while !self.cancel.interrupted() && !self.failed.load(Ordering::Relaxed) {
            let next = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(run) = self.keys.get(next).and_then(|key| self.make(*key)) else { return };
            if ended.send(run).is_err() {
                return;
            }
        }
    }

    /// Makes a run; `None` where the study was cancelled meanwhile.
    fn make(&self, key: RunKey) -> Option<Ended> {
        let setup = self.prepared.setup(key).expect("a study has no runs of what it leaves out");
        let study = &self.prepared.study;
        let scenario = &study.scenarios[key.scenario];
        let variant = &study.variants[key.variant];
        let name = RunName { scenario: &scenario.name, variant: &variant.name, seed: key.seed };
        let limit_s = scenario.problem.limits.budget.time_limit;
        let at_s = limit_s.map(|limit| self.clock.seconds() + limit);
        let deadline = Deadline { clock: self.clock, at_s, cancel: self.cancel };
        let made = catch_unwind(AssertUnwindSafe(|| self.run(setup, name, &deadline)));
        let (record, plan) = made.unwrap_or_else(|payload| {
            // What the panic left on this thread belongs to it, not to the next run.
            take_fault();
            (RunRecord::of_panic(name, panic_message(payload.as_ref())), None)
        });
        let plan = plan.filter(|_| study.keeps_plan(key));
        (!self.cancel.interrupted()).then_some(Ended { key, record, plan })
    }

    fn run(&self, setup: &Setup<'_>, name: RunName<'_>, stop: &Deadline<'_>) -> (RunRecord, Option<Plan>) {
        let meter = Meter::new(self.clock, self.tick_s);
        let options = RunOptions { seed: name.seed, threads: 1, stop, clock: self.clock, progress: &Silent };
        match setup.run_by(&|request| timed::solve(request, &meter), &options) {
            Ok(run) => {
                let hand = setup.scenario().hand.as_ref();
                let record = RunRecord::of_run(name, &run, hand, meter.roles_s(run.planning_s));
                (record, run.plan)
            }
            Err(error) => (RunRecord::of_error(name, &error), None),
        }
    }
}

fn panic_message(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("(no message)")
}
