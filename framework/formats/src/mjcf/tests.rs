use super::*;
use crate::robot::{Geometry, Joint, Kind};
use nalgebra::Point3;
use regrasp_api::Vec3;
use std::f64::consts::FRAC_PI_2;

/// Reads a file with this text, beside one that it may include as `more.xml`.
fn read(text: &str) -> Result<Robot, Fault> {
    let folder = tempfile::tempdir().unwrap();
    let more = "<x><default><default class='tip'><geom size='0.007'/></default></default></x>";
    std::fs::write(folder.path().join("more.xml"), more).unwrap();
    let path = folder.path().join("hand.xml");
    std::fs::write(&path, format!("<mujoco model='m'>{text}</mujoco>")).unwrap();
    read_mjcf(&path)
}

fn joint<'r>(robot: &'r Robot, name: &str) -> &'r Joint {
    robot.joints.iter().find(|joint| joint.name == name).unwrap()
}

fn near(a: Vec3, b: [f64; 3]) {
    assert!((a - Vec3::from(b)).norm() < 1e-12, "{a} is not {b:?}");
}

#[test]
fn classes_includes_and_units_are_read() {
    let robot = read(
        "<include file='more.xml'/><compiler angle='degree' eulerseq='XYZ'/>\
         <default><joint range='-90 45'/><default class='finger'><joint axis='0 1 0'/></default></default>\
         <worldbody><body name='palm' pos='0 0 1' euler='0 0 90'><geom type='box' size='1 2 3' contype='0' \
          conaffinity='0'/>\
         <body name='a' childclass='finger' pos='1 0 0'><joint name='j'/><geom class='tip' pos='0 0 0.1'/>\
         <geom type='capsule' fromto='0 0 0 0.1 0 0' size='0.01'/></body></body></worldbody>",
    )
    .unwrap();
    let j = joint(&robot, "j");
    let limit = j.limit.unwrap();
    near(j.axis, [0.0, 1.0, 0.0]);
    assert!((limit.lower.unwrap() + FRAC_PI_2).abs() < 1e-12 && limit.velocity == Some(VELOCITY));
    let mount = joint(&robot, "palm mount");
    assert_eq!(mount.kind, Kind::Fixed);
    near((mount.X_PJ * Point3::new(1.0, 0.0, 0.0)).coords, [0.0, 1.0, 1.0]);
    let names: Vec<&str> = robot.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(names, ["world", "palm", "a"]);
    let (palm, a) = (&robot.links[1], &robot.links[2]);
    assert!(matches!(palm.visual.as_ref().unwrap()[0].geometry, Geometry::Box { size: [2.0, 4.0, 6.0] }));
    let shapes = a.collision.as_ref().unwrap();
    assert!(matches!(shapes[0].geometry, Geometry::Sphere { radius: 0.007 }));
    near(shapes[1].X_LS.translation.vector, [0.05, 0.0, 0.0]);
    near((shapes[1].X_LS * Point3::new(0.0, 0.0, 0.05)).coords, [0.0, 0.0, 0.0]);
}

#[test]
fn joints_about_an_anchor_and_with_a_reference_stand_as_the_file_has_them() {
    let robot = read(
        "<compiler angle='radian'/><worldbody><body name='b' pos='1 0 0'><joint name='j' pos='0 1 0' \
         axis='0 0 1' ref='0.5' range='-1 1'/>\
         <joint name='k' type='slide' axis='1 0 0' range='0 0.1'/></body></worldbody>",
    )
    .unwrap();
    // At the reference the body stands where it is written: the anchor's shift is undone behind the joint.
    let (j, k) = (joint(&robot, "j"), joint(&robot, "k"));
    let turn = |q: f64| regrasp_api::Rotation::from_scaled_axis(j.axis * q);
    let at = |q: f64| (j.X_PJ * turn(q) * k.X_PJ).translation.vector;
    near(at(0.5), [1.0, 0.0, 0.0]);
    near(at(0.5 + FRAC_PI_2), [2.0, 1.0, 0.0]);
    assert_eq!((k.kind, k.limit.unwrap().upper, k.child.as_str()), (Kind::Prismatic, Some(0.1), "b"));
}

