//! Inverse kinematics: round trips, limits, nearness, continuity, spare joints, chains without a closed form.

use crate::hands::{self, FIRST, joint, one_finger};
use proptest::prelude::*;
use regrasp_api::{FingerIndex, FingerJoints, Hand, JointKind::Revolute, Random, Vec3};
use regrasp_world::ChainHand;

const CLOSED: [&str; 4] = ["four-finger", "free-fingertips", "five-finger", "three-finger"];

fn built(description: regrasp_api::HandDescription) -> ChainHand {
    ChainHand::new(description).unwrap_or_else(|error| panic!("{error}"))
}

/// Solves for the tip of a random posture from another one; checks what is found.
fn round_trip(hand: &ChainHand, finger: FingerIndex, random: &mut Random) -> Option<f64> {
    let wanted = hands::posture(hand, finger, random);
    let mut near = hands::posture(hand, finger, random);
    for &spare in &hand.finger(finger).spare {
        near[spare] = wanted[spare];
    }
    let p_HF = hand.tip_center(finger, &wanted);
    let found = hand.inverse(finger, &p_HF, &near)?;
    assert!(hand.within_limits(finger, &found), "{found:?}");
    let error = (hand.tip_center(finger, &found) - p_HF).norm();
    assert!(error < 1e-9, "{error:e} at {wanted:?} from {near:?}");
    for &spare in &hand.finger(finger).spare {
        assert_eq!(found[spare], near[spare]);
    }
    Some(error)
}

