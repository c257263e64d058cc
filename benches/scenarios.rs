//! Whole planning runs: every built-in scenario, one thread, planning alone, a different seed each time.

use criterion::{Criterion, criterion_group, criterion_main};
use regrasp::Stopwatch;
use regrasp::planner::Status;
use regrasp::run::Setup;
use regrasp::run::scenario::SCENARIOS;
use std::hint::black_box;
use std::time::Duration;

/// The seeds that the runs go through, again and again.
const SEEDS: u64 = 20;

/// Seconds of planning; the verification that follows is not counted.
fn planning(setup: &Setup<'_>, seed: u64) -> f64 {
    let run = setup.run(&Stopwatch::start().options(seed)).expect("the built-in scenarios are sound");
    assert_eq!(run.outcome.status, Status::Solved);
    black_box(run.planning_s)
}

fn scenarios(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("plan");
    group.sample_size(20).measurement_time(Duration::from_secs(4));
    for file in SCENARIOS {
        let scenario = regrasp::load(file.name).expect("the built-in scenarios are sound");
        let setup = regrasp::setup(&scenario).expect("the built-in scenarios are sound");
        let mut seeds = (0..SEEDS).cycle();
        group.bench_function(file.name, |bencher| {
            bencher.iter_custom(|runs| {
                let seconds: f64 =
                    (0..runs).filter_map(|_| seeds.next()).map(|seed| planning(&setup, seed)).sum();
                Duration::from_secs_f64(seconds)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, scenarios);
criterion_main!(benches);
