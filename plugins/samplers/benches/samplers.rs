//! One sample of each sampler with the paper's parts: anywhere, and at a prescribed pose; four fingers,
//! sphere and cube.
//!
//! A call that finds nothing counts too; how many of a hundred do is part of the name.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use regrasp_api::*;
use regrasp_conformance::fixtures::{Bench, four_finger};
use regrasp_contact_models::Pcwf;
use regrasp_planner::Leavable;
use regrasp_samplers::*;
use regrasp_stability_tests::{ForceClosure, ForceClosureSettings};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};
use std::hint::black_box;

fn samplers() -> [(&'static str, Box<dyn ClosedChainSampler>); 3] {
    [
        ("rlg", Box::new(Rlg::new(Default::default()).expect("defaults are in range"))),
        ("projection", Box::new(ProjectionSampler::new(Default::default()).expect("defaults are in range"))),
        ("grasp-first", Box::new(GraspFirst::new(Default::default()).expect("defaults are in range"))),
    ]
}

fn samples(criterion: &mut Criterion) {
    let shapes = [
        ("sphere", ObjectShape::Sphere { radius: 0.03, facets: 1280 }),
        ("cube", ObjectShape::Cuboid { size: [0.045; 3] }),
    ];
    for (object, shape) in shapes {
        let bench = Bench::new(four_finger(), shape, Vec::new());
        let surface = Geodesic::new(&GeodesicSettings::default(), &bench.world.object.mesh, bench.radius())
            .expect("the surface takes every closed mesh");
        let stability = ForceClosure::new(ForceClosureSettings::default()).expect("defaults are in range");
        let task = Task {
            surface: &surface,
            stability: &stability,
            contact_model: &Pcwf,
            admissible: &Leavable,
            ..bench.task()
        };
        for (name, sampler) in samplers() {
            for (where_, request) in
                [("anywhere", PoseRequest::Anywhere), ("at a pose", PoseRequest::At(Bench::center()))]
            {
                let sample = |key: u64| {
                    let mut context = Context::new(Random::from_key(key, 0, 0, 0), &Uninterrupted);
                    sampler.sample(&task, request, FingerSet::first(4), &mut context)
                };
                let found = (0..100).filter(|&key| matches!(sample(key), Ok(Some(_)))).count();
                let mut key = 0;
                criterion.bench_function(&format!("{name} {object} {where_} ({found} % found)"), |bencher| {
                    bencher.iter(|| {
                        key += 1;
                        black_box(sample(key))
                    });
                });
            }
        }
    }
}

criterion_group!(benches, samples);
criterion_main!(benches);
