//! The ball of reachable fingertip centres.

use crate::hands;
use regrasp_api::{FingerIndex, Hand, Random};
use regrasp_world::ChainHand;

/// The largest distance of a sampled tip from the ball's centre, as a share of the radius.
fn filled(hand: &ChainHand, finger: FingerIndex, random: &mut Random, samples: usize) -> f64 {
    let model = hand.finger(finger);
    let mut largest = 0.0_f64;
    for _ in 0..samples {
        let mut joints = hands::posture(hand, finger, random);
        for (q, joint) in joints.iter_mut().zip(&model.joints) {
            match random.index(6) {
                0 => *q = joint.lower,
                1 => *q = joint.upper,
                _ => {}
            }
        }
        let distance = (hand.tip_center(finger, &joints) - model.p_HReach).norm();
        assert!(distance <= model.reach, "{distance} > {}", model.reach);
        largest = largest.max(distance);
    }
    largest / model.reach
}

#[test]
fn every_tip_lies_in_the_ball_and_the_ball_is_tight() {
    let mut random = Random::from_key(21, 0, 0, 0);
    for name in ["four-finger", "free-fingertips", "five-finger", "three-finger"] {
        let hand = hands::load(name);
        for finger in hands::fingers(&hand) {
            let share = filled(&hand, finger, &mut random, 20_000);
            assert!(share > 0.985, "{name}: {share}");
        }
    }
}

#[test]
fn long_chains_lie_in_their_balls_too() {
    let mut random = Random::from_key(22, 0, 0, 0);
    for count in 3..=7 {
        for _ in 0..5 {
            let hand = ChainHand::new(hands::random_chain(&mut random, count)).unwrap();
            let share = filled(&hand, hands::FIRST, &mut random, 5_000);
            assert!(share > 0.5, "{count} joints: {share}");
        }
    }
}
