//! Forward kinematics, frames of links and Jacobians.

use crate::{hands, oracle};
use regrasp_api::{FingerJoints, Hand, Random, Vec3};
use regrasp_world::{ChainHand, LinkFrame};

fn all_hands() -> Vec<ChainHand> {
    let mut random = Random::from_key(11, 0, 0, 0);
    let mut all: Vec<_> =
        ["four-finger", "free-fingertips", "five-finger", "three-finger"].map(hands::load).into();
    all.extend((3..=7).map(|count| ChainHand::new(hands::random_chain(&mut random, count)).unwrap()));
    all
}

#[test]
fn tips_and_frames_are_those_of_homogeneous_matrices() {
    let mut random = Random::from_key(1, 0, 0, 0);
    for hand in all_hands() {
        for finger in hands::fingers(&hand) {
            let description = &hand.description().finger[finger.index()];
            for _ in 0..200 {
                let joints = hands::posture(&hand, finger, &mut random);
                let wanted = oracle::tip(description, &joints);
                assert!((hand.tip_center(finger, &joints) - wanted).norm() < 1e-14);
                let tip = hand.tip_kinematics(finger, &joints);
                assert!((tip.p_HF - wanted).norm() < 1e-14);
                let mut room = LinkFrame::room();
                let frames = hand.link_frames(finger, &joints, &mut room);
                let wanted = oracle::frames(description, &joints);
                assert_eq!(frames.len(), wanted.len());
                for (frame, wanted) in frames.iter().zip(&wanted) {
                    assert!((frame.pose().to_homogeneous() - wanted).norm() < 1e-13);
                    let p = Vec3::new(0.1, 0.2, 0.3);
                    assert!(
                        (frame.point(&p) - (frame.pose() * nalgebra::Point3::from(p)).coords).norm() < 1e-14
                    );
                }
                let last = wanted.last().unwrap().fixed_view::<3, 3>(0, 0).into_owned();
                assert!((tip.R_HF.to_rotation_matrix().matrix() - last).norm() < 1e-13);
            }
        }
    }
}

#[test]
fn jacobians_are_the_derivatives() {
    let mut random = Random::from_key(2, 0, 0, 0);
    let h = 1e-6;
    for hand in all_hands() {
        for finger in hands::fingers(&hand) {
            for _ in 0..20 {
                let joints = hands::posture(&hand, finger, &mut random);
                let at = hand.tip_kinematics(finger, &joints);
                for k in 0..joints.len() {
                    let shifted = |by: f64| {
                        let mut shifted = joints;
                        shifted[k] += by;
                        hand.tip_kinematics(finger, &shifted)
                    };
                    let (before, after) = (shifted(-h), shifted(h));
                    let velocity = (after.p_HF - before.p_HF) / (2.0 * h);
                    assert!((at.J_v.column(k) - velocity).norm() < 1e-9);
                    let spin = (after.R_HF * before.R_HF.inverse()).scaled_axis() / (2.0 * h);
                    assert!((at.J_w.column(k) - spin).norm() < 1e-8);
                }
                for k in joints.len()..at.J_v.ncols() {
                    assert_eq!((at.J_v.column(k).norm(), at.J_w.column(k).norm()), (0.0, 0.0));
                }
            }
        }
    }
}

#[test]
fn the_upright_finger_of_the_paper_stands_above_its_base() {
    let hand = hands::load("four-finger");
    let upright = FingerJoints::from_slice(&[0.0, 0.0, 0.0]);
    assert!((hand.tip_center(hands::FIRST, &upright) - Vec3::new(0.06, 0.0, 0.115)).norm() < 1e-15);
    // Flexion leans the finger towards the middle of the hand.
    let flexed = FingerJoints::from_slice(&[0.0, 0.5, 0.5]);
    assert!(hand.tip_center(hands::FIRST, &flexed).x < 0.06);
}

#[test]
fn models_repeat_the_description() {
    let hand = hands::load("three-finger");
    assert_eq!((hand.finger_count(), hand.fingertip_radius()), (3, 0.01));
    let model = hand.finger(hands::FIRST);
    assert_eq!(model.name, "thumb");
    assert_eq!(&*model.rest, [0.0, -0.9, 0.6]);
    assert_eq!((model.joints[2].lower, model.joints[2].upper, model.joints[2].velocity), (0.05, 2.4, 4.0));
    assert!(model.spare.is_empty());
    assert_eq!((hand.palm_shapes().len(), hand.link_count(hands::FIRST)), (1, 3));
    assert_eq!(hand.link_shapes(hands::FIRST, 0).len(), 1);
    assert!(hand.consecutive(hands::FIRST, 0, 1) && !hand.consecutive(hands::FIRST, 0, 2));
    // four-finger's first link has no shape.
    let hand = hands::load("four-finger");
    assert!(hand.link_shapes(hands::FIRST, 0).is_empty());
}

#[test]
fn rest_and_middle_are_within_the_limits_and_beyond_is_not() {
    let hand = hands::load("four-finger");
    let model = hand.finger(hands::FIRST);
    assert!(hand.within_limits(hands::FIRST, &model.rest));
    let mut beyond = model.rest;
    beyond[2] = model.joints[2].upper + 1e-9;
    assert!(!hand.within_limits(hands::FIRST, &beyond));
}
