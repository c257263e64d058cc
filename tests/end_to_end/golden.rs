//! The built-in scenarios, solved by the real binary: counts, verdicts and bytes, never wall time.

use crate::desk::{Desk, built_in};
use regrasp::run::scenario::SCENARIOS;
use serde_json::Value;

/// A plan file without the only thing in it that differs from run to run.
fn without_times(plan: &str) -> Value {
    let mut plan: Value = serde_json::from_str(plan).expect("a plan file is JSON");
    let times = plan["statistics"].as_object_mut().expect("statistics").remove("time_s");
    assert!(times.is_some(), "the plan holds the times of its phases");
    plan
}

#[test]
fn every_scenario_is_solved_and_verified_the_same_on_one_thread_and_two() {
    for scenario in SCENARIOS {
        for seed in 0..3 {
            let desk = Desk::new();
            let said = desk.run(&format!("plan {} --seed {seed} -o one.json --json", scenario.name));
            assert_eq!(said.code, 0, "{} with seed {seed}:\n{}", scenario.name, said.err);
            let report = said.json();
            assert_eq!((&report["status"], &report["verified"]), (&"solved".into(), &true.into()));
            let again = desk.run(&format!("plan {} --seed {seed} -o two.json --threads 2", scenario.name));
            assert_eq!(again.code, 0, "{}", again.err);
            let (one, two) = (desk.read("one.json"), desk.read("two.json"));
            assert!(without_times(&one) == without_times(&two), "{} with seed {seed}", scenario.name);
            assert_eq!(desk.files(), ["one.json", "two.json"]);
        }
    }
}

#[test]
fn samples_drawn_ahead_do_not_depend_on_the_nodes_that_are_extended_in_between() {
    // Half of its samples anywhere, half near a node: with seed 4 the two threads once gave another plan than
    // the one.
    for seed in 4..7 {
        let desk = Desk::new();
        for (threads, file) in [(1, "one.json"), (2, "two.json")] {
            let strategy = "--use graph-strategy=bidirectional --set graph-strategy.anywhere=0.5";
            let command = format!("plan sphere {strategy} --seed {seed} --threads {threads} -o {file}");
            assert_eq!(desk.run(&command).code, 0);
        }
        let [one, two] = ["one.json", "two.json"].map(|file| without_times(&desk.read(file)));
        assert!(one == two, "seed {seed}");
        std::fs::remove_file(desk.path("two.json"))
            .and(std::fs::remove_file(desk.path("one.json")))
            .expect("just written");
    }
}

#[test]
fn another_seed_gives_another_plan_and_the_same_seed_the_same_bytes() {
    let desk = Desk::new();
    for (seed, file) in [(4, "a.json"), (4, "b.json"), (5, "c.json")] {
        assert_eq!(desk.run(&format!("plan sphere --seed {seed} -o {file}")).code, 0);
    }
    let [a, b, c] = ["a.json", "b.json", "c.json"].map(|file| without_times(&desk.read(file)));
    assert!(a == b, "the same seed must give the same plan");
    assert!(a["segments"] != c["segments"], "another seed must give another plan");
}

#[test]
fn the_report_has_every_key_that_scripts_rely_on() {
    let report = Desk::new().run("plan sphere --json").json();
    let keys = [
        "status",
        "verified",
        "seed",
        "time_s",
        "generated_nodes",
        "graph_nodes",
        "components",
        "transfers",
        "regrasps",
        "certificate",
        "rejections",
        "plugins",
    ];
    for key in keys {
        assert!(report.get(key).is_some_and(|value| !value.is_null()), "`{key}` is missing");
    }
    assert_eq!(report["plugins"]["sampler"]["id"], "sampler/rlg");
    assert!(report["certificate"]["closure_margin"]["value"].as_f64().unwrap() > 0.0);
}

#[test]
fn a_plan_stands_alone_and_an_edited_one_is_caught() {
    let desk = Desk::new();
    desk.write("mine.toml", built_in("sphere", &[("mass = 0.1", "mass = 0.2")]));
    assert_eq!(desk.run("plan mine.toml --seed 3 -o plan.json").code, 0);
    std::fs::remove_file(desk.path("mine.toml")).expect("the file was written");
    let verdict = desk.run("verify plan.json --json");
    assert_eq!((verdict.code, &verdict.json()["valid"]), (0, &true.into()), "{}", verdict.err);
    for check in verdict.json()["checks"].as_array().expect("a list of checks") {
        for key in ["name", "worst", "limit", "where", "ok"] {
            assert!(check.get(key).is_some(), "`{key}` is missing in {check}");
        }
        assert_eq!(check["ok"], true, "{check}");
    }
    let mut plan: Value = serde_json::from_str(&desk.read("plan.json")).expect("a plan file is JSON");
    let joint = &mut plan["segments"][0]["states"][3]["joints"][1][2];
    *joint = (joint.as_f64().expect("a number") + 0.01).into();
    desk.write("edited.json", plan.to_string());
    let said = desk.run("verify edited.json --json");
    said.assert_fails(4, &["does not verify"]);
    assert_eq!(said.json()["valid"], false);
}

#[test]
fn unreachable_goals_end_with_the_reasons_and_an_advice() {
    const OLD: &str = "{ \"format\": \"regrasp-plan\", \"old\": true }";
    let desk = Desk::new();
    desk.write("plan.json", OLD);
    let goal = "pose = { position = [0.0, 0.0, 0.085], axis";
    desk.write("mine.toml", built_in("sphere", &[(goal, "pose = { position = [0.3, 0.0, 0.3], axis")]));
    let said = desk.run("plan mine.toml --max-nodes 50 -o plan.json");
    said.assert_fails(3, &["no plan", "goal 1", "to try", "rejections by cause", "sampler"]);
    let said = desk.run("plan mine.toml --max-nodes 50 --json");
    said.assert_fails(3, &[]);
    let report = said.json();
    assert_eq!((&report["status"], &report["verified"]), (&"no-plan".into(), &false.into()));
    assert!(report["rejections"]["sampler"].as_object().is_some_and(|causes| !causes.is_empty()));
    assert_eq!((desk.read("plan.json").as_str(), desk.files().len()), (OLD, 2));
}

#[test]
fn goals_that_were_reached_before_the_search_ended_are_kept_beside_the_wished_file() {
    let desk = Desk::new();
    let more = "\n[[goal]]\npose = { position = [0.3, 0.0, 0.3] }\n";
    desk.write("mine.toml", built_in("sphere", &[]) + more);
    let said = desk.run("plan mine.toml --max-nodes 50 -o plan.json");
    said.assert_fails(3, &["no plan", "goal 2"]);
    assert_eq!(desk.files(), ["mine.toml", "plan.partial.json"]);
    // What it does is sound; that it does not reach every goal is what the verifier says.
    let verdict = desk.run("verify plan.partial.json --json");
    let checks = verdict.json();
    let failed = checks["checks"].as_array().expect("checks").iter().filter(|check| check["ok"] == false);
    assert_eq!(
        (verdict.code, failed.map(|check| &check["name"]).collect::<Vec<_>>()),
        (4, vec![&Value::from("complete")])
    );
}