#[test]
fn couplings_forces_exclusions_and_key_frames_are_read() {
    let robot = read(
        "<compiler angle='radian'/><default><position forcerange='-2 2'/></default>\
         <worldbody><body name='a'><freejoint/><body name='b'><joint name='j' range='0 1'/><body \
          name='c'><joint name='k' range='0 1'/>\
         <joint name='l'/></body></body></body></worldbody>\
         <equality><joint joint1='k' joint2='j' polycoef='0.1 0.8 0 0 0'/></equality><tendon><fixed \
          name='t'><joint joint='j' coef='1'/>\
         <joint joint='k' coef='0.5'/></fixed></tendon><actuator><position joint='l'/><motor tendon='t' \
          forcerange='-4 4' gear='2'/></actuator>\
         <contact><exclude body1='a' body2='c'/></contact><keyframe><key name='home' qpos='0 0 0 1 0 0 0 \
          0.2 0.3 0.4'/></keyframe>",
    )
    .unwrap();
    let mimic = joint(&robot, "k").mimic.clone().unwrap();
    assert_eq!((mimic.joint.as_str(), mimic.multiplier, mimic.offset), ("j", 0.8, 0.1));
    let effort = |name: &str| joint(&robot, name).limit.unwrap().effort;
    assert_eq!((effort("j"), effort("k"), effort("l")), (Some(8.0), Some(4.0), Some(2.0)));
    assert_eq!(joint(&robot, "l").kind, Kind::Continuous);
    assert_eq!(robot.excluded, [["a".to_owned(), "c".to_owned()]]);
    assert_eq!(robot.key_frames[0].positions["k"], 0.3);
    assert!(robot.remarks.iter().any(|remark| remark.contains("tendon `t` pulls the joints `j`, `k`")));
}

#[test]
fn what_is_not_read_is_refused_or_listed_with_its_line() {
    let robot =
        read("<option timestep='1'/>\n<worldbody>\n<body name='a'><site/>\n<wing/></body></worldbody>")
            .unwrap();
    let has =
        |list: &[String], part: &str| assert!(list.iter().any(|x| x.contains(part)), "{part}: {list:?}");
    has(&robot.remarks, "<wing> in <body>: not known, not used (line 4)");
    has(&robot.ignored, "<option> (line 1)");
    let message = |text: &str| read(text).unwrap_err().message;
    assert!(message("<worldbody><body><geom class='none'/></body></worldbody>").contains("`none`"));
    assert!(message("<compiler eulerseq='xy'/><worldbody/>").contains("eulerseq"));
    assert!(message("<include file='hand.xml'/><worldbody/>").contains("include"));
    assert!(message("").contains("<worldbody>"));
    let curve = "<worldbody><body><joint name='j'/><joint name='k'/></body></worldbody>\
        <equality><joint joint1='j' joint2='k' polycoef='0 1 1'/></equality>";
    assert!(message(curve).contains("straight lines"));
}

#[test]
fn numbers_that_no_robot_has_are_refused() {
    for inside in [
        "<body pos=\"1e160 0 0\"/>",
        "<body euler=\"0 nan 0\"/>",
        "<body><joint axis=\"0 0 1e160\"/></body>",
        "<body><inertial mass=\"inf\"/></body>",
        "<body><geom type=\"sphere\" size=\"1e160\"/><joint range=\"0 1e160\"/></body>",
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hand.xml");
        std::fs::write(&path, format!("<mujoco><worldbody>{inside}</worldbody></mujoco>")).unwrap();
        let message = read_mjcf(&path).unwrap_err().message;
        assert!(message.contains("-1e9..=1e9"), "{inside}: {message}");
    }
}

#[test]
fn motors_without_a_range_of_force_pull_with_their_gain_over_their_range() {
    let text = "<worldbody><body name='b'><joint name='j' range='0 1'/><joint name='k' range='0 1' axis='1 \
        0 0'/>\
                </body></worldbody><actuator><position joint='j' kp='2' ctrlrange='-0.5 1'/>\
                <general joint='k' biastype='affine' gainprm='3' ctrlrange='0 1' gear='2'/></actuator>";
    let robot = read(text).unwrap();
    let effort = |name: &str| joint(&robot, name).limit.unwrap().effort;
    assert_eq!((effort("j"), effort("k")), (Some(3.0), Some(6.0)));
    assert!(robot.remarks.iter().any(|remark| remark.contains("`j` and of 1 more has no `forcerange`")));
}

/// Bodies need no names, and files without line ends are read.
#[test]
fn bodies_without_names_in_one_line_are_told_apart() {
    let robot = read(
        "<worldbody><body><joint range='-1 1'/><body pos='0 0 1'><joint range='-1 1'/></body></body>\
         <body name='last'/></worldbody>",
    )
    .unwrap();
    let names: Vec<&str> = robot.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(names, ["world", "body in line 1", "body 2 in line 1", "last"]);
    let joints: Vec<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(joints[..2], ["body in line 1 joint 1", "body 2 in line 1 joint 1"]);
}
