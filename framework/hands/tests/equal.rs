//! A random hand, written as URDF, as MJCF and as hand file, is read as the same hand three times.

use nalgebra::UnitQuaternion;
use proptest::prelude::*;
use regrasp_api::{Body, FingerIndex, FingerJoints, Hand, HandDescription, Random};
use regrasp_hands::{HandOptions, ReadHand, read_hand};
use regrasp_world::ChainHand;
use std::fmt::Write;

/// A joint with the link behind it.
#[derive(Clone, Debug)]
struct Joint {
    /// Its frame in that of the joint before (m; roll, pitch, yaw in rad).
    xyz: [f64; 3],
    rpy: [f64; 3],
    axis: [f64; 3],
    range: (f64, f64),
    effort: f64,
    /// Edges of a box about the middle of the link (m).
    size: [f64; 3],
}

type Finger = Vec<Joint>;

fn joint(place: usize) -> impl Strategy<Value = Joint> {
    let xyz = [-0.004..0.004, -0.004..0.004, if place == 0 { 0.0..0.01 } else { 0.03..0.05 }];
    // The first joint spreads the finger, the others bend it: every finger can go in all directions.
    let axis = if place == 0 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let rpy = [-0.2..0.2, -0.2..0.2, -0.2..0.2];
    let size = [0.006..0.012, 0.006..0.012, 0.01..0.02];
    (xyz, rpy, -1.0..-0.2_f64, 0.3..1.4_f64, 0.2..2.0_f64, size).prop_map(
        move |(xyz, rpy, low, high, effort, size)| Joint { xyz, rpy, axis, range: (low, high), effort, size },
    )
}

fn hands() -> impl Strategy<Value = Vec<Finger>> {
    let finger = (3..=4_usize).prop_flat_map(|count| (0..count).map(joint).collect::<Vec<_>>());
    prop::collection::vec(finger, 3..=5).prop_map(|mut fingers| {
        let count = fingers.len() as f64;
        for (f, finger) in fingers.iter_mut().enumerate() {
            let angle = std::f64::consts::TAU * f as f64 / count;
            let base = &mut finger[0];
            (base.xyz[0], base.xyz[1]) = (base.xyz[0] + 0.06 * angle.cos(), base.xyz[1] + 0.06 * angle.sin());
            base.rpy[2] += angle;
        }
        fingers
    })
}

fn words(numbers: impl IntoIterator<Item = f64>) -> String {
    numbers.into_iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(" ")
}

/// How far behind the last joint the tip's ball is (m), and its radius.
const TIP: (f64, f64) = (0.04, 0.009);

fn urdf(fingers: &[Finger]) -> String {
    let mut text = String::from("<robot name=\"h\"><link name=\"palm\"/>\n");
    for (f, finger) in fingers.iter().enumerate() {
        let mut parent = "palm".to_owned();
        for (j, joint) in finger.iter().enumerate() {
            let link = format!("f{f}l{j}");
            writeln!(
                text,
                "<link name=\"{link}\"><collision><origin xyz=\"0 0 0.01\"/><geometry><box \
                 size=\"{}\"/></geometry></collision></link>\
                 <joint name=\"f{f}j{j}\" type=\"revolute\"><parent link=\"{parent}\"/><child \
                  link=\"{link}\"/><origin xyz=\"{}\" rpy=\"{}\"/>\
                 <axis xyz=\"{}\"/><limit lower=\"{:?}\" upper=\"{:?}\" velocity=\"2\" \
                  effort=\"{:?}\"/></joint>",
                words(joint.size),
                words(joint.xyz),
                words(joint.rpy),
                words(joint.axis),
                joint.range.0,
                joint.range.1,
                joint.effort
            )
            .unwrap();
            parent = link;
        }
        writeln!(
            text,
            "<link name=\"f{f}tip\"><collision><geometry><sphere \
             radius=\"{}\"/></geometry></collision></link><joint name=\"f{f}end\" type=\"fixed\">\
             <parent link=\"{parent}\"/><child link=\"f{f}tip\"/><origin xyz=\"0 0 {}\"/></joint>",
            TIP.1, TIP.0
        )
        .unwrap();
    }
    text + "</robot>"
}

