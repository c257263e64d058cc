//! `[hold]` from outside: what contradicts it, and that plans keep what it asks for.

use crate::desk::{Desk, built_in};
use serde_json::Value;

const START: &str = "[start]\npose = { position = [0.0, 0.0, 0.085] }";

/// `sphere` with this `[hold]`.
fn sphere(hold: &str) -> String {
    built_in("sphere", &[(START, &format!("{hold}\n\n{START}"))])
}

fn refused(hold: &str, parts: &[&str]) {
    let desk = Desk::new();
    desk.write("mine.toml", sphere(hold));
    desk.run("plan mine.toml").assert_fails(2, parts);
}

#[test]
fn what_contradicts_itself_is_refused() {
    refused("[hold]\nfriction_factor = 2.0", &["`hold.friction_factor` = 2", "0.05..=1", "most"]);
    refused("[hold]\nweight = false", &["`hold.weight`", "nothing to be held"]);
    refused("[hold]\nmax_normal_force = 0.02", &["`hold.max_normal_force` = 0.02 N cannot carry"]);
    refused(
        "[hold]\n\n[limits.resolution]\nfriction_margin = 0.7",
        &["`limits.resolution.friction_margin` and `[hold]` both", "leave one out"],
    );
    refused(
        "[hold]\ndisturbance = [0.1, 0.0]\n\n[plugins.stability-test]\nuse = \"force-closure\"",
        &["`hold.disturbance`", "cannot do what it asks for", "holding"],
    );
    refused("[hold]\nfriction_factr = 0.6", &["did you mean `friction_factor`?"]);
}

#[test]
fn a_plan_holds_what_was_asked_for() {
    let desk = Desk::new();
    desk.write("mine.toml", sphere("[hold]\nfriction_factor = 0.6\ndisturbance = [0.1, 0.001]"));
    let said = desk.run("plan mine.toml --seed 1 -o plan.json");
    assert_eq!(said.code, 0, "{}", said.err);
    let plan: Value = serde_json::from_str(&desk.read("plan.json")).expect("it is JSON");
    let holds = &plan["certificate"]["holds"];
    let friction = holds["friction"]["value"].as_f64().expect("a figure");
    assert!(friction <= 0.6 * 0.8 + 1e-9, "{friction}");
    assert!(holds["mass"]["value"].as_f64() > Some(0.1) && holds["effort"]["value"].as_f64() <= Some(1.0));
    assert!(plan["segments"][0]["states"][0]["forces"].is_array());
    assert!(said.out.contains("holds "), "{}", said.out);
    // A force that is not the plan's own is no force that balances.
    let mut forged = plan.clone();
    let forces = forged["segments"][0]["states"][0]["forces"].as_array_mut().expect("one a finger");
    forces.iter_mut().find(|force| force.is_array()).expect("some finger holds")[2] = 9.0.into();
    desk.write("forged.json", forged.to_string());
    desk.run("verify forged.json").assert_fails(4, &["forces"]);
}

#[test]
fn as_little_friction_as_can_be_is_less_than_what_a_number_asks_for() {
    let desk = Desk::new();
    desk.write("mine.toml", sphere("[hold]\nfriction_factor = \"most\""));
    let said = desk.run("plan mine.toml --seed 1 -o plan.json");
    assert_eq!(said.code, 0, "{}", said.err);
    let plan: Value = serde_json::from_str(&desk.read("plan.json")).expect("it is JSON");
    let factor = plan["scenario"]["problem"]["hold"]["friction_factor"]
        .as_f64()
        .expect("the one that was planned with");
    assert!((0.5..0.8).contains(&factor), "{factor}");
    assert_eq!(plan["claims"]["criterion"]["holding"]["friction_factor"].as_f64(), Some(factor));
}
