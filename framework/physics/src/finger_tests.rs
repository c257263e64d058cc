//! Fingers in the simulated world against the hand's own kinematics.

use super::*;
use regrasp_api::Random;
use regrasp_world::ChainHand;

fn hand() -> ChainHand {
    let file =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/hands/four-finger.toml");
    ChainHand::new(toml::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()).unwrap()
}

fn world(time_step: f64) -> PhysicsWorld {
    let mut world = PhysicsWorld { gravity: to_glam(&Vec3::new(0.0, 0.0, -9.81)), ..Default::default() };
    world.integration_parameters.dt = time_step;
    world.integration_parameters.num_solver_iterations = 1;
    world
}

fn posture(hand: &ChainHand, finger: FingerIndex, random: &mut Random) -> FingerJoints {
    let mut q = hand.finger(finger).rest;
    q.iter_mut()
        .zip(&hand.finger(finger).joints)
        .for_each(|(q, joint)| *q = random.range(joint.lower, joint.upper));
    q
}

#[test]
fn the_tip_goes_where_the_hands_kinematics_says() {
    let (hand, mut random) = (hand(), Random::from_key(3, 0, 0, 0));
    for finger in (0..4).map(FingerIndex) {
        for _ in 0..5 {
            let (from, to) = (posture(&hand, finger, &mut random), posture(&hand, finger, &mut random));
            let mut world = world(1e-3);
            let settings = SimulationSettings::default();
            let simulated = SimulatedFinger::new(&mut world, &hand, finger, &from, &settings);
            let none = FingerJoints::zeros(3);
            assert!((simulated.center(&world) - hand.tip_center(finger, &from)).norm() < 1e-12);
            for _ in 0..1500 {
                simulated.drive(&mut world, &to, &none, &none);
                world.step();
            }
            let off = (simulated.center(&world) - hand.tip_center(finger, &to)).norm();
            assert!(off < 1e-6, "{off}");
        }
    }
}

/// A lone joint of inertia I about its axis, driven far off by a motor that saturates: q = τ t² / 2 I.
#[test]
fn a_motor_gives_its_effort_and_no_more() {
    let finger = FingerIndex(0);
    let mut reached = Vec::new();
    for effort in [0.01, 0.02] {
        let mut description = hand().description().clone();
        description.finger[0].joint.iter_mut().for_each(|joint| joint.effort = effort);
        let hand = ChainHand::new(description).unwrap();
        let mut world = world(1e-4);
        let from = hand.finger(finger).rest;
        let simulated =
            SimulatedFinger::new(&mut world, &hand, finger, &from, &SimulationSettings::default());
        let mut to = from;
        to[0] += 100.0; // far beyond what the effort can follow
        let none = FingerJoints::zeros(3);
        for _ in 0..200 {
            simulated.drive(&mut world, &to, &none, &none);
            world.step();
        }
        reached.push((simulated.center(&world) - hand.tip_center(finger, &from)).norm());
    }
    let ratio = reached[1] / reached[0];
    assert!(reached[0] > 1e-4 && (ratio - 2.0).abs() < 0.1, "{reached:?}");
}
