//! Compares two samplers, seed by seed: does `projection` plan faster than the random loop generator?
//!
//! `cargo run --release --example 09_compare_samplers`
//!
//! This is what `regrasp compare sphere --vary sampler=rlg,projection --seeds 15 -o study` does for whole
//! suites, in parallel, with reports. Both samplers get the same seeds, so that what is compared is pairs;
//! the interval says how sure the answer is.

use regrasp::Stopwatch;
use regrasp::api::Slot;
use regrasp::study::compare::statistics::{Paired, median_interval, wilson};
use std::error::Error;

const SEEDS: u64 = 15;

/// Seconds of planning for each seed; `None` where there was no plan, or one that the verifier refused.
fn times(sampler: &str) -> Result<Vec<Option<f64>>, Box<dyn Error>> {
    let mut scenario = regrasp::load("sphere")?;
    scenario.choices.use_plugin(Slot::Sampler, sampler);
    let setup = regrasp::setup(&scenario)?; // built once, run with every seed
    let time = |seed| {
        let run = setup.run(&Stopwatch::start().options(seed))?;
        Ok(run.is_verified().then_some(run.planning_s))
    };
    (0..SEEDS).map(time).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let (baseline, variant) = (times("rlg")?, times("projection")?);
    println!("sphere, {SEEDS} seeds    solved (95 %)          median planning time (95 %)");
    for (name, times) in [("rlg", &baseline), ("projection", &variant)] {
        let solved: Vec<f64> = times.iter().copied().flatten().collect();
        let share = wilson(solved.len(), times.len()).ok_or("there were runs")?;
        let time = median_interval(solved.iter().copied())
            .ok_or("something was solved")?
            .map(|seconds| seconds * 1e3);
        println!(
            "{name:<20} {:>4.0} % ({:.0} to {:.0})    {:>8.2} ms ({:.2} to {:.2})",
            share.value * 100.0,
            share.low * 100.0,
            share.high * 100.0,
            time.value,
            time.low,
            time.high
        );
        assert_eq!(solved.len(), times.len(), "every plan is found and verified");
    }

    let pairs: Vec<_> = baseline.into_iter().zip(variant).collect();
    let found = Paired::of(&pairs);
    let ratio = found.ratio.ok_or("both solved something")?;
    let word = match (ratio.low > 1.0, ratio.high < 1.0) {
        (true, _) => "slower",
        (_, true) => "faster",
        _ => "no difference could be shown",
    };
    println!(
        "\nprojection / rlg: {:.2} times the time ({:.2} to {:.2}), p = {:.4}: {word}",
        ratio.value, ratio.low, ratio.high, found.time_test.p_value
    );
    assert!(ratio.low <= ratio.value && ratio.value <= ratio.high);
    Ok(())
}
