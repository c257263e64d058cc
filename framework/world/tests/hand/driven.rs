//! Joints that others drive, and bodies that touch by construction.

use crate::hands::{self, FIRST, joint, one_finger};
use regrasp_api::{Body, FingerIndex, Hand, HandDescription, JointKind::Revolute, Mimic, Random};
use regrasp_world::ChainHand;

/// Abduction and three flexions, the last one driven by the one before.
fn description() -> HandDescription {
    let mut joints = vec![
        joint(Revolute, [1.0, 0.0, 0.0], [0.0; 3], (-0.6, 0.6)),
        joint(Revolute, [0.0, 1.0, 0.0], [0.0, 0.0, 0.01], (-0.5, 1.4)),
        joint(Revolute, [0.0, 1.0, 0.0], [0.0, 0.0, 0.045], (0.05, 1.6)),
        joint(Revolute, [0.0, 1.0, 0.0], [0.0, 0.0, 0.030], (0.0, 1.4)),
    ];
    joints[3].mimic = Some(Mimic { joint: "joint-2".into(), multiplier: 0.8, offset: 0.02 });
    let mut hand = one_finger(joints, [0.0, 0.0, 0.025]);
    let rest = &mut hand.finger[0].rest;
    rest[3] = 0.8 * rest[2] + 0.02;
    hand
}

fn refusal(edit: impl FnOnce(&mut HandDescription)) -> String {
    let mut hand = description();
    edit(&mut hand);
    ChainHand::new(hand).expect_err("the edit makes no sense").to_string()
}

#[test]
fn a_driven_joint_is_neither_spare_nor_solved_for_and_follows_in_every_answer() {
    let hand = ChainHand::new(description()).unwrap();
    assert!(hand.finger(FIRST).spare.is_empty() && !hand.is_closed_form(FIRST));
    let (mut random, mut solved) = (Random::from_key(1, 0, 0, 0), 0);
    for _ in 0..300 {
        let mut wanted = hands::posture(&hand, FIRST, &mut random);
        let astray = hand.tip_center(FIRST, &wanted);
        hand.settle(FIRST, &mut wanted);
        assert_eq!(wanted[3], 0.8 * wanted[2] + 0.02);
        let p_HF = hand.tip_center(FIRST, &wanted);
        assert_eq!(p_HF, astray, "the position given for a driven joint does not count");
        let near = hands::posture(&hand, FIRST, &mut random);
        let Some(found) = hand.inverse(FIRST, &p_HF, &near) else { continue };
        assert!((hand.tip_center(FIRST, &found) - p_HF).norm() < 1e-9);
        assert!(hand.within_limits(FIRST, &found));
        assert_eq!(found[3], 0.8 * found[2] + 0.02);
        solved += 1;
    }
    assert!(solved >= 295, "{solved} of 300 reachable places");
}

#[test]
fn the_driver_s_column_holds_what_both_joints_do() {
    let hand = ChainHand::new(description()).unwrap();
    let mut random = Random::from_key(2, 0, 0, 0);
    for _ in 0..50 {
        let mut q = hands::posture(&hand, FIRST, &mut random);
        hand.settle(FIRST, &mut q);
        let J = hand.tip_kinematics(FIRST, &q);
        assert_eq!((J.J_v.column(3).norm(), J.J_w.column(3).norm()), (0.0, 0.0));
        for k in 0..3 {
            let at = |step: f64| {
                let mut moved = q;
                moved[k] += step;
                hand.settle(FIRST, &mut moved);
                hand.tip_center(FIRST, &moved)
            };
            let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!((slope - J.J_v.column(k)).norm() < 1e-8, "joint {k}");
        }
    }
}

#[test]
fn drivers_without_sense_are_refused() {
    let mimic = |hand: &mut HandDescription, edit: fn(&mut Mimic)| {
        edit(hand.finger[0].joint[3].mimic.as_mut().expect("it has one"));
    };
    let messages = [
        (
            refusal(|hand| mimic(hand, |m| m.joint = "joint-9".into())),
            "`finger[0].joint[3].mimic.joint` = \"joint-9\"",
        ),
        (refusal(|hand| mimic(hand, |m| m.joint = "joint-3".into())), "without a `mimic` of its own"),
        (refusal(|hand| mimic(hand, |m| m.multiplier = f64::NAN)), "multiplier"),
        (refusal(|hand| mimic(hand, |m| m.multiplier = 2.0)), "at the upper limit of \"joint-2\""),
        (refusal(|hand| hand.finger[0].rest[3] += 0.1), "rests where its driver has it"),
    ];
    for (message, part) in messages {
        assert!(message.contains(part), "{message} lacks {part}");
    }
}

#[test]
fn touching_bodies_have_names() {
    let mut hand = description();
    hand.touching = vec![["palm".into(), "joint-2".into()], ["joint-0".into(), "finger".into()]];
    let built = ChainHand::new(hand).unwrap();
    let (link, tip) = (|k| Body::Link(FingerIndex(0), k), Body::Fingertip(FingerIndex(0)));
    assert!(built.touching(Body::Palm, link(2)) && built.touching(tip, link(0)));
    assert!(!built.touching(Body::Palm, link(0)) && !built.touching(link(2), tip));
    let message = refusal(|hand| hand.touching = vec![["palm".into(), "elbow".into()]]);
    assert!(message.contains("`touching[0][1]` = \"elbow\""), "{message}");
}
