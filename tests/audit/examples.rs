//! The example plugins keep every law in a real problem.

use regrasp::api::Slot;
use regrasp::run::{Depth, NeverStops, RunOptions};
use regrasp::{Stopwatch, load, setup};
use regrasp_example_plugins as _;

#[test]
fn the_examples_keep_the_laws_in_a_real_problem() {
    for (slot, id) in [
        (Slot::ContactModel, "grained"),
        (Slot::Surface, "remembering"),
        (Slot::TransferPlanner, "guarded"),
        (Slot::RegraspPlanner, "roadmap"),
        (Slot::GraphStrategy, "bandit"),
        (Slot::GraphStrategy, "best-first"),
    ] {
        let mut scenario = load("sphere").unwrap();
        scenario.choices.use_plugin(slot, id);
        let watch = Stopwatch::start();
        let options = RunOptions { stop: &NeverStops, ..watch.options(1) };
        let (run, case) = setup(&scenario).unwrap().run_audited(&options, Depth::Full);
        assert!(case.is_none(), "{id}: {:?}", case.map(|case| case.breach));
        assert!(run.unwrap().is_verified(), "{id}");
    }
}
