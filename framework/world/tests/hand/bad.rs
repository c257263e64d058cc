//! Descriptions that are refused, with the key in the message.

use crate::hands::{description, joint, one_finger};
use regrasp_api::{
    HandDescription,
    JointKind::{Prismatic, Revolute},
    PlacedShape, PoseDescription, Shape,
};
use regrasp_world::ChainHand;

/// The message with which four-finger is refused after `damage`.
fn refusal(damage: impl FnOnce(&mut HandDescription)) -> String {
    let mut hand = description("four-finger");
    damage(&mut hand);
    ChainHand::new(hand).expect_err("damaged").to_string()
}

fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is missing in: {message}");
    }
}

#[test]
fn numbers_out_of_range_are_named() {
    let message = refusal(|hand| hand.fingertip_radius = 10.0);
    assert_says(&message, &["`fingertip_radius` = 10", "0.0001..=0.2", "metres"]);
    for radius in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        assert_says(&refusal(|hand| hand.fingertip_radius = radius), &["fingertip_radius"]);
    }
    let message = refusal(|hand| hand.finger[1].joint[2].upper = 140.0);
    assert_says(&message, &["`finger[1].joint[2].upper` = 140", "radians"]);
    for (lower, key) in [(f64::NAN, "lower"), (f64::NEG_INFINITY, "lower")] {
        assert_says(&refusal(|hand| hand.finger[3].joint[0].lower = lower), &["finger[3].joint[0]", key]);
    }
    assert_says(
        &refusal(|hand| hand.finger[0].joint[1].velocity = 0.0),
        &["finger[0].joint[1].velocity", "positive"],
    );
    assert_says(
        &refusal(|hand| hand.finger[0].joint[1].acceleration = -1.0),
        &["finger[0].joint[1].acceleration"],
    );
    assert_says(&refusal(|hand| hand.finger[2].joint[1].effort = f64::NAN), &["finger[2].joint[1].effort"]);
}

#[test]
fn limits_that_hold_nothing_are_named() {
    for upper in [0.05, 0.0] {
        let message = refusal(|hand| hand.finger[1].joint[2].upper = upper);
        assert_says(&message, &["finger[1].joint[2].lower", "0.05", "less than"]);
    }
}

#[test]
fn axes_and_poses_without_a_direction_are_named() {
    for axis in [[0.0; 3], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0]] {
        assert_says(
            &refusal(|hand| hand.finger[1].joint[2].axis = axis),
            &["`finger[1].joint[2].axis`", "direction"],
        );
    }
    let message = refusal(|hand| hand.finger[2].base.axis = Some([0.0; 3]));
    assert_says(&message, &["`finger[2].base`", "axis"]);
    let message = refusal(|hand| hand.finger[2].joint[1].origin.position[0] = f64::NAN);
    assert_says(&message, &["`finger[2].joint[1].origin`", "position"]);
    let message = refusal(|hand| hand.finger[2].tip = [0.0, f64::NAN, 0.0]);
    assert_says(&message, &["`finger[2].tip`"]);
}

#[test]
fn rest_postures_must_fit() {
    assert_says(
        &refusal(|hand| hand.finger[0].rest[2] = 0.0),
        &["`finger[0].rest[2]` = 0", "0.05..=2.4", "rest"],
    );
    let message = refusal(|hand| hand.finger[0].rest.truncate(2));
    assert_says(&message, &["`finger[0].rest`", "2 positions", "3 joints"]);
}

#[test]
fn names_must_be_there_and_differ() {
    assert_says(&refusal(|hand| hand.name = " ".into()), &["`name` is empty"]);
    assert_says(&refusal(|hand| hand.finger[1].name.clear()), &["`finger[1].name` is empty"]);
    assert_says(
        &refusal(|hand| hand.finger[1].joint[0].name.clear()),
        &["`finger[1].joint[0].name` is empty"],
    );
    let message = refusal(|hand| hand.finger[2].name = "east".into());
    assert_says(&message, &["`finger[2].name`", "\"east\"", "`finger[0].name`"]);
    let message = refusal(|hand| hand.finger[1].joint[1].name = "east-distal".into());
    assert_says(&message, &["`finger[1].joint[1].name`", "`finger[0].joint[2].name`"]);
}

#[test]
fn counts_are_limited() {
    assert_says(&refusal(|hand| hand.finger.clear()), &["`finger` has 0", "1..=8"]);
    let many = refusal(|hand| hand.finger = vec![hand.finger[0].clone(); 9]);
    assert_says(&many, &["`finger` has 9", "1..=8"]);
    assert_says(&refusal(|hand| hand.finger[3].joint.clear()), &["`finger[3].joint` has 0", "1..=7"]);
    let many = refusal(|hand| hand.finger[3].joint = vec![hand.finger[3].joint[0].clone(); 8]);
    assert_says(&many, &["`finger[3].joint` has 8", "1..=7"]);
}

#[test]
fn shapes_are_checked() {
    let placed = |shape| vec![PlacedShape { shape, pose: PoseDescription::default() }];
    let message = refusal(|hand| hand.palm = placed(Shape::Box { size: [0.1, 0.0, 0.1] }));
    assert_says(&message, &["`palm[0].shape.size[1]` = 0"]);
    let message = refusal(|hand| hand.finger[1].joint[2].link = placed(Shape::Sphere { radius: -1.0 }));
    assert_says(&message, &["`finger[1].joint[2].link[0].shape.radius` = -1"]);
    let capsule = Shape::Capsule { from: [0.0; 3], to: [0.0, f64::NAN, 0.0], radius: 0.01 };
    assert_says(&refusal(|hand| hand.palm = placed(capsule)), &["`palm[0].shape.to[1]`"]);
    let plane = Shape::HalfSpace { normal: [0.0; 3], offset: 0.0 };
    assert_says(&refusal(|hand| hand.palm = placed(plane)), &["`palm[0].shape.normal`"]);
}

#[test]
fn fingers_that_cannot_move_everywhere_are_refused_by_name() {
    let x = [1.0, 0.0, 0.0];
    let y = [0.0, 1.0, 0.0];
    let up = [0.0, 0.0, 0.04];
    let turn = |axis, position| joint(Revolute, axis, position, (-1.0, 1.0));
    let slide = |axis| joint(Prismatic, axis, [0.0; 3], (-0.1, 0.1));
    // Two joints; three and four in one plane; two equal axes; three slides in a plane; tip on the last axis.
    let chains = [
        (vec![turn(x, [0.0; 3]), turn(y, up)], up, 2),
        (vec![turn(y, [0.0; 3]), turn(y, up), turn(y, up)], up, 2),
        (vec![turn(y, [0.0; 3]), turn(y, up), turn(y, up), turn(y, up)], up, 2),
        (vec![turn(x, [0.0; 3]), turn(x, [0.0; 3]), turn(y, [0.0; 3])], up, 2),
        (vec![slide(x), slide(y), slide([1.0, 1.0, 0.0])], up, 2),
        (vec![turn(x, [0.0; 3]), turn(y, up), turn(up, up)], up, 2),
        (vec![turn(x, [0.0; 3])], up, 1),
    ];
    for (joints, tip, independent) in chains {
        let message = ChainHand::new(one_finger(joints, tip)).expect_err("dependent").to_string();
        let count = format!("has {independent} independent joints");
        assert_says(&message, &["finger \"finger\" (`finger[0]`)", &count, "at least three"]);
    }
}
