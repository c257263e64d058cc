//! What can be wrong with a URDF: each fault has a message that names file, place and fix, and exit code 2.

use crate::desk::Desk;
use crate::generator::{Pattern, hand};

/// A sound hand of four fingers with three joints.
fn good() -> String {
    hand(Pattern { fingers: 4, joints: 3, link: "capsule", driven: false })
}

/// What `regrasp hand` says about the good hand with one replacement; it must refuse it.
fn refusal(from: &str, to: &str) -> String {
    refusal_with(from, to, "--fingertip-radius 0.01")
}

fn refusal_with(from: &str, to: &str, options: &str) -> String {
    let text = good();
    assert!(text.contains(from), "`{from}` is not in the generated file");
    let desk = Desk::new();
    desk.write("bad.urdf", text.replacen(from, to, 1));
    fails(&desk, &format!("hand bad.urdf {options}"))
}

/// What the program says as it refuses its input.
fn fails(desk: &Desk, arguments: &str) -> String {
    let said = desk.run(arguments);
    said.assert_fails(2, &[".urdf"]);
    said.err
}

#[track_caller]
fn says(message: &str, parts: &[&str]) {
    parts.iter().for_each(|part| assert!(message.contains(part), "`{part}` is not in:\n{message}"));
}

/// Every fingertip by name.
const ALL: &str = "--fingertip-radius 0.01 --tips f0_tip,f1_tip,f2_tip,f3_tip";

const LIMIT: &str = "<limit lower=\"-1.2\" upper=\"1.4\" velocity=\"4\" effort=\"1\"/>";

#[test]
fn the_good_hand_is_understood() {
    let desk = Desk::new();
    desk.write("good.urdf", good());
    let said = desk.run("hand good.urdf --fingertip-radius 0.01");
    assert_eq!(said.code, 0, "{}", said.err);
    says(&said.out, &["4 fingers, 12 joints", "f0_tip", "guessed", "closed form", "capsule", "position ="]);
}

#[test]
fn wrong_xml_is_refused_with_its_line() {
    says(&refusal("</robot>", ""), &["not well-formed XML", "bad.urdf:"]);
    says(&refusal("<robot name=\"generated\">", "<hand>"), &["XML"]);
    let desk = Desk::new();
    desk.write("bad.urdf", "<hand/>");
    let message = fails(&desk, "hand bad.urdf");
    says(&message, &["<hand>", "<robot>", "bad.urdf:1"]);
    desk.write("empty.urdf", "");
    says(&fails(&desk, "hand empty.urdf"), &["XML"]);
    let message = fails(&desk, "hand none.urdf");
    says(&message, &["none.urdf", "cannot read"]);
}

#[test]
fn links_that_are_not_there_are_named() {
    says(&refusal("parent link=\"f1_link0\"", "parent link=\"f1_link7\""), &["`f1_flexion1`", "`f1_link7`"]);
    let message = refusal_with("palm", "palm", "--tips f0_tip,thumb --fingertip-radius 0.01");
    says(&message, &["`thumb`", "`f3_tip`"]);
    says(&refusal_with("palm", "palm", "--palm hand --fingertip-radius 0.01"), &["`hand`", "`palm`"]);
    let twice = refusal_with("palm", "palm", "--tips f0_tip,f0_tip --fingertip-radius 0.01");
    says(&twice, &["`f0_tip`", "twice"]);
}

#[test]
fn missing_limits_are_no_silent_default() {
    says(&refusal(LIMIT, ""), &["`f0_flexion0`", "no limits", "<limit lower=", "bad.urdf:"]);
    says(&refusal(LIMIT, &LIMIT.replace("upper=\"1.4\" ", "")), &["`f0_flexion0`", "lacks `upper`"]);
    says(&refusal(LIMIT, &LIMIT.replace("velocity=\"4\" ", "")), &["lacks `velocity`"]);
    says(&refusal(LIMIT, &LIMIT.replace("effort=\"1\"", "")), &["lacks `effort`", "give `effort`"]);
    says(&refusal(LIMIT, &LIMIT.replace("\"4\"", "\"0\"")), &["`velocity` = 0", "positive"]);
    says(&refusal(LIMIT, &LIMIT.replace("-1.2", "1.5")), &["`f0_flexion0`", "less than"]);
    says(&refusal(LIMIT, &LIMIT.replace("1.4", "90")), &["degrees"]);
    says(&refusal(LIMIT, &LIMIT.replace("1.4", "NaN")), &["NaN", "finite"]);
    says(&refusal(LIMIT, &LIMIT.replace("1.4", "inf")), &["inf", "finite"]);
    says(&refusal(LIMIT, &LIMIT.replace("1.4", "a lot")), &["a lot", "finite"]);
}

