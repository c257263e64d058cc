//! The paper's Table 1 beside ours: each example solved with 100 seeds and every plan verified.
//!
//! `cargo run --release --example paper_table [SEEDS [SCENARIO…]]`; `regrasp compare --suite paper --seeds 100 -o DIR` does the same for the
//! paper's three, in parallel, and keeps the runs.
//!
//! The paper: A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous manipulation planning", SSD 2007, averages on an
//! Athlon64 3500+. It gives no dimensions, so that the problems are alike, not the same.

use regrasp::host::Registry;
use regrasp::planner::{Clock, Silent};
use regrasp::study::compare::{PaperRow, RunName, RunRecord, paper_table};
use regrasp::study::scenario::{self, Scenario};
use regrasp::study::{NeverStops, RunOptions, Setup};
use std::collections::BTreeMap;
use std::error::Error;
use std::time::Instant;

/// The paper's three examples, and four of their kind.
const EXAMPLES: [&str; 7] =
    ["sphere", "cubic", "ellip-obst", "sphere-tilt", "sphere-free", "cube-free", "ellipsoid-free"];

struct Watch(Instant);
impl Clock for Watch {
    fn seconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

/// The runs of a scenario, a run a seed.
fn runs(scenario: &Scenario, seeds: u64, registry: &Registry) -> Result<Vec<RunRecord>, Box<dyn Error>> {
    let setup = Setup::new(scenario, &scenario.choices, registry)?;
    let clock = Watch(Instant::now());
    let run = |seed| {
        let options = RunOptions { seed, threads: 1, stop: &NeverStops, clock: &clock, progress: &Silent };
        let name = RunName { scenario: &scenario.name, variant: "base", seed };
        // The times of the single roles are not asked for here.
        Ok(RunRecord::of_run(name, &setup.run(&options)?, scenario.hand.as_ref(), BTreeMap::new()))
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
    let registry = Registry::linked()?;
    let mut solved = Vec::new();
    for name in names {
        let scenario = scenario::load(&name, &registry)?;
        let runs = runs(&scenario, seeds, &registry)?;
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
