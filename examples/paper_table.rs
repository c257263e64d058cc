//! The paper's Table 1 beside ours: each example solved with 100 seeds and every plan verified.
//!
//! `cargo run --release --example paper_table [SEEDS [SCENARIO…]]`
//!
//! The paper: A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous manipulation planning", SSD 2007, averages on an
//! Athlon64 3500+. It gives no dimensions, so that the problems are alike, not the same.

use regrasp::host::Registry;
use regrasp::planner::{Clock, Silent, Status};
use regrasp::study::scenario::{self, PaperFigures};
use regrasp::study::{NeverStops, Run, RunOptions, Setup};
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

/// One run in numbers: milliseconds, nodes generated, nodes of the graph, regrasps.
type Figures = [f64; 4];

fn figures(run: &Run) -> Figures {
    let statistics = &run.outcome.statistics;
    let counts = [statistics.generated_nodes, statistics.graph_nodes, statistics.regrasps];
    let [generated, graph, regrasps] = counts.map(|count| count as f64);
    [run.planning_s * 1e3, generated, graph, regrasps]
}

/// The value that a fraction `s` of the sorted values do not exceed.
fn quantile(values: impl Iterator<Item = f64>, s: f64) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    values.get((s * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

fn row(name: &str, seeds: u64, registry: &Registry) -> Result<String, Box<dyn Error>> {
    let scenario = scenario::load(name, registry)?;
    let setup = Setup::new(&scenario, &scenario.choices, registry)?;
    let clock = Watch(Instant::now());
    let (mut solved, mut verified, mut all) = (0, 0, Vec::<Figures>::new());
    for seed in 0..seeds {
        let options = RunOptions { seed, threads: 1, stop: &NeverStops, clock: &clock, progress: &Silent };
        let run = setup.run(&options)?;
        solved += u64::from(run.outcome.status == Status::Solved);
        verified += u64::from(run.outcome.status == Status::Solved && run.is_verified());
        all.push(figures(&run));
    }
    let of = |column: usize, s: f64| quantile(all.iter().map(|figures| figures[column]), s);
    let paper = scenario.paper.as_ref().map_or(
        "     -      -      -".into(),
        |PaperFigures { time_s, generated_nodes, graph_nodes, .. }| {
            format!("{:>6} {generated_nodes:>6} {graph_nodes:>6}", format!("{time_s} s"))
        },
    );
    Ok(format!(
        "{name:<15} {paper}  | {solved:>6} {verified:>8} {:>8.1} {:>8.1} {:>8.1} {:>9} {:>5} {:>8}",
        of(0, 0.5),
        of(0, 0.9),
        of(0, 1.0),
        of(1, 0.5),
        of(2, 0.5),
        of(3, 0.5)
    ))
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let seeds = words.next().map_or(Ok(100), |word| word.parse())?;
    let mut names: Vec<String> = words.collect();
    if names.is_empty() {
        names = EXAMPLES.map(str::to_owned).to_vec();
    }
    let registry = Registry::linked()?;
    println!(
        "                the paper (averages)  | ours over {seeds} seeds: one thread, medians, planning alone in ms"
    );
    println!(
        "                  time genrtd  graph  | solved verified   median      90%  slowest generated graph regrasps"
    );
    for name in names {
        println!("{}", row(&name, seeds, &registry)?);
    }
    Ok(())
}
