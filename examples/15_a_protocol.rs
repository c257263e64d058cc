//! Problems of a published paper, and what becomes of them here: a cube into its other 23 orientations.
//!
//! `cargo run --release --example 15_a_protocol`
//!
//! `regrasp suite dlr-cube -o DIR` does the same with all seeds, and writes files. Who replays plans is the
//! caller's choice: here nobody does, and the table says so.

use regrasp::Stopwatch;
use regrasp::host::Registry;
use regrasp::plan::Plan;
use regrasp::suite::{Options, Outcome, Problems, Trial, load, rows, run, scenarios};
use std::error::Error;
use std::ops::ControlFlow;

fn main() -> Result<(), Box<dyn Error>> {
    let registry = Registry::linked()?;
    let (mut protocol, files) = load("dlr-cube")?;
    println!("{}\n{}", protocol.title, protocol.paper);
    // One seed of each turn is enough to see how it goes.
    protocol.series[0].problems = Problems::CubeGroup { seeds: 1 };
    let scenarios = scenarios(&protocol, &files, &registry)?;

    let watch = Stopwatch::start();
    let told = |_: &Trial, _: &[Plan]| ControlFlow::Continue(());
    let options = Options { threads: 1, stop: &watch, clock: &watch, judge: None, told: &told };
    let trials = run(&protocol, &scenarios, &registry, Vec::new(), &options)?;

    let outcome = Outcome::of(&protocol.series[0], &trials.iter().collect::<Vec<_>>());
    println!("{} of {} orientations are reached by a plan that verifies", outcome.solved, outcome.plans);
    let share = outcome.share.ok_or("no plan was asked for")?;
    println!("95 % interval by Wilson: {:.0} to {:.0} %", 100.0 * share.low, 100.0 * share.high);
    for row in &rows(&protocol, std::slice::from_ref(&outcome))[1..] {
        println!("published: {} ({}); ours in simulation: {}", row[1], row[3], row[5]);
    }
    assert_eq!(outcome.plans, 23);
    assert!(outcome.solved >= 20, "{outcome:?}");
    Ok(())
}
