//! A transfer's step, a connection inside GS_n and a regrasp, four fingers and the sphere of the paper's
//! problem.
#![allow(missing_docs)]

#[path = "../tests/it/support/mod.rs"]
mod support;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use regrasp_api::*;
use regrasp_local_planners::{Linear, LinearSettings, Rolling, RollingSettings, Rrt, RrtSettings};
use std::hint::black_box;
use support::{Bench, context, geometry};

fn sphere() -> ObjectModel {
    support::object("{ kind = \"sphere\", radius = 0.03 }")
}

/// Elements are steps: criterion reports the time of one.
fn rolling(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("rolling");
    for (name, object) in [("sphere", sphere()), ("cube", support::cube()), ("ring", support::ring())] {
        let bench = Bench::new(support::four_finger(), object);
        let (settings, mesh) = (RollingSettings::default(), &bench.object.mesh);
        let rolling = Rolling::for_object(settings, &*bench.hand, mesh).unwrap();
        let mut random = Random::from_key(1, 0, 0, 0);
        let (from, to, steps) = (0..1000)
            .find_map(|_| {
                let from = support::grasp(&bench, &mut random);
                let to = support::nearby(&from.X_HO, &mut random, 0.0, 0.6);
                let mut path = Path::default();
                let target = Target::Transfer(&to);
                let reached =
                    rolling.connect(&bench.task(), &from, &target, Some(&mut path), &mut context(0));
                (reached.unwrap().is_complete() && path.states.len() > 20)
                    .then(|| (from, to, path.states.len() - 1))
            })
            .unwrap();
        group.throughput(Throughput::Elements(steps as u64));
        group.bench_function(name, |b| {
            let mut context = context(0);
            b.iter(|| {
                let target = Target::Transfer(&to);
                rolling.connect(&bench.task(), black_box(&from), &target, None, &mut context).unwrap()
            })
        });
    }
    group.finish();
}

fn linear(criterion: &mut Criterion) {
    let bench = Bench::new(support::four_finger(), sphere());
    let linear = Linear::new(LinearSettings::default()).unwrap();
    let mut random = Random::from_key(1, 0, 0, 0);
    let (from, to, steps) = (0..1000)
        .find_map(|_| {
            let from = support::grasp(&bench, &mut random);
            let X_HO = support::nearby(&from.X_HO, &mut random, 0.01, 0.5);
            let to = support::grasp_at(&bench.task(), X_HO, &mut random)?;
            let mut path = Path::default();
            let reached =
                linear.connect(&bench.task(), &from, &Target::Grasp(&to), Some(&mut path), &mut context(0));
            reached.unwrap().is_complete().then(|| (from, to, path.states.len() - 1))
        })
        .unwrap();
    let mut group = criterion.benchmark_group("linear");
    group.throughput(Throughput::Elements(steps as u64));
    group.bench_function("sphere", |b| {
        let mut context = context(0);
        b.iter(|| {
            linear.connect(&bench.task(), black_box(&from), &Target::Grasp(&to), None, &mut context).unwrap()
        })
    });
    group.finish();
}

fn regrasp(criterion: &mut Criterion) {
    let bench = Bench::new(support::four_finger(), sphere());
    let rrt = Rrt::new(RrtSettings::default(), &*bench.hand).unwrap();
    let (task, finger, mut random) = (bench.task(), FingerIndex(0), Random::from_key(1, 0, 0, 0));
    let (from, contact, joints, steps) = (0..10_000)
        .find_map(|_| {
            let from = support::grasp(&bench, &mut random);
            let contact = task.surface.sample(&mut random);
            let p_HF = geometry::to_hand(&from.X_HO, &contact.tip_center(bench.radius()));
            let joints = task.hand.inverse(finger, &p_HF, &from.joints[finger])?;
            let target = Target::Regrasp { finger, contact: Some(&contact), joints: &joints };
            let mut path = Path::default();
            let reached = rrt.connect(&task, &from, &target, Some(&mut path), &mut context(0)).unwrap();
            reached.is_complete().then(|| (from, contact, joints, path.states.len() - 1))
        })
        .unwrap();
    let mut group = criterion.benchmark_group("regrasp");
    group.throughput(Throughput::Elements(steps as u64));
    group.bench_function("sphere", |b| {
        let mut context = context(0);
        let target = Target::Regrasp { finger, contact: Some(&contact), joints: &joints };
        b.iter(|| rrt.connect(&task, black_box(&from), &target, None, &mut context).unwrap())
    });
    group.finish();
}

criterion_group!(benches, rolling, linear, regrasp);
criterion_main!(benches);