fn mjcf(fingers: &[Finger]) -> String {
    let mut text = String::from(
        "<mujoco model=\"h\"><compiler angle=\"radian\" eulerseq=\"XYZ\"/><worldbody><body name=\"palm\">\n",
    );
    let mut actuators = String::new();
    for (f, finger) in fingers.iter().enumerate() {
        for (j, joint) in finger.iter().enumerate() {
            writeln!(
                text,
                "<body name=\"f{f}l{j}\" pos=\"{}\" euler=\"{}\"><joint name=\"f{f}j{j}\" axis=\"{}\" \
                 range=\"{}\"/>\
                 <geom type=\"box\" pos=\"0 0 0.01\" size=\"{}\"/>",
                words(joint.xyz),
                words(joint.rpy),
                words(joint.axis),
                words([joint.range.0, joint.range.1]),
                words(joint.size.map(|x| x / 2.0)),
            )
            .unwrap();
            let force = words([-joint.effort, joint.effort]);
            write!(actuators, "<motor joint=\"f{f}j{j}\" forcerange=\"{force}\"/>").unwrap();
        }
        write!(
            text,
            "<body name=\"f{f}tip\" pos=\"0 0 {}\"><geom \
         size=\"{}\"/></body>",
            TIP.0, TIP.1
        )
        .unwrap();
        text += &"</body>".repeat(finger.len());
    }
    text + "</body></worldbody><actuator>" + &actuators + "</actuator></mujoco>"
}

fn read(folder: &std::path::Path, name: &str, text: &str) -> ReadHand {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    read_hand(&path, &HandOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The largest difference of the frames of all links and of all tips over some postures (m; no unit).
fn apart(a: &ChainHand, b: &ChainHand) -> f64 {
    let mut random = Random::from_key(0, 9, 0, 0);
    let mut worst = 0.0_f64;
    for finger in (0..a.finger_count() as u8).map(FingerIndex) {
        for _ in 0..10 {
            let joints = &a.finger(finger).joints;
            let mut q = FingerJoints::zeros(joints.len());
            q.iter_mut().zip(joints).for_each(|(q, joint)| *q = random.range(joint.lower, joint.upper));
            worst = worst.max((a.tip_center(finger, &q) - b.tip_center(finger, &q)).norm());
        }
    }
    worst
}

fn same(first: &HandDescription, second: &HandDescription) {
    let chain = |hand: &HandDescription| ChainHand::new(hand.clone()).unwrap();
    let (a, b) = (chain(first), chain(second));
    assert_eq!(a.finger_count(), b.finger_count());
    assert!(apart(&a, &b) < 1e-9, "{}", apart(&a, &b));
    assert_eq!(first.fingertip_radius, second.fingertip_radius);
    assert_eq!(first.touching, second.touching);
    for (one, other) in first.finger.iter().zip(&second.finger) {
        assert_eq!(one.name, other.name);
        for (one, other) in one.joint.iter().zip(&other.joint) {
            assert_eq!((&one.name, one.lower, one.upper), (&other.name, other.lower, other.upper));
            assert_eq!((one.velocity, one.effort), (other.velocity, other.effort));
            assert_eq!(one.link.len(), other.link.len());
        }
    }
    let palm = Body::Palm;
    assert_eq!(first.body_name(palm), second.body_name(palm));
}

/// Roll, pitch and yaw are turns about fixed axes in both formats.
#[test]
fn capitals_are_fixed_axes() {
    let rpy = UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3);
    let turn = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    let (x, y, z) = (nalgebra::Vector3::x_axis(), nalgebra::Vector3::y_axis(), nalgebra::Vector3::z_axis());
    assert!(rpy.angle_to(&(turn(z, 0.3) * turn(y, 0.2) * turn(x, 0.1))) < 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn three_formats_give_one_hand(fingers in hands()) {
        let folder = tempfile::tempdir().unwrap();
        let first = read(folder.path(), "hand.urdf", &urdf(&fingers)).description;
        let second = read(folder.path(), "hand.xml", &mjcf(&fingers)).description;
        same(&first, &second);
        let third: HandDescription = toml::from_str(&toml::to_string(&first).unwrap()).unwrap();
        prop_assert_eq!(&third, &first);
    }
}
