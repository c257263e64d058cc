//! A plan that does not pass the verifier is planned again: no input ends with a plan that is thrown away.

use regrasp::planner::{Clock, Outcome, PlanError, Request, Silent};
use regrasp::run::{NeverStops, Run, RunOptions, Setup, scenario};
use regrasp::{host::Registry, plan::Motion};
use std::cell::Cell;

struct NoClock;

impl Clock for NoClock {
    fn seconds(&self) -> f64 {
        0.0
    }
}

/// Plans `sphere` with a planner whose first `bad` motions have a state off by 0.1 mm.
fn with_a_planner_that_errs(bad: usize) -> (Run, usize) {
    let registry = Registry::linked().expect("no two plugins have one id");
    let scenario = scenario::load("sphere", &registry).expect("it is built in");
    let setup = Setup::new(&scenario, &scenario.choices, &registry).expect("the defaults take the sphere");
    let options = RunOptions { seed: 1, threads: 1, stop: &NeverStops, clock: &NoClock, progress: &Silent };
    let calls = Cell::new(0);
    let solve = |request: &Request<'_>| -> Result<Outcome, PlanError> {
        let mut outcome = regrasp::planner::solve(request)?;
        if calls.get() < bad {
            shake(&mut outcome.motion);
        }
        calls.set(calls.get() + 1);
        Ok(outcome)
    };
    let run = setup.run_by(&solve, &options).expect("no plugin breaks the contract");
    (run, calls.get())
}

fn shake(motion: &mut Motion) {
    let states = &mut motion.segments[0].states;
    let middle = states.len() / 2;
    states[middle].X_HO.translation.vector.z += 1e-4;
}

#[test]
fn a_planner_that_errs_is_asked_again_and_the_user_is_told() {
    let (run, calls) = with_a_planner_that_errs(2);
    assert!(run.is_verified() && calls == 3, "{calls} calls, {:?}", run.verdict);
    let told: Vec<_> =
        run.outcome.warnings.iter().filter(|w| w.contains("did not pass the verifier")).collect();
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told.iter().all(|warning| warning.contains("closure")), "{told:?}");
    let limits = run.plan.expect("a verified run has a plan").scenario.problem.limits;
    assert_eq!(limits, Default::default(), "the plan holds the problem as it was given");
}

#[test]
fn one_that_always_errs_ends_after_all_tries_and_one_that_does_not_is_asked_once() {
    let (run, calls) = with_a_planner_that_errs(usize::MAX);
    assert!(!run.is_verified() && run.verdict.is_some() && calls == 5, "{calls}");
    let (run, calls) = with_a_planner_that_errs(0);
    assert!(run.is_verified() && calls == 1 && run.outcome.warnings.is_empty());
}
