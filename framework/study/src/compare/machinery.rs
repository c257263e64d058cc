//! What makes one run of a study.

use super::timed::{self, Meter};
use super::{Made, Memory, Prepared, RunKey, RunName, RunRecord};
use regrasp_api::{Interrupt, take_fault};
use regrasp_plan::{Plan, StoppedBy};
use regrasp_planner::{Clock, Request, Silent};
use regrasp_run::{RunOptions, Setup, Stop};
use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What a run needs beside its problem.
#[derive(Clone, Copy)]
pub struct Means<'a> {
    /// Times it, and ends it at the time limit.
    pub clock: &'a dyn Clock,
    /// Tells how much memory it has in use; without it that is not known.
    pub memory: Option<&'a dyn Memory>,
    /// Ends it with the study.
    pub interrupt: &'a dyn Interrupt,
    /// Whether every call of a plugin is held against its role's laws.
    pub audit: bool,
}

/// What makes a run.
pub(super) struct Machinery<'a> {
    pub prepared: &'a Prepared<'a>,
    means: Means<'a>,
    /// How long reading the clock takes (s).
    tick_s: f64,
}

impl<'a> Machinery<'a> {
    pub fn new(prepared: &'a Prepared<'a>, means: Means<'a>) -> Self {
        Self { prepared, means, tick_s: timed::tick_s(means.clock) }
    }

    /// Makes a run; `None` where the study was interrupted meanwhile.
    pub fn make(&self, key: RunKey) -> Option<Made> {
        let setup = self.prepared.setup(key).expect("a study has no runs of what it leaves out");
        let study = &self.prepared.study;
        let name = study.run_name(key);
        let limit_s = study.scenarios[key.scenario].problem.limits.budget.time_limit;
        let Means { clock, interrupt, .. } = self.means;
        let deadline = Deadline { clock, at_s: limit_s.map(|limit| clock.seconds() + limit), interrupt };
        let made = catch_unwind(AssertUnwindSafe(|| self.run(setup, name, &deadline)));
        let (record, plan) = made.unwrap_or_else(|payload| {
            // What the panic left on this thread belongs to it, not to the next run.
            take_fault();
            (RunRecord::of_panic(name, panic_message(payload.as_ref())), None)
        });
        (!interrupt.interrupted()).then_some(Made { record, plan })
    }

    fn run(&self, setup: &Setup<'_>, name: RunName<'_>, stop: &Deadline<'_>) -> (RunRecord, Option<Plan>) {
        let Means { clock, memory, audit, .. } = self.means;
        let meter = Meter::new(clock, self.tick_s);
        let options = RunOptions { seed: name.seed, threads: 1, stop, clock, progress: &Silent };
        let most = Cell::new(None);
        let solve = |request: &Request<'_>| {
            memory.inspect(|memory| memory.begin());
            let outcome = timed::solve(request, &meter);
            most.set(memory.map(Memory::most));
            outcome
        };
        let run = if audit {
            let auditor = setup.auditor();
            setup.run_by(&|request| regrasp_run::audited(request, &auditor, &solve), &options)
        } else {
            setup.run_by(&solve, &options)
        };
        match run {
            Ok(run) => {
                let hand = setup.scenario().hand.as_ref();
                let mut record = RunRecord::of_run(name, &run, hand, meter.roles_s(run.planning_s));
                record.counts.collision_tests = meter.collision_tests();
                record.times.memory_bytes = most.get();
                (record, run.plan)
            }
            Err(error) => (RunRecord::of_error(name, &error), None),
        }
    }
}

/// Ends a run at its time limit, or with the study.
struct Deadline<'a> {
    clock: &'a dyn Clock,
    at_s: Option<f64>,
    interrupt: &'a dyn Interrupt,
}

impl Interrupt for Deadline<'_> {
    fn interrupted(&self) -> bool {
        self.interrupt.interrupted() || self.at_s.is_some_and(|at| self.clock.seconds() >= at)
    }
}

impl Stop for Deadline<'_> {
    fn cause(&self) -> StoppedBy {
        if self.interrupt.interrupted() { StoppedBy::Interrupt } else { StoppedBy::TimeLimit }
    }
}

/// Makes one run of a study here and now, as the process does that [`super::Isolate`] starts; `None` where it
/// was interrupted.
pub fn make_run(prepared: &Prepared<'_>, key: RunKey, means: Means<'_>) -> Option<Made> {
    let study = &prepared.study;
    let sound = study.has(key) && !study.is_left_out(key.scenario, key.variant);
    sound.then(|| Machinery::new(prepared, means).make(key)).flatten()
}

fn panic_message(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("(no message)")
}
