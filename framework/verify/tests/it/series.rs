//! Figures state by state agree with what the verifier certifies of the whole.

use crate::common;

use regrasp_api::Body;
use regrasp_verify::{series, verify};

#[test]
fn every_state_has_its_figures() {
    let plan = common::plan(8);
    let figures = series(&plan).unwrap();
    let counts = |segments: &[usize]| segments.to_vec();
    let states: Vec<usize> = plan.segments.iter().map(|segment| segment.states.len()).collect();
    assert_eq!(figures.iter().map(Vec::len).collect::<Vec<_>>(), counts(&states));
    let certificate = verify(&plan).certificate.unwrap();
    let all = || figures.iter().flatten();
    let margin = all().map(|figure| figure.margin.unwrap()).fold(f64::INFINITY, f64::min);
    let certified = certificate.closure_margin.unwrap().value;
    assert!((margin - certified).abs() < 0.02 * certified, "{margin} {certified}");
    let clearance = all().map(|figure| figure.clearance.unwrap().0).fold(f64::INFINITY, f64::min);
    let certified = certificate.clearance.unwrap().value;
    // The certificate also looks between the states.
    assert!(clearance >= certified - 1e-12 && clearance < certified + 2e-4, "{clearance} {certified}");
}

#[test]
fn a_touching_finger_is_no_collision_and_a_lifted_one_counts() {
    let figures = series(&common::plan(8)).unwrap();
    for figure in figures.iter().flatten() {
        let (distance, pair) = figure.clearance.unwrap();
        assert!(distance > 1e-3, "{distance} {pair:?}");
        assert!(!matches!(pair, (Body::Object, Body::Fingertip(_))), "links are closer than the lifted tip");
    }
}

#[test]
fn a_plan_without_sense_has_no_figures() {
    let mut plan = common::plan(2);
    plan.segments[0].states[0].joints.pop();
    assert!(series(&plan).unwrap_err().to_string().contains("verify"));
}

#[test]
fn contacts_that_are_not_checked_have_no_margin() {
    let mut plan = common::plan(2);
    plan.claims.contact.cone = None;
    assert!(series(&plan).unwrap().iter().flatten().all(|figure| figure.margin.is_none()));
}
