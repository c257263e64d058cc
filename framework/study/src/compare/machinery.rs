//! What makes one run of a study.

use super::timed::{self, Meter};
use super::{Made, Prepared, RunKey, RunName, RunRecord};
use regrasp_api::{Interrupt, take_fault};
use regrasp_plan::{Plan, StoppedBy};
use regrasp_planner::{Clock, Request, Silent};
use regrasp_run::{RunOptions, Setup, Stop};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What makes a run.
pub(super) struct Machinery<'a> {
    pub prepared: &'a Prepared<'a>,
    clock: &'a dyn Clock,
    interrupt: &'a dyn Interrupt,
    audit: bool,
    /// How long reading the clock takes (s).
    tick_s: f64,
}

impl<'a> Machinery<'a> {
    pub fn new(
        prepared: &'a Prepared<'a>,
        clock: &'a dyn Clock,
        interrupt: &'a dyn Interrupt,
        audit: bool,
    ) -> Self {
        Self { prepared, clock, interrupt, audit, tick_s: timed::tick_s(clock) }
    }

    /// Makes a run; `None` where the study was interrupted meanwhile.
    pub fn make(&self, key: RunKey) -> Option<Made> {
        let setup = self.prepared.setup(key).expect("a study has no runs of what it leaves out");
        let study = &self.prepared.study;
        let name = study.run_name(key);
        let limit_s = study.scenarios[key.scenario].problem.limits.budget.time_limit;
        let at_s = limit_s.map(|limit| self.clock.seconds() + limit);
        let deadline = Deadline { clock: self.clock, at_s, interrupt: self.interrupt };
        let made = catch_unwind(AssertUnwindSafe(|| self.run(setup, name, &deadline)));
        let (record, plan) = made.unwrap_or_else(|payload| {
            // What the panic left on this thread belongs to it, not to the next run.
            take_fault();
            (RunRecord::of_panic(name, panic_message(payload.as_ref())), None)
        });
        (!self.interrupt.interrupted()).then_some(Made { record, plan })
    }

    fn run(&self, setup: &Setup<'_>, name: RunName<'_>, stop: &Deadline<'_>) -> (RunRecord, Option<Plan>) {
        let meter = Meter::new(self.clock, self.tick_s);
        let options = RunOptions { seed: name.seed, threads: 1, stop, clock: self.clock, progress: &Silent };
        let solve = |request: &Request<'_>| timed::solve(request, &meter);
        let run = if self.audit {
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
pub fn make_run(
    prepared: &Prepared<'_>,
    key: RunKey,
    clock: &dyn Clock,
    interrupt: &dyn Interrupt,
    audit: bool,
) -> Option<Made> {
    let study = &prepared.study;
    let sound = study.has(key) && !study.is_left_out(key.scenario, key.variant);
    sound.then(|| Machinery::new(prepared, clock, interrupt, audit).make(key)).flatten()
}

fn panic_message(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("(no message)")
}
