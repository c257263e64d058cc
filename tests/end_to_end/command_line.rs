//! The command line beside planning: lists, schemas, help, interruption.

use crate::desk::{Desk, Said};
use serde_json::Value;
use std::process::{Command, Stdio};
use std::time::Duration;

#[test]
fn plugins_are_listed_with_all_that_a_script_needs() {
    let desk = Desk::new();
    let list = desk.run("plugins --json").json();
    let plugins = list.as_array().expect("a list");
    for plugin in plugins {
        for key in ["id", "role", "summary", "references", "settings_schema", "source"] {
            assert!(plugin.get(key).is_some_and(|value| !value.is_null()), "`{key}` is missing in {plugin}");
        }
    }
    let ids: Vec<&str> = plugins.iter().filter_map(|plugin| plugin["id"].as_str()).collect();
    let defaults = ["contact-model/pcwf", "stability-test/force-closure", "surface/geodesic", "sampler/rlg"];
    for id in
        defaults.into_iter().chain(["local-planner/linear", "local-planner/rolling", "local-planner/rrt"])
    {
        assert!(ids.contains(&id), "{id} is not in {ids:?}");
    }
    assert!(ids.is_sorted() && ids.contains(&"graph-strategy/interleaved"));
    assert!(desk.run("plugins sampler").out.contains("sampler/rlg"));
    assert!(!desk.run("plugins sampler").out.contains("surface/"));
    assert!(desk.run("plugins rlg").out.contains("setting"));
}

#[test]
fn scenarios_are_listed_and_their_files_printed() {
    let desk = Desk::new();
    let list = desk.run("scenarios --json").json();
    let names: Vec<&str> =
        list.as_array().expect("a list").iter().filter_map(|one| one["name"].as_str()).collect();
    for name in ["sphere", "sphere-tilt", "cubic", "ellip-obst", "sphere-free", "cube-free", "ellipsoid-free"]
    {
        assert!(names.contains(&name) && desk.run("scenarios").out.contains(name), "{name}");
    }
    desk.write("mine.toml", desk.run("scenarios sphere").out);
    desk.write("hand.toml", desk.run("scenarios four-finger").out);
    assert_eq!(desk.run("plan mine.toml").code, 0);
}

#[test]
fn schemas_are_json() {
    let desk = Desk::new();
    for (arguments, property) in [("schema", "goal"), ("schema hand", "finger")] {
        let schema = desk.run(arguments).json();
        assert!(schema["properties"].get(property).is_some(), "{arguments}");
    }
}

#[test]
fn every_help_has_an_example() {
    let desk = Desk::new();
    for command in ["plan", "verify", "compare", "plugins", "scenarios", "schema", "new-plugin"] {
        let said = desk.run(&format!("{command} --help"));
        assert_eq!(said.code, 0);
        assert!(said.out.contains("Example"), "{command}");
        assert!(said.out.contains(&format!("regrasp {command}")), "{command}");
    }
    assert!(desk.run("--help").out.contains("Exit codes"));
}

#[test]
fn no_colours_and_no_progress_where_nobody_watches() {
    let said = Desk::new().run("plan cubic --rejections");
    assert!(!said.out.contains('\u{1b}') && said.err.is_empty(), "{}", said.err);
    let head = said.out.lines().find(|line| line.contains("rejections by cause"));
    // Refusals say little without how often was asked.
    assert!(head.is_some_and(|line| line.contains("calls")), "{}", said.out);
}

#[test]
fn overrides_are_recorded() {
    let report = Desk::new()
        .run("plan sphere --use contact-model=soft-finger --set contact-model.gamma=0.004 --json")
        .json();
    let choice: &Value = &report["plugins"]["contact-model"];
    assert_eq!(
        (&choice["id"], &choice["settings"]["gamma"]),
        (&"contact-model/soft-finger".into(), &0.004.into())
    );
}

#[test]
fn the_readmes_scenario_works() {
    let readme = include_str!("../../README.md");
    let scenario =
        readme.split("```toml").nth(1).and_then(|rest| rest.split("```").next()).expect("a TOML block");
    let desk = Desk::new();
    desk.write("mine.toml", scenario);
    let said = desk.run("plan mine.toml");
    assert_eq!(said.code, 0, "{}", said.err);
}

/// A problem without a solution that is not given up soon: after an easy goal the ball is to go to the other
/// side of a wall.
fn endless(desk: &Desk) {
    let wall =
        "[[obstacle]]\nname = \"wall\"\nshape = { kind = \"box\", size = [0.6, 0.002, 0.6] }\n\n[start]";
    let changes = [
        ("pose = { position = [0.0, 0.0, 0.085] }", "pose = { position = [0.0, -0.036, 0.085] }"),
        ("pose = { position = [0.0, 0.0, 0.085], axis", "pose = { position = [0.0, 0.036, 0.085], axis"),
        ("[start]", wall),
        (
            "[[goal]]",
            "[[goal]]\npose = { position = [0.0, -0.036, 0.085], axis = [0.0, 0.0, 1.0], angle_deg = 40.0 \
                }\n\n[[goal]]",
        ),
    ];
    desk.write("mine.toml", crate::desk::built_in("sphere-free", &changes));
}

#[test]
#[cfg(unix)]
fn ctrl_c_and_its_like_end_the_search_with_their_own_exit_code() {
    ["-INT", "-TERM", "-HUP"].into_iter().for_each(ends_the_search);
}

#[cfg(unix)]
fn ends_the_search(signal: &str) {
    let desk = Desk::new();
    endless(&desk);
    let child = Command::new(env!("CARGO_BIN_EXE_regrasp"))
        .args(["plan", "mine.toml", "--max-nodes", "10000000", "-o", "plan.json"])
        .current_dir(desk.folder())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program was built for this test");
    std::thread::sleep(Duration::from_millis(1500));
    let signalled = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill runs");
    assert!(signalled.success());
    let said = Said::of(&child.wait_with_output().expect("the program ends"));
    said.assert_fails(130, &["interrupted", "goal 2", "kept as `plan.partial.json`"]);
    assert_eq!(desk.files(), ["mine.toml", "plan.partial.json"]);
    assert!(desk.read("plan.partial.json").contains("\"stopped_by\": \"interrupt\""));
}

#[test]
fn the_time_limit_ends_the_search() {
    let desk = Desk::new();
    endless(&desk);
    let said = desk.run("plan mine.toml --max-nodes 10000000 --time-limit 0.3 --json");
    said.assert_fails(3, &["time limit"]);
    assert_eq!(
        (&said.json()["stopped_by"], &said.json()["status"]),
        (&"time-limit".into(), &"interrupted".into())
    );
}
