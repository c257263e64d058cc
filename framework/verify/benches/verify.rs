//! How long a plan takes to verify: a plan made by hand of about 2,000 states.

use criterion::{Criterion, criterion_group, criterion_main};
use regrasp_verify::verify;

#[path = "../tests/it/common/mod.rs"]
mod common;

fn whole_plan(criterion: &mut Criterion) {
    let plan = common::plan(990);
    let states: usize = plan.segments.iter().map(|segment| segment.states.len()).sum();
    let mut group = criterion.benchmark_group("verify");
    group.sample_size(10);
    group.bench_function(format!("{states}_states"), |bencher| bencher.iter(|| verify(&plan)));
    group.finish();
}

criterion_group!(benches, whole_plan);
criterion_main!(benches);
