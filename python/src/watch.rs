//! What runs beside Python: a clock, a limit, a way to stop, and how far it is.

use crate::errors;
use pyo3::prelude::*;
use regrasp::api::Interrupt;
use regrasp::plan::StoppedBy;
use regrasp::planner::{Clock, Progress};
use regrasp::run::Stop;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How often Python is asked for signals and told how far a run is.
const POLL: Duration = Duration::from_millis(15);
/// How long a run that is to stop is waited for, before it is left to end by itself.
const PATIENCE: Duration = Duration::from_millis(60);

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// Searching for a goal, counted from 0: nodes and components of the graph.
    Search(usize, usize, usize),
    /// Smoothing a motion of so many segments.
    Smoothing(usize),
    /// Of so many runs of a study so many have ended.
    Study(usize, usize),
}

/// The clock of one run, with what stops it.
pub struct Watch {
    begin: Instant,
    limit: Option<Duration>,
    cancelled: AtomicBool,
    /// Nobody waits for the run any more.
    abandoned: AtomicBool,
    stage: Mutex<Option<Stage>>,
}

impl Watch {
    /// Begins now; the run is to end after `limit` seconds.
    pub fn start(limit: Option<f64>) -> Arc<Self> {
        Arc::new(Self {
            begin: Instant::now(),
            limit: limit.map(Duration::from_secs_f64),
            cancelled: AtomicBool::new(false),
            abandoned: AtomicBool::new(false),
            stage: Mutex::new(None),
        })
    }

    /// Asks the run to stop.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether the run was asked to stop; a limit that is over does not count.
    pub fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// How far the run is, where that changed since it was last asked.
    fn news(&self) -> Option<Stage> {
        self.stage.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Of `total` runs of a study `done` have ended.
    pub fn study(&self, done: usize, total: usize) {
        self.tell(Stage::Study(done, total));
    }

    fn tell(&self, stage: Stage) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = Some(stage);
    }
}

impl Clock for Watch {
    fn seconds(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }
}

impl Interrupt for Watch {
    fn interrupted(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
            || self.limit.is_some_and(|limit| self.begin.elapsed() >= limit)
    }
}

impl Stop for Watch {
    fn cause(&self) -> StoppedBy {
        let cancelled = self.cancelled.load(Ordering::Relaxed);
        if cancelled { StoppedBy::Interrupt } else { StoppedBy::TimeLimit }
    }
}

impl Progress for Watch {
    fn search(&self, leg: usize, nodes: usize, components: usize) {
        self.tell(Stage::Search(leg, nodes, components));
    }

    fn smoothing(&self, segments: usize) {
        self.tell(Stage::Smoothing(segments));
    }
}

/// Runs `job` on a thread of its own, without the GIL, and tells `callback` how far it is.
///
/// Signals are looked for all the while: Ctrl-C raises within a tenth of a second, and so does an exception
/// of the callback. A job that does not
/// stop in time goes on alone, and its answer is thrown away.
pub fn beside<T: Send + 'static>(
    py: Python<'_>,
    watch: &Arc<Watch>,
    callback: Option<&Bound<'_, PyAny>>,
    job: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, mut receiver) = channel();
    let theirs = Arc::clone(watch);
    std::thread::Builder::new().name("regrasp".into()).spawn(move || {
        // Attached once, the thread is known to Python, and a call of a plugin need not make it known again.
        let answer = Python::attach(|py| py.detach(|| unless_abandoned(&theirs, job)));
        // Nobody may wait for it any more.
        let _ = sender.send(answer);
    })?;
    loop {
        let answer;
        (receiver, answer) = wait(py, receiver, POLL);
        match answer {
            Ok(Ok(answer)) => return Ok(answer),
            Ok(Err(payload)) => return Err(errors::defect(payload.as_ref())),
            Err(RecvTimeoutError::Disconnected) => return Err(errors::defect(&"its thread is gone")),
            Err(RecvTimeoutError::Timeout) => {}
        }
        let stop = py.check_signals().and_then(|()| tell(watch, callback));
        if let Err(exception) = stop {
            watch.cancel();
            let (_, answer) = wait(py, receiver, PATIENCE);
            watch.abandoned.store(answer.is_err(), Ordering::Relaxed);
            return Err(exception);
        }
    }
}

/// Runs `rows` calls without the GIL, `part` of them between two looks for signals: Ctrl-C ends a batch.
pub fn in_parts(
    py: Python<'_>,
    rows: usize,
    part: usize,
    mut call: impl FnMut(Range<usize>) + Send,
) -> PyResult<()> {
    for start in (0..rows).step_by(part) {
        py.detach(|| call(start..rows.min(start + part)));
        py.check_signals()?;
    }
    Ok(())
}

/// The answer of `job`. A thread that nobody waits for any more never comes back from here: the interpreter
/// may be gone by then, and a thread that asks for it is ended through frames that cannot be.
fn unless_abandoned<T>(watch: &Watch, job: impl FnOnce() -> T) -> std::thread::Result<T> {
    let answer = catch_unwind(AssertUnwindSafe(job));
    while watch.abandoned.load(Ordering::Relaxed) {
        std::thread::park();
    }
    answer
}

type Answer<T> = Result<std::thread::Result<T>, RecvTimeoutError>;

fn wait<T: Send>(
    py: Python<'_>,
    receiver: Receiver<std::thread::Result<T>>,
    time: Duration,
) -> (Receiver<std::thread::Result<T>>, Answer<T>) {
    py.detach(move || {
        let answer = receiver.recv_timeout(time);
        (receiver, answer)
    })
}

fn tell(watch: &Watch, callback: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
    let (Some(callback), Some(stage)) = (callback, watch.news()) else { return Ok(()) };
    let arguments = match stage {
        Stage::Search(goal, nodes, components) => ("search", goal, nodes, components),
        Stage::Smoothing(segments) => ("smoothing", 0, segments, 0),
        Stage::Study(done, total) => ("study", 0, done, total),
    };
    callback.call1(arguments).map(drop)
}
