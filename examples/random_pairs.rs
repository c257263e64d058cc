//! Random starts and goals: a ball and a cube between 200 pairs of random orientations each, every plan
//! verified.
//!
//! `cargo run --release --example random_pairs [PAIRS [SCENARIO…]]`
//!
//! Start and goal keep the scenario's position; both orientations are uniform, and no grasp is given. A pair
//! counts as solved if planning takes at most two seconds. What is not solved is listed with the seed that
//! repeats it and the rejections that led there.

use regrasp::Stopwatch;
use regrasp::api::{Pose, PoseDescription, Random, Reason, Slot};
use regrasp::planner::Status;
use regrasp::run::Run;
use regrasp::run::scenario::Scenario;
use std::error::Error;
use std::time::Duration;

/// How long one pair may take.
const PATIENCE: Duration = Duration::from_secs(2);

/// One goal, and random orientations at start and goal.
fn turn(scenario: &mut Scenario, seed: u64) -> Result<(), Box<dyn Error>> {
    let mut random = Random::from_key(seed, 0, 0, 0);
    let position = scenario.problem.start.pose.pose()?.translation;
    let mut pose = || PoseDescription::from(&Pose::from_parts(position, random.rotation()));
    scenario.problem.start.pose = pose();
    scenario.problem.goal.truncate(1);
    scenario.problem.goal[0].pose = pose();
    Ok(())
}

/// Plans and verifies the pair with this number.
fn run(scenario: &mut Scenario, seed: u64) -> Result<Run, Box<dyn Error>> {
    turn(scenario, seed)?;
    let setup = regrasp::setup(scenario)?;
    Ok(setup.run(&Stopwatch::limited(PATIENCE).options(seed))?)
}

/// The most frequent rejections, most frequent first.
fn causes(run: &Run) -> String {
    let plugins = run.outcome.statistics.plugins.iter();
    let mut counts: Vec<(u64, Slot, Reason)> = plugins
        .flat_map(|(&slot, plugin)| plugin.rejections.iter().map(move |(&reason, &n)| (n, slot, reason)))
        .collect();
    counts.sort_by_key(|&(n, ..)| std::cmp::Reverse(n));
    let word = |(n, slot, reason): &(u64, Slot, Reason)| format!("{} {} {n}", slot.name(), reason.name());
    counts.iter().take(4).map(word).collect::<Vec<_>>().join(", ")
}

/// Plans every pair and prints one row.
fn row(name: &str, pairs: u64) -> Result<(), Box<dyn Error>> {
    let mut scenario = regrasp::load(name)?;
    let (mut times, mut wrong, mut failures) = (Vec::new(), 0, Vec::new());
    for seed in 0..pairs {
        let run = run(&mut scenario, seed)?;
        let solved = run.outcome.status == Status::Solved;
        wrong += u32::from(solved && !run.is_verified());
        match solved {
            true => times.push(run.planning_s * 1e3),
            false => failures.push(format!("  seed {seed}: {:?}; {}", run.outcome.stuck, causes(&run))),
        }
    }
    times.sort_by(f64::total_cmp);
    let of = |s: f64| times.get((s * (times.len().max(1) - 1) as f64).round() as usize).unwrap_or(&f64::NAN);
    let share = 100.0 * times.len() as f64 / pairs as f64;
    let [median, most, slowest] = [0.5, 0.9, 1.0].map(of);
    println!("{name:<15} {share:>7.1} % {wrong:>6} {median:>9.1} {most:>8.1} {slowest:>8.1}");
    failures.iter().for_each(|failure| println!("{failure}"));
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let pairs = words.next().map_or(Ok(200), |word| word.parse())?;
    let mut names: Vec<String> = words.collect();
    if names.is_empty() {
        names = ["sphere", "cubic"].map(str::to_owned).to_vec();
    }
    println!("{pairs} pairs        solved  wrong    median      90%  slowest   (ms of planning, one thread)");
    for name in names {
        row(&name, pairs)?;
    }
    Ok(())
}
