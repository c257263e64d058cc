//! What stands in the rows, whatever becomes of a run.

use super::shelf::{csv, runs, timeless};
use crate::desk::{Desk, built_in};
use serde_json::Value;
use std::collections::BTreeMap;

/// The rows of `runs.csv` as maps from the column's name.
pub fn rows(desk: &Desk, folder: &str) -> Vec<BTreeMap<String, String>> {
    let mut rows = csv(&desk.read(&format!("{folder}/runs.csv")));
    let head = rows.remove(0);
    rows.into_iter().map(|row| head.iter().cloned().zip(row).collect()).collect()
}

#[test]
fn the_full_factorial_is_there_in_order_and_sums_up() {
    let desk = Desk::new();
    let vary = "--vary sampler=rlg,projection --vary graph-strategy.end=0.3,0.6";
    let said = desk.run(&format!("compare sphere {vary} --seeds 2 --threads 2 -o two"));
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(said.out.contains("rlg + end=0.3") && said.out.contains("2/2"), "{}", said.out);
    let rows = rows(&desk, "two");
    assert_eq!(rows.len(), 8);
    let told = |row: &BTreeMap<String, String>| (row["variant"].clone(), row["seed"].clone());
    assert_eq!(told(&rows[0]), ("rlg + end=0.3".into(), "0".into()));
    assert_eq!(told(&rows[7]), ("projection + end=0.6".into(), "1".into()));
    for row in &rows {
        let number =
            |name: &str| row[name].parse::<f64>().unwrap_or_else(|_| panic!("{name}: {}", row[name]));
        let sum = |start: &str| {
            row.keys().filter(|name| name.starts_with(start)).map(|name| number(name)).sum::<f64>()
        };
        let planning = number("planning_s");
        assert!((sum("self.") - planning).abs() < 1e-9, "self times are all of the planning");
        // Plans take milliseconds: between two phases the machine may do something else for longer than that.
        let rest = planning - sum("phase.");
        assert!((-1e-9..0.2 * planning + 0.1).contains(&rest), "phases are nearly all of the planning");
        assert_eq!((row["status"].as_str(), row["verified"].as_str()), ("solved", "true"));
        assert!(number("margin") > 0.0 && number("clearance_m") > 0.0 && number("slip_m") < 1e-4);
        // The ball is turned by half a turn at least, on a way that is no shorter than none.
        assert!(number("object_turn_rad") > std::f64::consts::PI - 1e-6 && number("object_path_m") >= 0.0);
        assert!(number("joint_travel_rad") > 0.0 && number("joint_travel_m") == 0.0);
        assert!(number("stability-test.calls") > 0.0 && number("sampler.calls") > 0.0);
        let settings: Value =
            serde_json::from_str(&row["graph-strategy.settings"]).expect("settings are JSON");
        assert_eq!(settings["end"] == 0.3, row["variant"].ends_with("end=0.3"));
    }
    assert_eq!(desk.run(&format!("compare sphere {vary} --seeds 2 --threads 1 -o one")).code, 0);
    let (mut one, mut two) = (timeless(&desk.path("one")), timeless(&desk.path("two")));
    for study in [&mut one, &mut two] {
        study.get_mut("study.json").expect("it is there")["machines"] = Value::Null;
    }
    assert_eq!(one, two, "the number of threads changes times alone");
}

#[test]
fn a_row_says_what_plan_says() {
    let desk = Desk::new();
    assert_eq!(desk.run("compare cubic --seeds 1 --first-seed 5 -o study").code, 0);
    let plan = desk.run("plan cubic --seed 5 --json").json();
    let run = &runs(&desk.path("study"))[0];
    for key in ["generated_nodes", "graph_nodes", "components"] {
        assert_eq!(run["counts"][key], plan[key], "{key}");
    }
    for key in ["transfers", "regrasps", "regrasps_before_smoothing", "states", "duration_s"] {
        assert_eq!(run["motion"][key], plan[key], "{key}");
    }
    assert_eq!(run["certified"]["margin"], plan["certificate"]["closure_margin"]["value"]);
    let rejected = |slot: &str| run["counts"]["plugins"][slot]["rejections"].clone();
    assert_eq!(rejected("sampler"), plan["rejections"]["sampler"]);
    assert_eq!(desk.run("verify study/plans/cubic.json").code, 0);
}

