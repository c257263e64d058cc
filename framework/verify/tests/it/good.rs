//! What is right passes, with the figures that follow from how it was made.

use crate::common;

use regrasp_api::Body;
use regrasp_verify::verify;

#[test]
fn a_plan_made_by_hand_verifies() {
    let verdict = verify(&common::plan(8));
    assert!(verdict.valid, "{:#?}", verdict.failures().collect::<Vec<_>>());
    let names: Vec<_> = verdict.checks.iter().map(|check| check.name).collect();
    let expected = [
        "form",
        "quaternions",
        "times",
        "velocities",
        "accelerations",
        "controller",
        "joint-limits",
        "continuity",
        "rest",
        "contacts",
        "closure",
        "normals",
        "slip",
        "contact-jumps",
        "lift",
        "touch-travel",
        "clearance",
        "stability",
        "claims",
        "start",
        "goals",
        "complete",
    ];
    assert_eq!(names, expected);
}

#[test]
fn the_certificate_says_what_and_where() {
    let certificate = verify(&common::plan(8)).certificate.unwrap();
    // The last link's capsule ends in a ball 2 mm smaller than the fingertip about the same centre; the bound
    // gives 0.1 mm away.
    let clearance = certificate.clearance.unwrap();
    assert!((clearance.value - 0.0019).abs() < 1e-6, "{clearance:?}");
    let pair = clearance.place.pair.unwrap();
    assert!(matches!(pair, (Body::Object, Body::Link(_, 2))), "{pair:?}");
    // The regrasp leaves three contacts, the plan's weakest grasp.
    let margin = certificate.closure_margin.unwrap();
    assert_eq!(margin.place.segment, Some(1));
    assert!((0.02..0.5).contains(&margin.value), "{margin:?}");
    assert!(certificate.slip.unwrap().value < 1e-6);
    assert!(certificate.closure_residual.unwrap().value < 1e-6);
}

#[test]
fn finer_plans_come_closer_to_rolling() {
    let slip = |steps: usize| verify(&common::plan(steps)).certificate.unwrap().slip.unwrap().value;
    let (coarse, fine) = (slip(4), slip(16));
    assert!(fine < coarse / 8.0, "second order in the step: {coarse} {fine}");
}

#[test]
fn the_verdict_is_the_same_every_time() {
    let plan = common::plan(4);
    let text = |verdict| serde_json::to_string(&verdict).unwrap();
    assert_eq!(text(verify(&plan)), text(verify(&plan)));
    let value = serde_json::to_value(verify(&plan)).unwrap();
    assert_eq!(value["valid"], true);
    for key in ["name", "worst", "limit", "where", "ok"] {
        assert!(value["checks"][3].get(key).is_some(), "{key}");
    }
}
