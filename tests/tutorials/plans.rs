//! Each tutorial's plugin plans the paper's first problem, and the verifier accepts the plan.

use crate::TUTORIALS;
use regrasp::host::{Choices, Registry, slot_by_name};
use regrasp::planner::{Clock, Silent};
use regrasp::run::{NeverStops, Run, RunOptions, Setup, scenario};

// ANCHOR: link
// A dependency alone registers nothing.
use concurrent_stability_test as _;
use fingers_first_sampler as _;
use greasy_contact_model as _;
use hop_local_planner as _;
use mend_graph_strategy as _;
use taut_surface as _;
// ANCHOR_END: link

struct NoClock;

impl Clock for NoClock {
    fn seconds(&self) -> f64 {
        0.0
    }
}

// ANCHOR: plan
/// Plans `sphere` with one plugin in the place of the default.
fn plan(slot: &str, id: &str) -> Run {
    let registry = Registry::linked().expect("no two plugins have one id");
    let scenario = scenario::load("sphere", &registry).expect("it is built in");
    let mut choices: Choices = scenario.choices.clone();
    choices.use_plugin(slot_by_name(slot).expect("a slot"), id);
    let setup = Setup::new(&scenario, &choices, &registry).expect("the plugin takes the sphere");
    let options = RunOptions { seed: 1, threads: 1, stop: &NeverStops, clock: &NoClock, progress: &Silent };
    setup.run(&options).expect("no plugin breaks the contract")
}
// ANCHOR_END: plan

#[test]
fn every_tutorials_plugin_plans_and_the_plan_verifies() {
    for (role, name, slot) in TUTORIALS {
        let run = plan(slot, name);
        assert!(run.is_verified(), "{role}/{name}: {:?}, {:?}", run.why_not_solved(), run.verdict);
        let plan = run.plan.expect("a verified run has a plan");
        let slot = slot_by_name(slot).expect("a slot");
        assert_eq!(plan.scenario.plugins[&slot].id, format!("{role}/{name}"));
    }
}

#[test]
fn the_program_itself_has_none_of_them() {
    let listed = crate::workshop::regrasp(&["plugins"]);
    for (role, name, _) in TUTORIALS {
        assert!(!listed.out.contains(&format!("{role}/{name}")), "{}", listed.out);
    }
}
