//! The runs of a study on several threads, each run on one of its own.

use super::begun::Begun;
use super::machinery::{Machinery, Means};
use super::{Folder, Isolate, Isolated, Made, Memory, Prepared, RunKey, RunRecord, StudyError};
use regrasp_api::Interrupt;
use regrasp_planner::{Clock, Silent};
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

/// How the threads are called that make runs: a program that wants to hear nothing of their panics, which
/// become rows, can tell by this.
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
    /// Tells how much memory a run has in use; without it that is not known.
    pub memory: Option<&'a dyn Memory>,
    /// Ends the study; runs that it ends are not kept.
    pub interrupt: &'a dyn Interrupt,
    /// Told how far the study is.
    pub progress: &'a dyn StudyProgress,
    /// Whether every call of a plugin is held against its role's laws; a breach makes the run an error.
    pub audit: bool,
    /// Whether the plan of every run is kept, and not only the baseline's.
    pub keep_plans: bool,
    /// Makes runs in processes of their own. Without it, a run in whose midst an earlier process ended is a
    /// failed row.
    pub isolate: Option<&'a dyn Isolate>,
    /// Whether all runs are made so, and not only those in whose midst an earlier process ended.
    pub isolate_all: bool,
}

impl<'a> From<&Execution<'a>> for Means<'a> {
    fn from(with: &Execution<'a>) -> Self {
        Self { clock: with.clock, memory: with.memory, interrupt: with.interrupt, audit: with.audit }
    }
}

/// Makes the runs that the folder does not hold yet, and keeps each there as soon as it has ended.
///
/// True where all are there at the end, false where [`Execution::interrupt`] came before.
pub fn execute(
    prepared: &Prepared<'_>,
    folder: &mut Folder,
    with: &Execution<'_>,
) -> Result<bool, StudyError> {
    let mut keys = prepared.study.keys();
    let total = keys.len();
    keys.retain(|key| !folder.holds(*key));
    let (begun, before) = Begun::open(folder.path())?;
    let suspects: BTreeSet<RunKey> = before.into_iter().collect();
    // Runs that are compared follow each other, so that whatever slows the machine down for a while slows
    // down all of them; with each seed another variant is first, since the first meets cold caches.
    let variants = prepared.study.variants.len() as u64;
    keys.sort_by_key(|key| (key.scenario, key.seed, key.seed.wrapping_add(key.variant as u64) % variants));
    with.progress.begin(total - keys.len(), total);
    let job = Job {
        machinery: Machinery::new(prepared, with.into()),
        interrupt: with.interrupt,
        keep_plans: with.keep_plans,
        isolate: with.isolate,
        isolate_all: with.isolate_all,
        begun,
        suspects,
        keys,
        next: AtomicUsize::new(0),
        failed: AtomicBool::new(false),
    };
    make_and_keep(&job, folder, with)?;
    let complete = job.keys.iter().all(|key| folder.holds(*key));
    job.begun.close();
    Ok(complete)
}

/// Makes the job's runs on several threads, and keeps them on this one.
fn make_and_keep(job: &Job<'_>, folder: &mut Folder, with: &Execution<'_>) -> Result<(), StudyError> {
    thread::scope(|scope| {
        let (sender, ended) = mpsc::channel();
        for _ in 0..with.threads.clamp(1, job.keys.len().max(1)) {
            let sender = sender.clone();
            let builder = thread::Builder::new().name(RUN_THREAD.into()).stack_size(STACK);
            // Where the system grants no more threads those that there are do the work; without any the first
            // run is never made.
            let _ = builder.spawn_scoped(scope, move || job.work(&sender));
        }
        drop(sender);
        let kept = ended.iter().try_for_each(|run: Ended| {
            folder.keep(&job.machinery.prepared.study, run.key, &run.made.record, run.made.plan.as_ref())?;
            with.progress.ended(&run.made.record);
            Ok(())
        });
        job.failed.store(kept.is_err(), Ordering::Relaxed);
        kept
    })
}

/// A run that came to its end.
struct Ended {
    key: RunKey,
    made: Made,
}

/// What the threads share.
struct Job<'a> {
    machinery: Machinery<'a>,
    interrupt: &'a dyn Interrupt,
    keep_plans: bool,
    isolate: Option<&'a dyn Isolate>,
    isolate_all: bool,
    begun: Begun,
    /// The runs in whose midst an earlier process ended.
    suspects: BTreeSet<RunKey>,
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
        while !self.interrupt.interrupted() && !self.failed.load(Ordering::Relaxed) {
            let next = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(run) = self.keys.get(next).and_then(|key| self.make(*key)) else { return };
            if ended.send(run).is_err() {
                return;
            }
        }
    }

    /// Makes a run, in a process of its own where that is wished or advisable; `None` where the study was
    /// interrupted meanwhile.
    fn make(&self, key: RunKey) -> Option<Ended> {
        let study = &self.machinery.prepared.study;
        let suspect = self.suspects.contains(&key);
        let apart = suspect || self.isolate_all;
        let mut made = match self.isolate.filter(|_| apart) {
            Some(isolate) => match isolate.run(key) {
                Isolated::Made(made) => *made,
                Isolated::Died(how) => {
                    Made { record: RunRecord::of_crash(study.run_name(key), &how), plan: None }
                }
                Isolated::Interrupted => return None,
            },
            None if suspect => {
                let how = "an earlier process ended in its midst";
                Made { record: RunRecord::of_crash(study.run_name(key), how), plan: None }
            }
            None => {
                self.begun.add(key);
                self.make_afresh(key)?
            }
        };
        made.plan = made.plan.filter(|_| self.keep_plans || study.keeps_plan(key));
        (!self.interrupt.interrupted()).then_some(Ended { key, made })
    }

    /// Makes a run on a thread of its own, so that it finds nothing of what an earlier run left on this one:
    /// plugins keep room for their next call. Where the system grants no thread, on this one.
    fn make_afresh(&self, key: RunKey) -> Option<Made> {
        thread::scope(|scope| {
            let builder = thread::Builder::new().name(RUN_THREAD.into()).stack_size(STACK);
            match builder.spawn_scoped(scope, || self.machinery.make(key)) {
                Ok(run) => run.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
                Err(_) => self.machinery.make(key),
            }
        })
    }
}
