//! Presets, given pairs, restarts and the ends of a search, by the real binary.

use crate::desk::{Desk, built_in};
use serde_json::Value;

/// A plan file without the only thing in it that differs from run to run.
fn without_times(plan: &str) -> Value {
    let mut plan: Value = serde_json::from_str(plan).expect("a plan file is JSON");
    plan["statistics"].as_object_mut().expect("statistics").remove("time_s");
    plan
}

/// A scenario of the strict suite.
fn strict(name: &str) -> String {
    regrasp::run::scenario::find_scenario(name).expect("it is built in").text.to_owned()
}

#[test]
fn the_preset_plans_as_the_paper_does_and_says_what_it_sets() {
    let desk = Desk::new();
    desk.write("pair.toml", strict("sphere-given-1"));
    let said = desk.run("plan pair.toml --preset paper --seed 1 -o plan.json --json");
    assert_eq!(said.code, 0, "{}", said.err);
    for part in [
        "preset `paper` sets",
        "surface = steiner",
        "graph-strategy.drop_unconnected = true",
        "lines 10 to 13",
    ] {
        assert!(said.err.contains(part), "`{part}` is not in:\n{}", said.err);
    }
    let report = said.json();
    let roadmap = &report["roadmap"];
    let count = |key: &str| roadmap[key].as_u64().expect("a count");
    // q_init and q_goal are in the graph, and besides them what was kept: fewer nodes than were generated.
    assert_eq!(report["graph_nodes"].as_u64(), Some(2 + count("kept_nodes")));
    assert!(report["generated_nodes"].as_u64() > Some(count("kept_nodes")), "{report}");
    assert_eq!(report["plugins"]["graph-strategy"]["settings"]["policy"]["decomposition"], "halving");
}

#[test]
fn a_preset_in_the_file_is_the_same_and_the_command_line_overrides_it() {
    let desk = Desk::new();
    desk.write("option.toml", strict("sphere-given-1"));
    desk.write("key.toml", strict("sphere-given-1") + "\n[plugins]\npreset = \"paper\"\n");
    assert_eq!(desk.run("plan option.toml --preset paper -o option.json").code, 0);
    assert_eq!(desk.run("plan key.toml -o key.json").code, 0);
    assert_eq!(desk.run("plan key.toml --preset default -o default.json").code, 0);
    assert_eq!(desk.run("plan option.toml -o plain.json").code, 0);
    let [option, key, default, plain] =
        ["option.json", "key.json", "default.json", "plain.json"].map(|file| without_times(&desk.read(file)));
    assert!(option["segments"] == key["segments"] && option["statistics"] == key["statistics"]);
    assert!(default["segments"] == plain["segments"] && plain["segments"] != key["segments"]);
    let said = desk.run("plan sphere --preset papr");
    said.assert_fails(2, &["there is no preset `papr`", "did you mean `paper`"]);
    desk.write("bad.toml", strict("sphere-given-1") + "\n[plugins]\npreset = \"papr\"\n");
    desk.run("plan bad.toml").assert_fails(2, &["plugins.preset", "did you mean `paper`"]);
}

#[test]
fn the_starts_own_contacts_are_tried_at_the_goal() {
    // With so little friction no three of the four fingers hold the cube: no grasp that can be left is found,
    // and none is needed.
    let given = "friction = 0.05\n";
    let grasp = "grasp = [{ contact = [0.0225, 0.0, 0.0] }, { contact = [0.0, 0.0225, 0.0] }, \
                 { contact = [-0.0225, 0.0, 0.0] }, { contact = [0.0, -0.0225, 0.0] }]\n";
    let text = built_in("cubic", &[("friction = 0.8\n", given)]);
    let text = text.split("[start]").next().expect("a head");
    let pose = |z: f64| format!("pose = {{ position = [0.0, 0.0, {z}] }}\n");
    let desk = Desk::new();
    desk.write("lift.toml", format!("{text}[start]\n{}{grasp}[[goal]]\n{}", pose(0.085), pose(0.089)));
    let said = desk.run("plan lift.toml --json");
    assert_eq!(said.code, 0, "{}", said.err);
    assert_eq!((&said.json()["regrasps"], &said.json()["verified"]), (&0.into(), &true.into()));
}

#[test]
fn searches_that_are_begun_anew_are_determined_by_the_seed() {
    let desk = Desk::new();
    let set = "--set graph-strategy.policy.restart_samples=2 --set graph-strategy.first_try=false";
    let mut restarts = 0;
    for seed in 0..4 {
        for threads in [1, 2] {
            let command =
                format!("plan ellip-obst {set} --seed {seed} --threads {threads} -o {threads}.json");
            let said = desk.run(&command);
            assert_eq!(said.code, 0, "{}", said.err);
        }
        let [one, two] = ["1.json", "2.json"].map(|file| without_times(&desk.read(file)));
        assert!(one == two, "seed {seed}");
        restarts += one["statistics"]["roadmap"]["restarts"].as_u64().expect("a count");
    }
    assert!(restarts > 0, "rounds of two samples are too short for this problem");
}

#[test]
fn a_fingertip_that_leans_over_an_edge_is_given_as_a_plan_has_it() {
    let desk = Desk::new();
    let cube = built_in("cube-free", &[]);
    let goal = cube.find("[[goal]]").expect("a goal");
    // At half the cube's edge, and there over it by the fingertip's radius, halfway between both faces.
    let (edge, over) = (0.0225, 0.0225 + 0.01 * 0.5_f64.sqrt());
    let grasp = format!(
        "grasp = [\n  {{ contact = [{edge}, 0.0, {edge}], joints = [{over}, 0.0, {over}] }},\n  \
         {{ contact = [0.0, {edge}, 0.0], joints = [0.0325, 0.0, 0.0] }},\n  \
         {{ contact = [-{edge}, 0.0, -{edge}], joints = [{over}, 0.0, -{over}] }},\n  \
         {{ contact = [0.0, -{edge}, 0.0], joints = [0.0325, 0.0, 0.0] }},\n]\n\n"
    );
    let (before, after) = cube.split_at(goal);
    desk.write("leaning.toml", format!("{}\n{grasp}{after}", before.trim_end()));
    let said = desk.run("plan leaning.toml -o plan.json");
    assert_eq!(said.code, 0, "{}", said.err);
    let plan: Value = serde_json::from_str(&desk.read("plan.json")).expect("a plan file is JSON");
    let contact = &plan["segments"][0]["states"][0]["contacts"][0];
    for axis in [0, 2] {
        let normal = contact["normal_O"][axis].as_f64().expect("a number");
        assert!((normal - 0.5_f64.sqrt()).abs() < 1e-6, "{contact}");
    }
}

#[test]
fn a_search_that_fails_for_want_of_friction_says_how_much_would_do() {
    let desk = Desk::new();
    desk.write("ice.toml", built_in("sphere", &[("friction = 0.8", "friction = 0.06")]));
    let said = desk.run("plan ice.toml --max-nodes 4");
    said.assert_fails(
        3,
        &["nearly all grasps are not stable", "there is a plan, 0.06 is given", "`object.friction`"],
    );
    // Where the budget alone is short, friction is not to blame.
    let said = desk.run("plan ellip-obst --seed 1 --max-nodes 1");
    assert!(said.code == 0 || !said.err.contains("friction"), "{}", said.err);
}
