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
    refused("[hold]\ndrag = 1.5", &["drag", "1.5", "0..=1"]);
    refused("[hold]\nfriction_factr = 0.6", &["did you mean `friction_factor`?"]);
    refused(
        "[hold]\n\n[plugins.stability-test]\nuse = \"holding\"\ndisturbance_force = 0.2",
        &["`plugins.stability-test.disturbance_force` and `hold.disturbance` both", "leave the former out"],
    );
}

#[test]
fn a_test_chosen_on_the_command_line_must_do_what_is_asked_for() {
    let desk = Desk::new();
    desk.write("mine.toml", sphere("[hold]\ndisturbance = [0.1, 0.0]"));
    desk.run("plan mine.toml --use stability-test=equilibrium").assert_fails(
        2,
        &["`hold.disturbance`: `stability-test/equilibrium` cannot do what it asks for", "holding"],
    );
}

#[test]
fn efforts_that_a_hand_does_not_give_are_asked_for() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/hands/four-finger.toml");
    let hand = std::fs::read_to_string(folder).expect("a built-in hand");
    let first = hand.find("effort = ").expect("its joints have efforts");
    let silent = hand[first..].replacen("effort = ", "# effort = ", 1);
    let desk = Desk::new();
    desk.write("hand.toml", format!("{}{silent}", &hand[..first]));
    let with_hand = |text: String| text.replace("builtin = \"four-finger\"", "file = \"hand.toml\"");
    desk.write("mine.toml", with_hand(sphere("[hold]")));
    let said = desk.run("plan mine.toml");
    said.assert_fails(2, &["finger[0].joint[0].effort", "write its `effort` (N·m)", "--effort"]);
    // Without `[hold]` nobody relies on efforts.
    desk.write("mine.toml", with_hand(sphere("")));
    assert_eq!(desk.run("plan mine.toml --seed 1").code, 0);
}

#[test]
fn an_object_too_heavy_for_every_grasp_is_said_before_the_search_with_what_they_carry() {
    let desk = Desk::new();
    let heavy = |mass: f64| sphere("[hold]").replace("mass = 0.1", &format!("mass = {mass}"));
    desk.write("mine.toml", heavy(80.0));
    let said = desk.run("plan mine.toml --seed 1");
    said.assert_fails(2, &["`object.mass` = 80", "the largest mass found is", "key `object.mass`"]);
    let (_, rest) = said.err.split_once("the largest mass found is ").expect("just seen");
    let most: f64 = rest.split_whitespace().next().and_then(|word| word.parse().ok()).expect("a number");
    assert!((0.2..20.0).contains(&most), "{most}");
    // A little less than that is a matter for the search.
    desk.write("mine.toml", heavy(0.9 * most));
    let said = desk.run("plan mine.toml --seed 1 --max-nodes 1");
    assert!(!said.err.contains("the largest mass found"), "{}", said.err);
}

#[cfg(feature = "rapier")]
#[test]
fn replays_use_the_forces_of_the_plan_and_hold_arrivals_against_its_promises() {
    let desk = Desk::new();
    desk.write("mine.toml", sphere("[hold]\nfriction_factor = 0.6"));
    assert_eq!(desk.run("plan mine.toml --seed 1 -o plan.json").code, 0);
    let own = desk.run("replay plan.json --json").json();
    assert_eq!(
        (own["arrived"].as_bool(), own["assumed"]["forces_of_plan"].as_bool()),
        (Some(true), Some(true))
    );
    let chosen = desk.run("replay plan.json --json --grip 3").json();
    assert_eq!(chosen["assumed"]["forces_of_plan"], false);
    let plan: Value = serde_json::from_str(&desk.read("plan.json")).expect("it is JSON");
    // Fingers that pull drop it.
    let mut weak = plan.clone();
    for state in weak["segments"].as_array_mut().expect("segments").iter_mut().flat_map(states) {
        let forces = state["forces"].as_array_mut().expect("forces").iter_mut();
        for x in forces.filter_map(Value::as_array_mut).flatten() {
            *x = (-x.as_f64().expect("a number")).into();
        }
    }
    desk.write("weak.json", weak.to_string());
    desk.run("replay weak.json").assert_fails(4, &["does not arrive"]);
    // A promise that is true, and one that is not.
    let said = desk.run("replay plan.json --sweep --json");
    let told = said.json();
    let worlds = told["worlds"].as_array().expect("worlds");
    assert_eq!((said.code, told["broken"].as_u64(), worlds.len()), (0, Some(0), 32));
    let promised = worlds.iter().filter(|world| world["promised"] == true).count();
    assert!((4..32).contains(&promised), "{promised}");
    let mut boast = plan;
    boast["certificate"]["holds"]["mass"]["value"] = 1e3.into();
    boast["certificate"]["holds"]["friction"]["value"] = 0.01.into();
    boast["scenario"]["problem"]["object"]["mass"] = 4.0.into();
    desk.write("boast.json", boast.to_string());
    desk.run("replay boast.json --sweep").assert_fails(4, &["break what the plan promises"]);
}

#[cfg(feature = "rapier")]
fn states(segment: &mut Value) -> &mut Vec<Value> {
    segment["states"].as_array_mut().expect("states")
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

/// Soft fingers drag while they spin, and plans of them must hold that; the verifier holds them to it.
#[test]
fn what_spinning_soft_fingers_drag_is_held() {
    let desk = Desk::new();
    let said = desk.run("plan three-finger-soft --seed 1 -o soft.json");
    assert_eq!(said.code, 0, "{}", said.err);
    let plan: Value = serde_json::from_str(&desk.read("soft.json")).expect("it is JSON");
    assert_eq!(plan["claims"]["criterion"]["holding"]["drag"].as_f64(), Some(1.0));
    let mut free = plan.clone();
    free["claims"]["criterion"]["holding"]["drag"] = 0.0.into();
    desk.write("free.json", free.to_string());
    let said = desk.run("verify free.json");
    said.assert_fails(4, &["claims"]);
    assert!(said.out.contains("less is claimed to be held"), "{}", said.out);
    // More drag than three contacts can balance at their lever: 0.2 m of torsional radius on a ball of 33 mm.
    let mut rough = plan;
    rough["claims"]["contact"]["cone"]["gamma"] = 0.2.into();
    rough["scenario"]["plugins"]["contact-model"]["settings"]["gamma"] = 0.2.into();
    desk.write("rough.json", rough.to_string());
    desk.run("verify rough.json").assert_fails(4, &["stability"]);
}

#[test]
fn points_do_not_drag() {
    let desk = Desk::new();
    desk.write("mine.toml", sphere("[hold]\nfriction_factor = 0.6"));
    let said = desk.run("plan mine.toml --seed 1 -o plan.json");
    assert_eq!(said.code, 0, "{}", said.err);
    let plan: Value = serde_json::from_str(&desk.read("plan.json")).expect("it is JSON");
    let held = plan["claims"]["criterion"]["holding"].as_object().expect("what is held is claimed");
    assert!(!held.contains_key("drag"), "no claim says so: {held:?}");
}
