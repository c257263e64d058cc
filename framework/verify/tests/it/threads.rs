//! The verdict is the same on any number of threads, byte for byte.

use crate::common;

use regrasp_plan::Plan;
use regrasp_verify::{Verdict, verify, verify_on};

fn text(verdict: &Verdict) -> String {
    serde_json::to_string(verdict).unwrap()
}

/// Holds the verdicts on 1 to 5 threads against each other, twice each.
fn same_on_any(plan: &Plan) -> Verdict {
    let alone = verify(plan);
    for threads in [0, 1, 2, 2, 3, 5] {
        assert_eq!(text(&verify_on(plan, threads)), text(&alone), "{threads} threads");
    }
    alone
}

#[test]
fn threads_do_not_change_the_verdict_on_what_is_right() {
    // Some ten stretches, of which slip runs through three segments.
    let verdict = same_on_any(&common::plan(120));
    assert!(verdict.valid, "{:#?}", verdict.failures().collect::<Vec<_>>());
    assert!(verdict.certificate.unwrap().slip.unwrap().value > 0.0);
}

#[test]
fn threads_do_not_change_the_verdict_on_what_is_wrong() {
    let mut plan = common::plan(120);
    let states = &mut plan.segments[2].states;
    let middle = states.len() / 2;
    states[middle].joints[0][0] += 0.02;
    states[middle + 40].object.position[2] += 0.001;
    states[middle + 41].time = states[middle].time;
    let verdict = same_on_any(&plan);
    let failed = common::names(&verdict);
    for name in ["times", "closure", "slip", "velocities"] {
        assert!(failed.contains(&name), "{name} of {failed:?}");
    }
    // The first of equal faults is named, whoever found it.
    assert_eq!(verdict.check("closure").unwrap().place.segment, Some(2));
}

#[test]
fn slip_is_summed_over_the_stretches_of_a_transfer() {
    // In one direction, little by little: no step alone is anything.
    let mut plan = common::plan(120);
    let limit = plan.scenario.problem.limits.tolerances.slip;
    let states = &mut plan.segments[0].states;
    let count = states.len() as f64;
    for (k, state) in states.iter_mut().enumerate() {
        state.joints[1][0] += 0.1 * k as f64 / count;
    }
    let slip = same_on_any(&plan).check("slip").unwrap().worst.unwrap();
    assert!(slip > 3.0 * limit, "{slip}");
}
