//! What is right passes, with the figures that follow from how it was made.

mod common;

use regrasp_verify::verify;

#[test]
fn a_plan_made_by_hand_verifies() {
    let verdict = verify(&common::plan(8));
    for check in &verdict.checks {
        println!("{check:?}");
    }
    println!("{:?}", verdict.certificate);
    assert!(verdict.valid, "{:#?}", verdict.failures().collect::<Vec<_>>());
}
