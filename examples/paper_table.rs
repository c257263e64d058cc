//! The paper's Table 1 beside ours: each example solved with 100 seeds and every plan verified.
//!
//! `cargo run --release --example paper_table [SEEDS [SCENARIO…]]`; `regrasp compare --suite paper --seeds
//! 100 -o DIR` does the same for the paper's three, in parallel, and keeps the runs.
//!
//! The paper: A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous manipulation
//! planning", SSD 2007, averages on an Athlon64 3500+. It gives no dimensions, so that the problems are
//! alike, not the same.

use regrasp::Stopwatch;
use regrasp::run::scenario::Scenario;
use regrasp::study::compare::{PaperRow, RunName, RunRecord, paper_table};
use std::collections::BTreeMap;
use std::error::Error;

/// The paper's three examples, and four of their kind.
const EXAMPLES: [&str; 7] =
    ["sphere", "cubic", "ellip-obst", "sphere-tilt", "sphere-free", "cube-free", "ellipsoid-free"];

/// The runs of a scenario, a run a seed.
fn runs(scenario: &Scenario, seeds: u64) -> Result<Vec<RunRecord>, Box<dyn Error>> {
    let setup = regrasp::setup(scenario)?;
    let run = |seed| {
        let name = RunName { scenario: &scenario.name, variant: "base", seed };
        // The times of the single roles are not asked for here.
        let run = setup.run(&Stopwatch::start().options(seed))?;
        Ok(RunRecord::of_run(name, &run, scenario.hand.as_ref(), BTreeMap::new()))
    };
    (0..seeds).map(run).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let seeds = words.next().map_or(Ok(100), |word| word.parse())?;
    let mut names: Vec<String> = words.collect();
    if names.is_empty() {
        names = EXAMPLES.map(str::to_owned).to_vec();
    }
    let mut solved = Vec::new();
    for name in names {
        let scenario = regrasp::load(&name)?;
        let runs = runs(&scenario, seeds)?;
        solved.push((scenario, runs));
    }
    let rows = solved.iter().map(|(scenario, runs)| PaperRow {
        scenario: &scenario.name,
        paper: scenario.paper.as_ref(),
        runs: runs.iter().collect(),
    });
    print!("{}", paper_table(&rows.collect::<Vec<_>>()));
    Ok(())
}
