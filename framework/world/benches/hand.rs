//! Kinematics of one finger: forward, Jacobian, frames of links, inverse in closed form and numeric.

use criterion::{Criterion, criterion_group, criterion_main};
use regrasp_api::{FingerIndex, FingerJoints, Hand, HandDescription, Random, Vec3};
use regrasp_world::{ChainHand, LinkFrame};
use std::hint::black_box;

const FIRST: FingerIndex = FingerIndex(0);
/// Postures among which each benchmark goes round.
const CASES: usize = 256;

fn description(name: &str) -> HandDescription {
    let path = format!("{}/../../scenarios/hands/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    toml::from_str(&std::fs::read_to_string(path).expect("the hand's file is there")).expect("it can be read")
}

fn hand(description: HandDescription) -> ChainHand {
    ChainHand::new(description).expect("the hand is sound")
}

/// A posture, a second one close to it, and the tip of the first.
struct Case {
    joints: FingerJoints,
    near: FingerJoints,
    p_HF: Vec3,
}

fn cases(hand: &ChainHand) -> Vec<Case> {
    let mut random = Random::from_key(1, 0, 0, 0);
    let mut posture = || {
        let limits = &hand.finger(FIRST).joints;
        let values: Vec<_> = limits.iter().map(|joint| random.range(joint.lower, joint.upper)).collect();
        FingerJoints::from_slice(&values)
    };
    let mut case = || {
        let joints = posture();
        let near = joints.interpolate(&posture(), 0.1);
        Case { joints, near, p_HF: hand.tip_center(FIRST, &joints) }
    };
    (0..CASES).map(|_| case()).collect()
}

fn bench(c: &mut Criterion, name: &str, hand: &ChainHand, mut call: impl FnMut(&ChainHand, &Case)) {
    let cases = cases(hand);
    let mut next = 0;
    c.bench_function(name, |b| {
        b.iter(|| {
            next = (next + 1) % CASES;
            call(hand, black_box(&cases[next]));
        });
    });
}

fn forward(c: &mut Criterion) {
    let four = hand(description("four-finger"));
    bench(c, "tip centre, 3 joints", &four, |hand, case| {
        black_box(hand.tip_center(FIRST, &case.joints));
    });
    bench(c, "tip kinematics, 3 joints", &four, |hand, case| {
        black_box(hand.tip_kinematics(FIRST, &case.joints));
    });
    bench(c, "frames of links, 3 joints", &four, |hand, case| {
        let mut room = LinkFrame::room();
        black_box(hand.link_frames(FIRST, &case.joints, &mut room));
    });
}

fn inverse(c: &mut Criterion) {
    let call = |hand: &ChainHand, case: &Case| {
        black_box(hand.inverse(FIRST, &case.p_HF, &case.near));
    };
    for name in ["four-finger", "three-finger", "free-fingertips"] {
        bench(c, &format!("inverse, closed form, {name}"), &hand(description(name)), call);
    }
    let mut skew = description("four-finger");
    skew.finger[0].joint[2].axis = [0.1, 1.0, 0.0];
    let skew = hand(skew);
    assert!(!skew.is_closed_form(FIRST));
    bench(c, "inverse, numeric, from near", &skew, call);
    bench(c, "inverse, numeric, out of reach", &skew, |hand, case| {
        let p_HF =
            hand.finger(FIRST).p_HReach + (case.p_HF - hand.finger(FIRST).p_HReach).normalize() * 0.105;
        black_box(hand.inverse(FIRST, &p_HF, &case.near));
    });
    let mut redundant = description("four-finger");
    let mut last = redundant.finger[0].joint[2].clone();
    last.name = "last".into();
    redundant.finger[0].joint.push(last);
    redundant.finger[0].rest.push(0.5);
    let redundant = hand(redundant);
    assert!(redundant.is_closed_form(FIRST));
    bench(c, "inverse, closed form, 4 joints", &redundant, call);
}

fn building(c: &mut Criterion) {
    let description = description("four-finger");
    c.bench_function("building four-finger", |b| b.iter(|| hand(black_box(description.clone()))));
}

criterion_group!(benches, forward, inverse, building);
criterion_main!(benches);
