//! Swaps plugins: the same problem and seed, planned by other components.
//!
//! `cargo run --example 06_swap_a_plugin`
//!
//! A scenario's `choices` say which plugin fills each slot, with which settings. `regrasp plugins` lists what
//! there is.

use regrasp::api::Slot;
use regrasp::host::Choices;
use regrasp::run::RunError;
use std::error::Error;

/// What is tried: a name, and what it changes.
type Swap = (&'static str, fn(&mut Choices));

const SWAPS: [Swap; 6] = [
    ("the paper's choice", |_| {}),
    ("conic program decides stability", |choices| choices.use_plugin(Slot::StabilityTest, "socp")),
    ("samples by projection", |choices| choices.use_plugin(Slot::Sampler, "projection")),
    ("checks edges only when used", |choices| choices.use_plugin(Slot::GraphStrategy, "lazy")),
    ("lift, slide, touch", |choices| choices.use_plugin(Slot::RegraspPlanner, "lift-slide-touch")),
    ("linearised cones of 6 edges", |choices| {
        choices.use_plugin(Slot::StabilityTest, "linearised");
        choices.set(Slot::StabilityTest, "edges", 6.into());
    }),
];

fn main() -> Result<(), Box<dyn Error>> {
    println!("{:<34} verified  regrasps  motion (s)", "sphere, seed 3");
    for (name, change) in SWAPS {
        let mut scenario = regrasp::load("sphere")?;
        change(&mut scenario.choices);
        let run = regrasp::solve(&scenario, 3)?;
        let motion = &run.outcome.motion.segments;
        let seconds = motion.last().and_then(|segment| segment.times.last()).copied().unwrap_or_default();
        println!(
            "{name:<34} {:>8} {:>9} {seconds:>11.1}",
            run.is_verified(),
            run.outcome.statistics.regrasps
        );
        assert!(run.is_verified(), "whichever plugins made the plan, the verifier is the same");
    }

    // What does not exist, or does not fit, is refused before anything is planned, with what is meant.
    println!();
    for (id, key, value) in
        [("scop", "tolerance", 1e-9), ("linearised", "edges", 2.0), ("linearised", "edge", 8.0)]
    {
        let mut scenario = regrasp::load("sphere")?;
        scenario.choices.use_plugin(Slot::StabilityTest, id);
        scenario.choices.set(Slot::StabilityTest, key, value.into());
        let refused = regrasp::solve(&scenario, 3).err().ok_or("it is wrong")?;
        assert!(matches!(refused, RunError::Host(_)));
        println!("refused: {refused}");
    }
    Ok(())
}
