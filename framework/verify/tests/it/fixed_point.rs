//! The law of fixed points: what a hand with declared point fingertips does in a transfer, and what it may
//! not.

use crate::common;

use common::NORTH;
use regrasp_api::*;
use regrasp_plan::*;
use regrasp_verify::{Verdict, verify};
use regrasp_world::ChainHand;

/// A plan for a hand of the kind `fingertip` whose transfers `make` makes.
fn judged(
    fingertip: Fingertip,
    make: fn(&ChainHand, &Configuration, &Pose, usize) -> Segment,
    edit: impl FnOnce(&mut Plan),
) -> Verdict {
    let mut problem = common::problem();
    problem.hand.fingertip = fingertip;
    let hand = ChainHand::new(problem.hand.clone()).unwrap();
    let turned = |angle: f64| {
        Pose::translation(0.001, 0.001, 0.086) * Rotation::from_scaled_axis(Vec3::new(0.3, 0.2, 1.0) * angle)
    };
    let first = make(&hand, &common::start(&hand), &turned(0.1), 40);
    let there = first.states.last().unwrap();
    let second = common::regrasp(&hand, there, NORTH, Vec3::new(0.004, 0.0, -0.003));
    let third = make(&hand, second.states.last().unwrap(), &turned(0.2), 40);
    let mut motion = Motion { segments: vec![first, second, third] };
    assign_times(&mut motion, &hand, &TimingLimits::default()).unwrap();
    let mut plan = common::plan_of(problem, &hand, &motion);
    edit(&mut plan);
    verify(&plan)
}

fn failed(verdict: &Verdict) -> Vec<&str> {
    verdict.checks.iter().filter(|check| !check.ok).map(|check| check.name).collect()
}

#[test]
fn points_that_stay_verify_by_their_law_alone() {
    let fixed = judged(Fingertip::Point, common::pinned, |_| {});
    assert!(fixed.valid, "{:?}", failed(&fixed));
    let slip = fixed.checks.iter().find(|check| check.name == "slip").unwrap();
    assert!(slip.worst.unwrap() < 5e-5, "{slip:?}");
    let as_balls = judged(Fingertip::Ball, common::pinned, |_| {});
    assert_eq!(failed(&as_balls), ["slip"], "balls that do not roll slip");
}

#[test]
fn points_that_roll_are_refused() {
    let rolled = judged(Fingertip::Point, common::transfer, |_| {});
    assert_eq!(failed(&rolled), ["slip"]);
    let slip = rolled.checks.iter().find(|check| check.name == "slip").unwrap();
    // A ball of 10 mm that turns by 0.1 rad about the vertical rolls a millimetre, and does so in each of the
    // two transfers through which the finger holds on.
    assert!((1.5e-3..2.5e-3).contains(&slip.worst.unwrap()), "{slip:?}");
}

#[test]
fn the_law_is_that_of_the_hand() {
    let claims = |law| move |plan: &mut Plan| plan.claims.transfer_law = law;
    let fixed = judged(Fingertip::Ball, common::transfer, claims(TransferLaw::FixedPoint));
    assert!(failed(&fixed).contains(&"claims"), "{:?}", failed(&fixed));
    let rolling = judged(Fingertip::Point, common::pinned, claims(TransferLaw::Rolling));
    assert!(failed(&rolling).contains(&"claims"), "{:?}", failed(&rolling));
}
