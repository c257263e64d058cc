//! The hands of the tests: those of the scenario files, and chains made at random.

use regrasp_api::{
    FingerDescription, FingerIndex, FingerJoints, Hand, HandDescription, JointDescription, JointKind,
    PoseDescription, Random, Vec3,
};
use regrasp_world::ChainHand;

/// The only finger of a hand with one finger.
pub const FIRST: FingerIndex = FingerIndex(0);

/// A hand file's text.
pub fn text(name: &str) -> String {
    let path = format!("{}/../../scenarios/hands/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The description in a hand file.
pub fn description(name: &str) -> HandDescription {
    toml::from_str(&text(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The hand of a hand file.
pub fn load(name: &str) -> ChainHand {
    ChainHand::new(description(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A joint about or along `axis`, at `position` in the frame of the link before.
pub fn joint(kind: JointKind, axis: [f64; 3], position: [f64; 3], limits: (f64, f64)) -> JointDescription {
    JointDescription {
        name: String::new(),
        kind,
        origin: PoseDescription { position, ..Default::default() },
        axis,
        lower: limits.0,
        upper: limits.1,
        velocity: 1.0,
        acceleration: 1.0,
        effort: 1.0,
        mimic: None,
        link: Vec::new(),
    }
}

/// A hand with one finger of these joints, which rests in the middle of its ranges.
pub fn one_finger(mut joints: Vec<JointDescription>, tip: [f64; 3]) -> HandDescription {
    joints.iter_mut().enumerate().for_each(|(index, joint)| joint.name = format!("joint-{index}"));
    let rest = joints.iter().map(|joint| 0.5 * (joint.lower + joint.upper)).collect();
    let base = PoseDescription {
        position: [0.03, -0.02, 0.01],
        axis: Some([0.3, -0.5, 0.8]),
        angle_deg: Some(50.0),
        ..Default::default()
    };
    let finger = FingerDescription { name: "finger".into(), base, joint: joints, tip, rest };
    HandDescription {
        name: "one finger".into(),
        references: Vec::new(),
        fingertip_radius: 0.01,
        fingertip: Default::default(),
        palm: Vec::new(),
        finger: vec![finger],
        touching: Vec::new(),
    }
}

fn vector(random: &mut Random, size: f64) -> [f64; 3] {
    (random.direction() * random.range(0.5 * size, size)).into()
}

/// A finger of `count` joints without any pattern, revolute but for one in five.
pub fn random_chain(random: &mut Random, count: usize) -> HandDescription {
    let joints = (0..count)
        .map(|_| {
            let (kind, limits) = match random.index(5) {
                0 => (JointKind::Prismatic, (-0.02, 0.03)),
                _ => (JointKind::Revolute, (random.range(-2.0, -0.5), random.range(0.5, 2.0))),
            };
            let mut joint = joint(kind, vector(random, 1.0), vector(random, 0.05), limits);
            joint.origin.axis = Some(vector(random, 1.0));
            joint.origin.angle_deg = Some(random.range(-180.0, 180.0));
            joint
        })
        .collect();
    one_finger(joints, vector(random, 0.05))
}

/// Three revolute joints in any place and at any angle, the first two or the last two parallel (or opposite).
pub fn random_parallel(random: &mut Random, lone_first: bool) -> HandDescription {
    let (lone, pair) = (vector(random, 1.0), vector(random, 1.0));
    let opposite = Vec3::from(pair) * if random.index(2) == 0 { -2.0 } else { 0.5 };
    let axes = if lone_first { [lone, pair, opposite.into()] } else { [pair, opposite.into(), lone] };
    let joints = axes
        .into_iter()
        .map(|axis| {
            let limits = (random.range(-3.0, -0.5), random.range(0.5, 3.0));
            joint(JointKind::Revolute, axis, vector(random, 0.05), limits)
        })
        .collect();
    one_finger(joints, vector(random, 0.05))
}

/// A posture, uniform within the limits.
pub fn posture(hand: &dyn Hand, finger: FingerIndex, random: &mut Random) -> FingerJoints {
    let joints = &hand.finger(finger).joints;
    let values: Vec<_> = joints.iter().map(|joint| random.range(joint.lower, joint.upper)).collect();
    FingerJoints::from_slice(&values)
}

/// The fingers of a hand.
pub fn fingers(hand: &dyn Hand) -> impl Iterator<Item = FingerIndex> + use<> {
    (0..hand.finger_count() as u8).map(FingerIndex)
}
