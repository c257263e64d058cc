//! Kinds of files that are read as they are meant, or refused with what is wrong: couplings, soft and
//! missing limits, units, weak fingers.

use crate::desk::Desk;
use crate::generator::{Pattern, hand};
use serde_json::Value;

const LIMIT: &str = "<limit lower=\"-0.9\" upper=\"0.9\" velocity=\"4\" effort=\"1\"/>";

fn good() -> String {
    hand(Pattern { fingers: 4, joints: 3, link: "capsule", driven: false })
}

/// What `regrasp hand` says about a file as JSON.
#[track_caller]
fn read(text: String, options: &str) -> Value {
    let desk = Desk::new();
    desk.write("hand.urdf", text);
    let said = desk.run(&format!("hand hand.urdf --json {options}"));
    assert_eq!(said.code, 0, "{}", said.err);
    said.json()
}

#[track_caller]
fn refusal(text: String, options: &str, parts: &[&str]) {
    let desk = Desk::new();
    desk.write("hand.urdf", text);
    desk.run(&format!("hand hand.urdf {options}")).assert_fails(2, parts);
}

fn with(inside: &str) -> String {
    good().replace("</robot>", &format!("{inside}</robot>"))
}

fn notes(report: &Value) -> String {
    report["report"]["notes"].to_string()
}

/// A lever of two hinges beside the fingers; the second follows the first, with a rod on it.
fn lever(first: &str, mimic: &str) -> String {
    with(&format!(
        "<link name=\"arm\"/><joint name=\"first\" type=\"revolute\"><parent link=\"palm\"/><child \
         link=\"arm\"/><axis xyz=\"0 1 0\"/>{first}</joint>\
         <link name=\"rod\"><collision><origin xyz=\"0 0 0.03\"/><geometry><box size=\"0.004 0.004 \
          0.06\"/></geometry></collision></link>\
         <joint name=\"second\" type=\"revolute\"><parent link=\"arm\"/><child link=\"rod\"/><axis xyz=\"0 \
          1 0\"/>\
         <limit lower=\"-3\" upper=\"3\" velocity=\"1\" effort=\"1\"/>{mimic}</joint>"
    ))
}

/// Where the rod's middle stands in the palm.
fn rod(text: String, options: &str) -> [f64; 3] {
    let report = read(text, options);
    let palm = report["hand"]["palm"].as_array().unwrap();
    let rod = palm.iter().find(|placed| placed["shape"]["size"][2] == 0.06).unwrap();
    [0, 1, 2].map(|k| rod["pose"]["position"][k].as_f64().unwrap())
}