#[test]
fn loops_and_two_roots_are_refused() {
    let joint = |parent: &str, child: &str| {
        format!(
            "<joint name=\"closing\" type=\"fixed\"><parent link=\"{parent}\"/><child \
                link=\"{child}\"/></joint></robot>"
        )
    };
    says(&refusal("</robot>", &joint("f0_tip", "palm")), &["loop", "closing"]);
    says(&refusal("</robot>", &joint("f0_tip", "f1_tip")), &["loop", "`f1_tip`", "`closing`"]);
    says(&refusal("</robot>", "<link name=\"lost\"/></robot>"), &["`palm`, `lost`", "one root"]);
    let ring = "<link name=\"a\"/><link name=\"b\"/>\
        <joint name=\"ab\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>\
        <joint name=\"ba\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint></robot>";
    says(&refusal("</robot>", ring), &["loop"]);
    says(&refusal("</robot>", "<link name=\"palm\"/></robot>"), &["two links", "`palm`"]);
}

#[test]
fn meshes_that_are_not_there_or_make_no_sense_are_refused() {
    let mesh = |file: &str| format!("<mesh filename=\"{file}\"/>");
    let box_of_palm = "<box size=\"0.14 0.14 0.02\"/>";
    let message = refusal(box_of_palm, &mesh("package://my_hand/meshes/palm.stl"));
    says(&message, &["package://my_hand/meshes/palm.stl", "--packages", "bad.urdf:3"]);
    says(&refusal(box_of_palm, &mesh("palm.stl")), &["palm.stl", "not there"]);
    says(&refusal(box_of_palm, &mesh("bad.urdf")), &["bad.urdf", "convert"]);
    says(&refusal(box_of_palm, "<mesh filename=\"palm.stl\" scale=\"0 1 1\"/>"), &["scale", "zero"]);
    says(&refusal(box_of_palm, "<box size=\"0.1 0.1\"/>"), &["size", "three finite numbers"]);
    says(&refusal(box_of_palm, "<box size=\"0.1 0.1 -1\"/>"), &["size", "-1"]);
    says(&refusal(box_of_palm, "<cone/>"), &["<cone>", "cylinder"]);
}

#[test]
fn joints_that_no_finger_can_have_are_refused() {
    says(&refusal("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 0 0\"/>"), &["`f0_flexion0`", "axis is zero"]);
    says(&refusal("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 nan 0\"/>"), &["axis", "finite"]);
    let kind = "name=\"f0_flexion0\" type=\"revolute\"";
    // Named, not guessed: a guess would leave the finger out.
    let named = |to: &str| refusal_with(kind, &kind.replace("revolute", to), ALL);
    says(&named("prismatic"), &["`f0_flexion0`", "prismatic", "`f0_tip`"]);
    says(&named("floating"), &["`f0_flexion0`", "neither revolute nor fixed"]);
    says(&refusal(kind, &kind.replace("revolute", "elastic")), &["elastic"]);
}

#[test]
fn fingers_need_three_independent_joints() {
    let kind = "name=\"f0_flexion0\" type=\"revolute\"";
    let fixed = kind.replace("revolute", "fixed");
    says(
        &refusal_with(kind, &fixed, "--fingertip-radius 0.01 --tips f0_tip,f1_tip,f2_tip"),
        &["`f0_tip` does not hold", "2 fingers can hold", "at least 3 are needed"],
    );
    let axis = "<axis xyz=\"1 0 0\"/>";
    says(&refusal_with(axis, "<axis xyz=\"0 1 0\"/>", ALL), &["f0_tip", "independent"]);
    let mimic = format!("{LIMIT}<mimic joint=\"f0_flexion1\"/>");
    says(
        &refusal_with(LIMIT, &mimic, "--fingertip-radius 0.01 --tips f0_tip,f1_tip,f2_tip"),
        &["`f0_tip`", "2 fingers can hold"],
    );
    let desk = Desk::new();
    desk.write("bad.urdf", good().replace("_abduction\" type=\"revolute\"", "_abduction\" type=\"fixed\""));
    says(
        &fails(&desk, "hand bad.urdf"),
        &["nothing in the file can be a finger", "`f0_tip`: 2 of the joints", "`f3_tip`: 2 of the joints"],
    );
    let desk = Desk::new();
    desk.write("bad.urdf", good().replace("type=\"revolute\"", "type=\"fixed\""));
    let message = fails(&desk, "hand bad.urdf");
    says(&message, &["no fingers"]);
}

