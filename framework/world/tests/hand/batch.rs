//! Many postures at once: the same answers as one by one.

use crate::hands::{self, FIRST};
use regrasp_api::{Hand, Mimic, Random};
use regrasp_world::{ChainHand, Columns};

/// Asks for centres and Jacobians of postures in a table with two other columns around, and compares.
fn check(hand: &ChainHand, count: usize, random: &mut Random) {
    let joints = hand.finger(FIRST).joints.len();
    let postures: Vec<_> = (0..count).map(|_| hands::posture(hand, FIRST, random)).collect();
    let row = |q: &regrasp_api::FingerJoints| [&[f64::NAN], &q[..], &[f64::NAN]].concat();
    let numbers: Vec<f64> = postures.iter().flat_map(row).collect();
    let table = Columns { numbers: &numbers[..], width: joints + 2, first: 1 };
    let mut centers = vec![7.0; 5 * count];
    hand.tip_centers(FIRST, &table, &mut Columns { numbers: &mut centers, width: 5, first: 2 });
    let width = 3 * joints;
    let mut jacobians = vec![7.0; width * count];
    hand.tip_jacobians(FIRST, &table, &mut Columns { numbers: &mut jacobians, width, first: 0 });
    for (row, q) in postures.iter().enumerate() {
        let one = hand.tip_kinematics(FIRST, q);
        let (own, J) = (&centers[5 * row..][..5], &jacobians[width * row..][..width]);
        assert_eq!(own[..2], [7.0, 7.0], "columns that are not meant stay");
        for axis in 0..3 {
            assert!((own[2 + axis] - one.p_HF[axis]).abs() < 1e-14);
            for joint in 0..joints {
                assert!((J[axis * joints + joint] - one.J_v[(axis, joint)]).abs() < 1e-13);
            }
        }
    }
}

#[test]
fn postures_side_by_side_are_those_one_by_one() {
    let mut random = Random::from_key(5, 0, 0, 0);
    for name in ["four-finger", "allegro-like", "free-fingertips"] {
        for count in [0, 1, 7, 8, 9, 100] {
            check(&hands::load(name), count, &mut random);
        }
    }
    for _ in 0..20 {
        let count = 3 + random.index(5);
        let hand = ChainHand::new(hands::random_chain(&mut random, count)).expect("a chain that is sound");
        check(&hand, 11, &mut random);
    }
}

#[test]
fn driven_joints_follow_there_too() {
    let mut random = Random::from_key(6, 0, 0, 0);
    let mut description = hands::random_chain(&mut random, 5);
    let driver = description.finger[0].joint[1].name.clone();
    let finger = &mut description.finger[0];
    finger.joint[3].mimic = Some(Mimic { joint: driver, multiplier: -0.7, offset: 0.1 });
    finger.rest[3] = -0.7 * finger.rest[1] + 0.1;
    (finger.joint[3].lower, finger.joint[3].upper) = (-9.0, 9.0);
    check(&ChainHand::new(description).expect("a chain that is sound"), 50, &mut random);
}