fn is_at(place: [f64; 3], angle: f64) {
    let expected = [0.03 * angle.sin(), 0.0, 0.03 * angle.cos()];
    assert!(place.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{place:?}, not {expected:?}");
}

#[test]
fn what_no_finger_has_stands_where_its_driver_has_it() {
    let limit = |low: f64| format!("<limit lower=\"{low}\" upper=\"1\" velocity=\"1\" effort=\"1\"/>");
    let mimic = "<mimic joint=\"first\" multiplier=\"2\" offset=\"0.5\"/>";
    is_at(rod(lever(&limit(-1.0), mimic), ""), 0.5);
    // A driver whose range leaves zero out starts at its end, and what follows it with it.
    is_at(rod(lever(&limit(0.2), mimic), ""), 0.2 + 0.9);
    is_at(rod(lever(&limit(-1.0), mimic), "--posture first=0.1"), 0.1 + 0.7);
    refusal(lever(&limit(0.0), "<mimic joint=\"third\"/>"), "", &["`second`", "`third`", "does not have"]);
    let ring = lever(&format!("{}<mimic joint=\"second\"/>", limit(0.0)), "<mimic joint=\"first\"/>");
    refusal(ring, "", &["in the end mimics it"]);
}

#[test]
fn soft_limits_narrow_and_are_said() {
    let soft = |low: &str, high: &str| {
        let soft = format!(
            "<safety_controller soft_lower_limit=\"{low}\" soft_upper_limit=\"{high}\" k_velocity=\"1\"/>"
        );
        read(good().replacen(LIMIT, &format!("{LIMIT}{soft}"), 1), "")
    };
    let report = soft("-0.1", "2.0");
    let joint = &report["hand"]["finger"][0]["joint"][0];
    assert_eq!((joint["lower"].as_f64(), joint["upper"].as_f64()), (Some(-0.1), Some(0.9)));
    assert!(notes(&report).contains("<safety_controller>"), "{}", notes(&report));
    let report = soft("0", "0");
    assert_eq!(report["hand"]["finger"][0]["joint"][0]["upper"], 0.9);
    assert!(notes(&report).contains("leaves it no range"));
}

#[test]
fn continuous_joints_need_no_limits_and_keep_those_they_have() {
    let kind = "name=\"f0_abduction\" type=\"revolute\"";
    let turning = |limit: &str| {
        good().replacen(kind, &kind.replace("revolute", "continuous"), 1).replacen(LIMIT, limit, 1)
    };
    let range = |report: &Value| {
        let joint = &report["hand"]["finger"][0]["joint"][0];
        (joint["lower"].as_f64().unwrap(), joint["upper"].as_f64().unwrap())
    };
    let pi = std::f64::consts::PI;
    assert_eq!(range(&read(turning(""), "--velocity 3 --effort 1")), (-pi, pi));
    assert_eq!(range(&read(turning("<limit velocity=\"3\" effort=\"1\"/>"), "")), (-pi, pi));
    let report = read(turning(LIMIT), "");
    assert!(range(&report) == (-0.9, 0.9) && notes(&report).contains("they are kept"));
    let report = read(turning(&LIMIT.replace("0.9", "0")), "");
    assert!(range(&report) == (-pi, pi) && notes(&report).contains("they are dropped"));
    refusal(turning(""), "", &["`velocity`", "`effort`", "--velocity 3 --effort 1"]);
}

#[test]
fn joints_without_a_range_are_fixed_unless_one_is_given() {
    let still = LIMIT.replace("-0.9", "0.2").replace("\"0.9\"", "\"0.2\"");
    let text = good().replace(LIMIT, &still);
    refusal(text.clone(), "", &["nothing in the file can be a finger", "--limits"]);
    let report = read(text, "--limits -0.5..0.5");
    assert_eq!(report["hand"]["finger"][3]["joint"][0]["upper"], 0.5);
    let report = read(good().replacen(LIMIT, &still, 1), "");
    assert_eq!(report["hand"]["finger"].as_array().unwrap().len(), 3);
    assert!(notes(&report).contains("`f0_abduction` has the limits 0.2..0.2: it is taken as fixed there"));
}

#[test]
fn joints_are_set_by_their_names() {
    let report = read(good(), "--limits f1_*=-0.4..0.6 --velocity *_abduction=7 --effort f0_*=0.25");
    let joint = |f: usize, j: usize| &report["hand"]["finger"][f]["joint"][j];
    assert_eq!((joint(1, 0)["lower"].as_f64(), joint(1, 2)["upper"].as_f64()), (Some(-0.4), Some(0.6)));
    assert_eq!((joint(2, 0)["velocity"].as_f64(), joint(2, 1)["velocity"].as_f64()), (Some(7.0), Some(4.0)));
    assert_eq!((joint(0, 2)["effort"].as_f64(), joint(1, 2)["effort"].as_f64()), (Some(0.25), Some(1.0)));
    refusal(good(), "--effort g*=1", &["`g*`", "`f0_abduction`"]);
}

#[test]
fn lengths_out_of_proportion_are_told_with_their_unit_and_key() {
    let offset = "<origin xyz=\"0 0 0.065\"/>";
    assert!(good().contains(offset));
    let far = good().replacen(offset, "<origin xyz=\"0 0 65\"/>", 1);
    refusal(far, "", &["offset of joint `f0_flexion1`", "times as much", "millimetres", "`scale` = 0.001"]);
    let long = good().replacen(
        "<capsule radius=\"0.007\" length=\"0.065\"/>",
        "<capsule radius=\"0.7\" length=\"6.5\"/>",
        1,
    );
    refusal(long, "", &["link `f0_link0`", "centimetres", "`scale` = 0.01"]);
    let strong = good().replace("velocity=\"4\" effort=\"1\"", "velocity=\"100\" effort=\"15\"");
    let said = notes(&read(strong, ""));
    for part in ["effort 15 N·m", "velocity 100 rad/s", "--effort '*=…'", "--velocity '*=…'"] {
        assert!(said.contains(part), "`{part}` is not in {said}");
    }
    // The whole hand in millimetres.
    let small = read(good(), "--scale 2");
    assert_eq!(small["hand"]["finger"][0]["joint"][2]["origin"]["position"][2], 0.13);
}

#[test]
fn weak_fingers_stay_as_bodies_and_too_few_are_refused_at_once() {
    let kind = |f: usize| format!("name=\"f{f}_flexion0\" type=\"revolute\"");
    let weak = |text: String, f: usize| text.replacen(&kind(f), &kind(f).replace("revolute", "fixed"), 1);
    let report = read(weak(good(), 0), "");
    assert_eq!(report["hand"]["finger"].as_array().unwrap().len(), 3);
    assert!(notes(&report).contains("`f0_tip` is no finger: 2 of the joints"));
    // Its links are part of the palm.
    assert_eq!(report["hand"]["palm"].as_array().unwrap().len(), 3);
    let one = weak(weak(weak(good(), 0), 1), 2);
    refusal(one, "", &["1 finger can hold", "at least 3 are needed, because", "`f1_tip`"]);
    let parallel = good().replacen("<axis xyz=\"1 0 0\"/>", "<axis xyz=\"0 1 0\"/>", 1);
    assert!(notes(&read(parallel, "")).contains("2 independent directions only (its axes are parallel)"));
}

#[test]
fn everything_that_is_missing_is_asked_for_at_once() {
    let text = good().replacen(LIMIT, "", 1).replacen(" velocity=\"4\" effort=\"1\"", "", 1);
    let bare = text.replace("<collision>", "<!--").replace("</collision>", "-->");
    let asked = ["`f0_abduction`: no limits", "lacks `velocity`", "lacks `effort`", "fingertip_radius"];
    refusal(bare.clone(), "", &asked);
    let flags = "--fingertip-radius 0.0100 --limits -1.57..1.57 --velocity 3 --effort 1";
    refusal(bare.clone(), "", &[flags]);
    read(bare, flags);
}

#[test]
fn what_has_no_say_is_listed_also_by_plan() {
    let text = good().replacen("<link name=\"f1_knuckle\">", "<link name=\"f1_knuckle\"><colision/>", 1);
    let report = read(text.clone(), "");
    assert!(notes(&report).contains("<colision> in <link>: not known, not used; is `collision` meant?"));
    let desk = Desk::new();
    desk.write("hand.urdf", text);
    let scenario = "[hand]\nurdf = \"hand.urdf\"\n[object]\nfriction = 0.8\nshape = { kind = \"sphere\", \
     radius = 0.03 }\n\
        [start]\npose = { position = [0.0, 0.0, 0.085] }\n[[goal]]\npose = { position = [0.0, 0.0, 0.087] \
         }\n";
    desk.write("a.toml", scenario);
    let said = desk.run("plan a.toml -o plan.json");
    assert!(said.err.contains("<colision> in <link>"), "{}", said.err);
}