#[test]
fn meshes_in_millimetres_are_recognised() {
    let desk = Desk::new();
    let mesh = "<mesh filename=\"palm.obj\"/>";
    desk.write("bad.urdf", good().replacen("<box size=\"0.14 0.14 0.02\"/>", mesh, 1));
    desk.write("palm.obj", "v 0 0 0\nv 70 0 0\nv 0 70 0\nv 0 0 10\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    says(
        &fails(&desk, "hand bad.urdf --fingertip-radius 0.01"),
        &["palm.obj", "70.0 m", "scale=\"0.001", "bad.urdf:3"],
    );
    desk.write("palm.obj", "v 0 0 0\nv 70 0 0\nv 0 70 0\n");
    says(&fails(&desk, "hand bad.urdf --fingertip-radius 0.01"), &["palm.obj", "no facets"]);
}

#[test]
fn files_of_macros_are_refused_with_what_to_do() {
    let desk = Desk::new();
    let macros = "<robot name=\"h\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:include \
        filename=\"a.xacro\"/></robot>";
    desk.write("hand.urdf", macros);
    says(&fails(&desk, "hand hand.urdf"), &["xacro hand.urdf.xacro > hand.urdf", "hand.urdf:1"]);
}

#[test]
fn drivers_must_be_joints_of_the_same_finger() {
    let mimic = |joint: &str| format!("{LIMIT}<mimic joint=\"{joint}\"/>");
    let text = hand(Pattern { fingers: 4, joints: 4, link: "capsule", driven: false });
    for (joint, part) in
        [("nobody", "does not have"), ("f1_flexion0", "another finger"), ("f0_flexion0", "in the end")]
    {
        let desk = Desk::new();
        desk.write("bad.urdf", text.replacen(LIMIT, &mimic(joint), 1));
        let message = fails(&desk, "hand bad.urdf --fingertip-radius 0.01");
        says(&message, &["`f0_flexion0`", part]);
    }
}

#[test]
fn what_the_file_does_not_say_must_be_given() {
    says(&refusal_with("palm", "palm", "--velocity 0"), &["`velocity` = 0 is outside"]);
    says(
        &refusal_with("palm", "palm", "--fingertip-radius -1"),
        &["`fingertip_radius` = -1", "0.0001..=0.2"],
    );
    let offsets = "--fingertip-radius 0.01 --tip-offset 0,0,0 --tip-offset 0,0,1";
    says(&refusal_with("palm", "palm", offsets), &["tip_offset", "4 fingers"]);
}

/// What `plan` says about the scenario `a.toml`.
fn refused(desk: &Desk) -> String {
    let said = desk.run("plan a.toml");
    said.assert_fails(2, &["a.toml"]);
    said.err
}

#[test]
fn a_scenario_names_the_urdf_and_its_line() {
    let desk = Desk::new();
    desk.write("bad.urdf", good().replacen(LIMIT, "", 1));
    let scenario = |hand: &str| {
        format!(
            "[hand]\n{hand}\n[object]\nfriction = 0.8\nshape = {{ kind = \"sphere\", radius = 0.03 \
                }}\n[start]\npose = {{ position = [0.0, 0.0, 0.085] }}\n\
             [[goal]]\npose = {{ position = [0.0, 0.0, 0.09] }}\n"
        )
    };
    desk.write("a.toml", scenario("urdf = \"bad.urdf\"\nfingertip_radius = 0.01"));
    let message = fails(&desk, "plan a.toml");
    says(&message, &["`f0_flexion0`", "bad.urdf:"]);
    desk.write("a.toml", scenario("urdf = \"bad.urdf\"\nfingertip_radius = 3.0"));
    says(&refused(&desk), &["a.toml:3", "fingertip_radius", "3 is outside 0.0001..=0.2 m"]);
    desk.write("a.toml", scenario("builtin = \"four-finger\"\ntips = [\"a\"]"));
    says(&refused(&desk), &["`tips`", "`urdf`"]);
    desk.write("a.toml", scenario("builtin = \"four-finger\"\nurdf = \"bad.urdf\""));
    says(&refused(&desk), &["give one of `builtin`"]);
}
