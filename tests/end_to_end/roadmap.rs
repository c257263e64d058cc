//! `regrasp roadmap`, and `plan` through one, from outside: what is kept, what is refused.

use crate::desk::{Desk, built_in};
use std::fs;

#[test]
fn a_roadmap_grows_on_and_plans_go_through_it() {
    let desk = Desk::new();
    assert_eq!(desk.run("roadmap sphere --nodes 60 -o a.roadmap").code, 0);
    let said = desk.run("roadmap sphere --nodes 120 --threads 2 --report 4 --json -o a.roadmap");
    let told = said.json();
    assert_eq!((&told["nodes"], &told["grown"]), (&120.into(), &60.into()), "{}", said.err);
    assert_eq!(told["report"][0]["pairs"], 4);
    assert_eq!(desk.run("roadmap sphere --nodes 120 -o whole.roadmap").code, 0);
    assert!(fs::read(desk.path("a.roadmap")).unwrap() == fs::read(desk.path("whole.roadmap")).unwrap());
    let said = desk.run("plan sphere --roadmap a.roadmap --json -o plan.json");
    let told = said.json();
    assert_eq!((said.code, &told["verified"]), (0, &true.into()), "{}", said.err);
    assert!(told["phases_s"]["roadmap"].is_number(), "{told}");
    assert_eq!(desk.run("verify plan.json").code, 0);
    let before = desk.read("plan.json");
    desk.run("plan sphere --roadmap a.roadmap -o plan.json");
    let segments = |text: &str| serde_json::from_str::<serde_json::Value>(text).unwrap()["segments"].clone();
    assert!(segments(&before) == segments(&desk.read("plan.json")), "the same plan");
}

#[test]
fn roadmaps_that_do_not_fit_are_refused() {
    let desk = Desk::new();
    assert_eq!(desk.run("roadmap sphere --nodes 20 -o a.roadmap").code, 0);
    let whole = fs::read(desk.path("a.roadmap")).unwrap();
    desk.run("plan cubic --roadmap a.roadmap").assert_fails(2, &["`ball`", "`cube`", "regrasp roadmap"]);
    desk.run("plan allegro-ball --roadmap a.roadmap").assert_fails(2, &["hand", "`four-finger`"]);
    desk.run("plan sphere --roadmap a.roadmap --set stability-test.undecided_margin=0.00001")
        .assert_fails(2, &["plugins"]);
    desk.run("roadmap sphere --nodes 30 --seed 1 -o a.roadmap").assert_fails(2, &["seed", "--force"]);
    assert_eq!(fs::read(desk.path("a.roadmap")).unwrap(), whole);
    let plan = |bytes: &[u8]| {
        fs::write(desk.path("b.roadmap"), bytes).unwrap();
        desk.run("plan sphere --roadmap b.roadmap")
    };
    plan(&whole[..whole.len() / 2]).assert_fails(2, &["cut short", "bytes of"]);
    plan(b"my thesis").assert_fails(2, &["no roadmap"]);
    let mut other = whole.clone();
    other[16] = 99;
    plan(&other).assert_fails(2, &["version 99", "version 1"]);
    let mut damaged = whole.clone();
    damaged[whole.len() - 20] ^= 1;
    plan(&damaged).assert_fails(2, &["damaged", "digest"]);
    desk.write("mine.roadmap", "my data");
    desk.run("roadmap sphere --nodes 20 -o mine.roadmap").assert_fails(2, &["it exists", "--force"]);
    desk.run("plan sphere --roadmap none.roadmap").assert_fails(2, &["none.roadmap"]);
}

const GOALS: &str = "[[goal]]
pose = { position = [0.0, 0.0, 0.085], axis = [0.0, 0.0, 1.0], angle_deg = 40.0 }
[[goal]]
pose = { position = [0.0, 0.0, 0.085], axis = [0.0, 0.0, 1.0] }
[[goal]]
pose = { position = [0.0, 0.0, 0.0] }
[[goal]]
pose = { position = [0.0, 0.0, 0.085], axis = [1.0, 0.0, 0.0], angle_deg = 60.0 }
";

#[test]
fn each_goal_of_a_list_is_a_plan_and_a_wrong_row_stops_none() {
    let desk = Desk::new();
    assert_eq!(desk.run("roadmap sphere --nodes 100 -o a.roadmap").code, 0);
    desk.write("goals.toml", GOALS);
    for (roadmap, by_roadmap) in [("", false), (" --roadmap a.roadmap", true)] {
        let said = desk.run(&format!("plan sphere --goals goals.toml{roadmap} --json -o plans"));
        assert_eq!(said.code, 2, "{}", said.err);
        assert!(said.err.contains("2 of 4 goals") && said.err.contains("goal 2, 3"), "{}", said.err);
        let rows: Vec<serde_json::Value> =
            said.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let verified: Vec<bool> = rows.iter().map(|row| row["verified"] == true).collect();
        assert_eq!(verified, [true, false, false, true]);
        assert!(rows[1]["error"]["message"].as_str().unwrap().contains("angle_deg"), "{}", rows[1]);
        assert_eq!(rows[1]["error"]["line"], 4);
        assert!(rows[2]["error"]["message"].as_str().unwrap().contains("overlap"), "{}", rows[2]);
        assert!(!by_roadmap || rows[0]["by_roadmap"] == true, "{}", rows[0]);
    }
    assert_eq!(desk.run("verify plans/goal-00004.json").code, 0);
    desk.run("plan sphere --goals none.toml").assert_fails(2, &["none.toml"]);
    desk.run("plan sphere --goals goals.toml -o goals.toml").assert_fails(2, &["folder"]);
    desk.run("plan sphere --roadmap-add").assert_fails(2, &["--roadmap"]);
}

#[test]
fn what_the_roadmap_did_not_know_is_added() {
    let desk = Desk::new();
    assert_eq!(desk.run("roadmap sphere --nodes 1 -o a.roadmap").code, 0);
    let said = desk.run("plan sphere --roadmap a.roadmap --roadmap-add");
    assert!(said.code == 0 && said.out.contains("knows no way"), "{}{}", said.out, said.err);
    assert!(said.err.contains("were added"), "{}", said.err);
    let said = desk.run("plan sphere --roadmap a.roadmap");
    assert!(said.code == 0 && !said.out.contains("knows no way"), "{}", said.out);
    let told = desk.run("roadmap sphere --nodes 1 --json -o a.roadmap").json();
    assert!(told["learnt"].as_u64().unwrap() > 2, "{told}");
}

#[test]
fn a_workspace_without_grasps_is_told() {
    let desk = Desk::new();
    let text = "[workspace]\nlower = [0.0, 0.0, 0.5]\nupper = [0.01, 0.01, 0.51]\n\n[start]\n";
    desk.write("far.toml", built_in("sphere", &[("[start]\n", text)]));
    desk.run("roadmap far.toml --nodes 5 -o a.roadmap").assert_fails(3, &["no more grasps", "workspace"]);
}