#[test]
fn hands_of_the_scenarios_are_solved_in_closed_form() {
    let mut random = Random::from_key(3, 0, 0, 0);
    for name in CLOSED {
        let hand = hands::load(name);
        for finger in hands::fingers(&hand) {
            assert!(hand.is_closed_form(finger), "{name}");
            for _ in 0..5000 {
                let error = round_trip(&hand, finger, &mut random).expect("a posture's tip can be reached");
                assert!(error < 1e-12, "{name}: {error:e}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_parallel_pair_is_solved_in_closed_form(seed in any::<u64>(), lone_first in any::<bool>()) {
        let mut random = Random::from_key(seed, 0, 0, 0);
        let hand = built(hands::random_parallel(&mut random, lone_first));
        prop_assert!(hand.is_closed_form(FIRST));
        for _ in 0..50 {
            prop_assert!(round_trip(&hand, FIRST, &mut random).is_some());
        }
    }

    #[test]
    fn postures_at_the_limits_are_found(bits in 0_usize..27, finger in 0_u8..4) {
        let hand = hands::load("four-finger");
        let finger = FingerIndex(finger);
        let mut wanted = FingerJoints::zeros(3);
        for (k, joint) in hand.finger(finger).joints.iter().enumerate() {
            wanted[k] = [joint.lower, joint.upper, 0.3][bits / 3_usize.pow(k as u32) % 3];
        }
        let p_HF = hand.tip_center(finger, &wanted);
        let found = hand.inverse(finger, &p_HF, &wanted).expect("reached");
        prop_assert!(found.max_difference(&wanted) < 1e-7, "{found:?} {wanted:?}");
        prop_assert!(hand.within_limits(finger, &found));
    }
}

#[test]
fn a_stretched_finger_is_found_and_what_lies_beyond_is_not() {
    // Limits that hold the stretched posture, where two solutions meet.
    let mut description = hands::description("four-finger");
    description.finger[0].joint[2].lower = -2.0;
    let hand = built(description);
    let mut random = Random::from_key(4, 0, 0, 0);
    for _ in 0..1000 {
        let mut stretched = hands::posture(&hand, FIRST, &mut random);
        stretched[2] = 0.0;
        let p_HF = hand.tip_center(FIRST, &stretched);
        let found = hand.inverse(FIRST, &p_HF, &stretched).expect("stretched");
        assert!((hand.tip_center(FIRST, &found) - p_HF).norm() < 1e-9);
        let shoulder = Vec3::new(0.06, 0.0, 0.0);
        let beyond = shoulder + (p_HF - shoulder) * 1.0001;
        assert_eq!(hand.inverse(FIRST, &beyond, &stretched), None);
    }
}

#[test]
fn tips_out_of_reach_or_beyond_the_limits_are_refused() {
    let hand = hands::load("four-finger");
    let rest = hand.finger(FIRST).rest;
    assert_eq!(hand.inverse(FIRST, &Vec3::new(0.3, 0.0, 0.0), &rest), None);
    assert_eq!(hand.inverse(FIRST, &Vec3::new(0.06, 0.0, 0.0), &rest), None);
    // Abducted by 1.0 rad where 0.9 is allowed.
    let beyond = FingerJoints::from_slice(&[1.0, 0.2, 0.5]);
    let p_HF = hand.tip_center(FIRST, &beyond);
    assert_eq!(hand.inverse(FIRST, &p_HF, &rest), None);
    let free = hands::load("free-fingertips");
    let rest = free.finger(FIRST).rest;
    assert_eq!(free.inverse(FIRST, &Vec3::new(0.0851, 0.0, 0.085), &rest), None);
    assert!(free.inverse(FIRST, &Vec3::new(0.0849, 0.0, 0.085), &rest).is_some());
}

/// Every solution that Newton's method finds from many starts, by brute force on the public forward
/// kinematics.
fn all_solutions(hand: &ChainHand, p_HF: &Vec3, random: &mut Random) -> Vec<FingerJoints> {
    let mut found = Vec::new();
    for _ in 0..60 {
        let mut q = hands::posture(hand, FIRST, random);
        for _ in 0..50 {
            let tip = hand.tip_kinematics(FIRST, &q);
            let J = tip.J_v.fixed_view::<3, 3>(0, 0).into_owned();
            let Some(inverse) = J.try_inverse() else { break };
            let mut step = inverse * (p_HF - tip.p_HF);
            step *= (0.3 / step.norm()).min(1.0);
            (0..3).for_each(|k| q[k] += step[k]);
        }
        let reached = (hand.tip_center(FIRST, &q) - p_HF).norm() < 1e-12;
        if reached && hand.within_limits(FIRST, &q) {
            found.push(q);
        }
    }
    found
}

#[test]
fn the_solution_closest_to_near_is_taken() {
    let mut random = Random::from_key(5, 0, 0, 0);
    let square = |a: &FingerJoints, b: &FingerJoints| {
        a.iter().zip(b.iter()).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
    };
    let mut several = 0;
    for case in 0..60 {
        let hand = built(hands::random_parallel(&mut random, case % 2 == 0));
        let p_HF = hand.tip_center(FIRST, &hands::posture(&hand, FIRST, &mut random));
        let all = all_solutions(&hand, &p_HF, &mut random);
        several += usize::from(all.iter().any(|q| q.max_difference(&all[0]) > 1e-3));
        for _ in 0..5 {
            let near = hands::posture(&hand, FIRST, &mut random);
            let found = hand.inverse(FIRST, &p_HF, &near).expect("a posture's tip can be reached");
            assert!(all.iter().all(|other| square(&found, &near) <= square(other, &near) + 1e-9));
        }
    }
    assert!(several > 20, "the test needs cases with a choice: {several}");
}

#[test]
fn joints_follow_a_tip_that_moves_on_a_line() {
    let mut random = Random::from_key(6, 0, 0, 0);
    let mut followed = 0;
    for name in ["four-finger", "three-finger", "free-fingertips"] {
        let hand = hands::load(name);
        for _ in 0..300 {
            let mut joints = hands::posture(&hand, FIRST, &mut random);
            let start = hand.tip_center(FIRST, &joints);
            let step = random.direction() * 1e-4;
            for k in 1..=300 {
                let J = hand.tip_kinematics(FIRST, &joints).J_v.fixed_view::<3, 3>(0, 0).into_owned();
                let Some(next) = hand.inverse(FIRST, &(start + step * f64::from(k)), &joints) else { break };
                let worst = J.singular_values().min();
                if worst > 0.01 {
                    // First order, with room for curvature.
                    assert!(next.max_difference(&joints) < 1.5e-4 / worst, "{name}: {joints:?} to {next:?}");
                    followed += 1;
                }
                joints = next;
            }
        }
    }
    assert!(followed > 20_000, "{followed}");
}

/// A finger with four or five revolute joints: turn of the whole finger, abduction, three parallel flexions.
fn redundant(turn: bool) -> ChainHand {
    let mut joints = vec![
        joint(Revolute, [1.0, 0.0, 0.0], [0.0, 0.0, 0.01], (-0.5, 0.5)),
        joint(Revolute, [0.0, 1.0, 0.0], [0.0, 0.0, 0.012], (-0.5, 1.6)),
        joint(Revolute, [0.0, 1.0, 0.0], [0.0, 0.0, 0.045], (0.0, 1.7)),
        joint(Revolute, [0.0, 1.0, 0.0], [0.0, 0.0, 0.03], (0.0, 1.2)),
    ];
    if turn {
        joints.insert(0, joint(Revolute, [0.0, 0.3, 1.0], [0.0, 0.0, 0.0], (-0.6, 0.6)));
    }
    built(one_finger(joints, [0.0, 0.0, 0.03]))
}

#[test]
fn spare_joints_keep_their_positions_and_the_rest_is_in_closed_form() {
    let mut random = Random::from_key(7, 0, 0, 0);
    for (turn, spare) in [(false, 1), (true, 2)] {
        let hand = redundant(turn);
        assert_eq!(hand.finger(FIRST).spare.len(), spare);
        assert!(hand.is_closed_form(FIRST));
        for _ in 0..3000 {
            assert!(round_trip(&hand, FIRST, &mut random).is_some());
        }
    }
}

#[test]
fn chains_without_a_closed_form_are_solved_numerically() {
    let mut random = Random::from_key(8, 0, 0, 0);
    let (mut solved, mut tried) = (0, 0);
    for case in 0..60 {
        let description = hands::random_chain(&mut random, 3 + case % 4);
        let Ok(hand) = ChainHand::new(description) else { continue };
        if hand.is_closed_form(FIRST) {
            continue;
        }
        for _ in 0..100 {
            tried += 1;
            solved += usize::from(round_trip(&hand, FIRST, &mut random).is_some());
        }
    }
    assert!(tried > 3000, "{tried}");
    assert!(solved as f64 > 0.995 * f64::from(tried), "{solved} of {tried}");
}

#[test]
fn numeric_and_closed_form_agree() {
    // Turning the last axis by a millionth of a radian takes the closed form away.
    let mut description = hands::description("four-finger");
    for finger in &mut description.finger {
        finger.joint[2].axis = [1e-6, 1.0, 0.0];
    }
    let (numeric, closed) = (built(description), hands::load("four-finger"));
    assert!(!numeric.is_closed_form(FIRST));
    let mut random = Random::from_key(9, 0, 0, 0);
    for _ in 0..1000 {
        let joints = hands::posture(&closed, FIRST, &mut random);
        let near = joints.interpolate(&hands::posture(&closed, FIRST, &mut random), 0.05);
        let p_HF = closed.tip_center(FIRST, &joints.interpolate(&closed.finger(FIRST).rest, 0.01));
        let J = closed.tip_kinematics(FIRST, &joints).J_v.fixed_view::<3, 3>(0, 0).into_owned();
        if J.singular_values().min() < 0.01 {
            continue; // there the millionth shows
        }
        let (a, b) = (closed.inverse(FIRST, &p_HF, &near), numeric.inverse(FIRST, &p_HF, &near));
        let (a, b) = (a.expect("closed form"), b.expect("numeric"));
        assert!(a.max_difference(&b) < 1e-3, "{a:?} {b:?}");
    }
}

#[test]
fn whole_turns_of_a_wide_joint_stay_near() {
    let mut description = hands::description("four-finger");
    (description.finger[0].joint[1].lower, description.finger[0].joint[1].upper) = (-7.0, 7.0);
    let hand = built(description);
    let mut near = FingerJoints::from_slice(&[0.1, 6.5, 0.5]);
    for shift in [0.0, -std::f64::consts::TAU] {
        near[1] += shift;
        let found = hand.inverse(FIRST, &hand.tip_center(FIRST, &near), &near).expect("reached");
        assert!(found.max_difference(&near) < 1e-9, "{found:?} {near:?}");
    }
}