#[test]
fn the_plans_of_all_runs_are_kept_where_that_is_asked_for() {
    let desk = Desk::new();
    let vary = ["--vary", "graph-strategy=interleaved{start=0.2},lazy"].join(" ");
    let said = desk.run(&format!("compare sphere {vary} --seeds 2 --keep-plans --isolate -o study"));
    assert_eq!(said.code, 0, "{}", said.err);
    for (plan, seed, used) in [
        ("sphere.json", 0, "interleaved"),
        ("sphere/0-1.json", 1, "interleaved"),
        ("sphere/1-0.json", 0, "lazy"),
        ("sphere/1-1.json", 1, "lazy"),
    ] {
        let text: Value = serde_json::from_str(&desk.read(&format!("study/plans/{plan}"))).expect("a plan");
        let strategy = &text["scenario"]["plugins"]["graph-strategy"];
        assert_eq!(
            (&text["seed"], &strategy["id"]),
            (&seed.into(), &format!("graph-strategy/{used}").into())
        );
        // The settings of one variant are no other's.
        assert_eq!(strategy["settings"]["start"] == 0.2, used == "interleaved", "{plan}: {strategy}");
    }
}

#[test]
fn runs_that_fail_are_rows() {
    let desk = Desk::new();
    // Three contacts on one side of the ball: a start that no contact model calls stable.
    let grasp = "[start]\ngrasp = [{ contact = [0.03, 0.0, 0.0] }, { contact = [0.0, 0.03, 0.0] }, {}, {}]";
    desk.write(
        "unstable.toml",
        built_in("sphere", &[("name = \"sphere\"", "name = \"un, \\\"stable\\\"\""), ("[start]", grasp)]),
    );
    let said = desk.run("compare unstable.toml --seeds 2 -o unstable");
    assert_eq!(said.code, 0, "{}", said.err);
    let found = rows(&desk, "unstable");
    assert_eq!(found.len(), 2);
    for row in &found {
        assert_eq!((row["status"].as_str(), row["verified"].as_str()), ("error", "false"));
        assert!(row["message"].contains("the grasp is not stable"), "{}", row["message"]);
        assert_eq!((row["scenario"].as_str(), row["regrasps"].as_str()), ("un, \"stable\"", ""));
    }
    assert_eq!(desk.run("compare cubic --seeds 2 --time-limit 0.001 -o hasty").code, 0);
    let found = rows(&desk, "hasty");
    assert!(found.iter().all(|row| row["status"] == "time-out" && row["message"].contains("time limit")));
    assert_eq!(desk.run("compare ellip-obst --seeds 3 --max-nodes 1 -o few").code, 0);
    let found = rows(&desk, "few");
    assert!(found.iter().any(|row| row["status"] == "no-plan" && row["message"].contains("budget of nodes")));
}

#[test]
fn what_a_hand_is_too_poor_for_is_refused_or_left_out() {
    let desk = Desk::new();
    let study = "compare sphere --vary contact-model=pcwf,frictionless --seeds 1 -o study";
    desk.run(study)
        .assert_fails(2, &["variant `frictionless`, scenario `sphere`", "fingers", "--skip-unsupported"]);
    assert!(!desk.path("study").exists(), "refused before anything is written");
    let said = desk.run(&format!("{study} --skip-unsupported"));
    assert_eq!((said.code, rows(&desk, "study").len()), (0, 1), "{}", said.err);
    assert!(said.out.contains("left out: `frictionless` on `sphere`"), "{}", said.out);
    let study = "compare sphere --vary contact-model=frictionless --skip-unsupported -o none";
    desk.run(study).assert_fails(2, &["nothing to run", "fingers"]);
}

#[test]
fn memory_is_measured_and_again_the_same_on_one_thread() {
    let desk = Desk::new();
    for folder in ["once", "again"] {
        let said = desk
            .run(&format!("compare sphere --vary sampler=rlg,projection --seeds 3 --threads 1 -o {folder}"));
        assert_eq!(said.code, 0, "{}", said.err);
    }
    let bytes = |folder: &str| -> Vec<u64> {
        rows(&desk, folder).iter().map(|row| row["memory_bytes"].parse().expect("it was measured")).collect()
    };
    let once = bytes("once");
    assert_eq!(once, bytes("again"));
    // Hundreds of states with their contacts take more than the first, and no plan of a ball the other.
    assert!(once.iter().all(|bytes| (100_000..1_000_000_000).contains(bytes)), "{once:?}");
    assert!(desk.read("once/comparisons.csv").contains("memory_bytes"));
    assert!(
        desk.read("once/summary.md").contains("| MB |") || desk.read("once/summary.md").contains(" MB |")
    );
}

#[test]
fn studies_of_earlier_programs_which_counted_no_memory_are_read() {
    let desk = Desk::new();
    assert_eq!(desk.run("compare sphere --seeds 2 -o old").code, 0);
    let text = desk.read("old/runs.jsonl");
    let without = |line: &str| {
        let mut run: Value = serde_json::from_str(line).expect("a line is a run");
        let times = run["times"].as_object_mut().expect("a table");
        assert!(times.remove("memory_bytes").is_some(), "{line}");
        format!("{run}\n")
    };
    desk.write("old/runs.jsonl", text.lines().map(without).collect::<String>());
    let said = desk.run("compare sphere --seeds 2 -o old");
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(rows(&desk, "old").iter().all(|row| row["memory_bytes"].is_empty()));
}
