//! Plans that claim equilibrium: held to the weight and the load that they claim.

use crate::common;

use regrasp_api::{Criterion, Load, Slot};
use regrasp_plan::{Plan, PluginChoice};
use regrasp_verify::{Verdict, verify};

const LOAD: Load = Load { disturbance_force: 0.2, disturbance_torque: 0.002, max_normal_force: 20.0 };

/// The plan by hand, claiming `claimed`, made with the built-in test set to `LOAD`.
fn judged(claimed: Load, edit: impl FnOnce(&mut Plan)) -> Verdict {
    let mut plan = common::plan(8);
    plan.claims.criterion = Criterion::Equilibrium(claimed);
    let settings = serde_json::to_value(LOAD).unwrap();
    let choice = PluginChoice { id: "stability-test/equilibrium".into(), settings };
    plan.scenario.plugins.insert(Slot::StabilityTest, choice);
    edit(&mut plan);
    verify(&plan)
}

fn failed(verdict: &Verdict) -> Vec<&str> {
    verdict.failures().map(|check| check.name).collect()
}

#[test]
fn a_plan_that_holds_its_load_verifies() {
    let verdict = judged(LOAD, |_| {});
    assert!(verdict.valid, "{:?}", failed(&verdict));
    let stability = verdict.check("stability").unwrap();
    assert!(stability.worst.unwrap() > 1e-3, "{stability:?}");
    // Closure margins say nothing of a load.
    assert!(verdict.certificate.unwrap().closure_margin.is_none());
}

#[test]
fn a_load_that_is_too_much_does_not() {
    let weak = Load { max_normal_force: 0.3, ..LOAD };
    let strong = Load { disturbance_force: 40.0, ..LOAD };
    let twisted = Load { disturbance_torque: 2.0, ..LOAD };
    for load in [weak, strong, twisted] {
        assert_eq!(failed(&judged(load, |_| {})), ["stability"], "{load:?}");
    }
    let heavy = judged(LOAD, |plan| plan.scenario.problem.object.mass = 50.0);
    assert_eq!(failed(&heavy), ["stability"]);
    let high = judged(LOAD, |plan| plan.scenario.problem.gravity = [0.0, 0.0, -3000.0]);
    assert_eq!(failed(&high), ["stability"]);
}

#[test]
fn the_load_must_be_no_less_than_the_scenario_sets() {
    let less = Load { disturbance_force: 0.1, ..LOAD };
    assert_eq!(failed(&judged(less, |_| {})), ["claims"]);
    let stronger = Load { max_normal_force: 30.0, ..LOAD };
    assert_eq!(failed(&judged(stronger, |_| {})), ["claims"]);
    let more = Load { disturbance_force: 0.3, ..LOAD };
    assert!(judged(more, |_| {}).valid);
    let closure = judged(LOAD, |plan| plan.claims.criterion = Criterion::Closure);
    assert_eq!(failed(&closure), ["claims"]);
    let other = judged(LOAD, |plan| {
        plan.scenario.plugins.get_mut(&Slot::StabilityTest).unwrap().id =
            "stability-test/force-closure".into();
    });
    assert_eq!(failed(&other), ["claims"]);
}

#[test]
fn a_load_without_meaning_is_no_proof() {
    for load in [Load { disturbance_torque: 0.0, ..LOAD }, Load { max_normal_force: f64::NAN, ..LOAD }] {
        assert!(failed(&judged(load, |_| {})).contains(&"stability"), "{load:?}");
    }
}

#[test]
fn the_claim_is_written_and_read() {
    let mut plan = common::plan(2);
    plan.claims.criterion = Criterion::Equilibrium(LOAD);
    let text = serde_json::to_string(&plan.claims).unwrap();
    assert!(text.contains("\"equilibrium\"") && text.contains("max_normal_force"), "{text}");
    let claims: regrasp_plan::Claims = serde_json::from_str(&text).unwrap();
    assert_eq!(claims, plan.claims);
}
