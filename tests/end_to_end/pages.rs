//! `--view` and `--page` of `hand` and `object`, and `view` of several plans: where pages go, and what they
//! leave alone.

use crate::desk::Desk;
use serde_json::Value;

/// What a page's scripts are told.
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"data\">").expect("the page holds data");
    serde_json::from_str(rest.split_once("</script>").expect("the element ends").0).expect("JSON")
}

/// A desk with a plan, and its hand as a URDF file.
fn desk() -> Desk {
    let desk = Desk::new();
    assert_eq!(desk.run("plan sphere -o plan.json").code, 0);
    assert_eq!(desk.run("export plan.json --to urdf").code, 0);
    desk
}

#[test]
fn a_hands_page_says_what_the_report_says() {
    let desk = desk();
    let urdf = "plan.hand.urdf";
    let told = desk.run(&format!("hand {urdf} --ball 0.025 --page hand.html"));
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.out.contains("joints (degrees"), "the report stays on standard output");
    assert!(told.err.contains("the page: hand.html"), "{}", told.err);
    let json = desk.run(&format!("hand {urdf} --ball 0.025 --json")).json();
    let data = data(&desk.read("hand.html"));
    assert_eq!(data["ball"]["position"], json["object_place"]["position"]);
    assert_eq!(data["ball"]["quality"], json["object_place"]["quality"]);
    assert_eq!(data["ball_radius"], 0.025);
    let (drawn, known) = (&data["hand"]["fingers"], &json["hand"]["finger"]);
    for (f, finger) in known.as_array().expect("fingers").iter().enumerate() {
        assert_eq!(drawn[f]["name"], finger["name"]);
        for (j, joint) in finger["joint"].as_array().expect("joints").iter().enumerate() {
            assert_eq!(drawn[f]["joints"][j]["range"][0], joint["lower"]);
            assert_eq!(drawn[f]["joints"][j]["range"][1], joint["upper"]);
        }
    }
    let standard = desk.run(&format!("hand {urdf} --page -"));
    assert!(standard.out.starts_with("<!doctype html>") && standard.err.contains("joints (degrees"));
}

#[test]
fn an_objects_page_holds_the_facts_that_are_printed() {
    let desk = Desk::new();
    desk.write("box.obj", BOX);
    let told = desk.run("object box.obj --page box.html");
    assert_eq!(told.code, 0, "{}", told.err);
    let data = data(&desk.read("box.html"));
    assert_eq!(data["twin"], Value::Null, "a box is smooth enough");
    let facts = data["facts"].as_array().expect("facts");
    assert!(facts.len() >= 6);
    for fact in facts {
        let line = format!("  {:<17}{}\n", fact[0].as_str().unwrap(), fact[1].as_str().unwrap());
        assert!(told.out.contains(&line), "{line}");
    }
}

#[test]
fn pages_destroy_nothing() {
    let desk = Desk::new();
    desk.write("box.obj", BOX);
    desk.write("mine.html", "<p>mine</p>");
    let told = desk.run("object box.obj --page mine.html");
    assert_eq!(told.code, 2);
    assert_eq!(desk.read("mine.html"), "<p>mine</p>");
    assert_eq!(desk.run("object box.obj --page box.obj").code, 2);
    assert_eq!(desk.read("box.obj"), BOX);
    let told = desk.run("object box.obj -o - --page -");
    assert!(told.code == 2 && told.err.contains("standard output"), "{}", told.err);
    assert_eq!(desk.run("object box.obj --page mine.html --force").code, 0);
    assert!(desk.read("mine.html").contains("regrasp view"));
}

#[test]
fn several_plans_are_shown_by_their_files_names() {
    let desk = desk();
    assert_eq!(desk.run("plan sphere --seed 5 -o other.json").code, 0);
    let told = desk.run("view plan.json other.json");
    assert!(told.code == 0 && told.out.starts_with("plan.html"), "{}", told.err);
    let data = data(&desk.read("plan.html"));
    assert_eq!([&data["label"], &data["beside"][0]["label"]], ["plan.json", "other.json"]);
    assert_eq!(data["beside"][0]["seed"], 5);
    // The plan's own forces, each inside its cone, as the certificate has it.
    let plan: Value = serde_json::from_str(&desk.read("plan.json")).expect("JSON");
    let most = plan["certificate"]["holds"]["effort"]["value"].as_f64().expect("a share");
    let efforts = data["grip"]["efforts"].as_array().expect("efforts");
    let found = efforts.iter().map(|x| x.as_f64().unwrap().abs()).fold(0.0, f64::max);
    assert!((found - most).abs() < 2e-3, "{found} {most}");
}

/// A box of 40 mm.
const BOX: &str = "\
v 0 0 0\nv .04 0 0\nv .04 .04 0\nv 0 .04 0\nv 0 0 .04\nv .04 0 .04\nv .04 .04 .04\nv 0 .04 .04\n\
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
