//! Cost of one stability question: exact force closure cold and warm, which fingers may be lifted, cones of
//! edges, the wrench ball, equilibrium, the conic reference.
//!
//! Each figure is the mean over a fixed set of grasps of a size of a few centimetres, about half of them
//! closed.

use criterion::{Criterion, criterion_group, criterion_main};
use regrasp_api::{
    Cone, Context, FingerIndex, Grasp, GraspContact, Hint, Random, StabilityTest, Uninterrupted, Vec3,
};
use regrasp_stability_tests::{
    Equilibrium, EquilibriumSettings, ForceClosure, ForceClosureSettings, Linearised, LinearisedSettings,
    Socp, SocpSettings, WrenchBall, WrenchBallSettings,
};
use std::hint::black_box;

const SET: usize = 512;

/// Contacts on an ellipsoid, as a planner meets them.
fn grasp(random: &mut Random, count: u8, mu: f64, gamma: f64) -> Grasp<'static> {
    let semi_axes = Vec3::new(0.04, 0.025, 0.03);
    let mut grasp = Grasp::new(Vec3::zeros());
    for finger in (0..count).map(FingerIndex) {
        let u = random.direction();
        let n_O = u.component_div(&semi_axes).normalize();
        let cone = Cone::Elliptic { mu, gamma };
        grasp.push(GraspContact { finger, p_OC: u.component_mul(&semi_axes), n_O, cone });
    }
    grasp
}

fn grasps(count: u8, mu: f64, gamma: f64) -> Vec<Grasp<'static>> {
    let mut random = Random::from_key(1, u64::from(count), 0, 0);
    (0..SET).map(|_| grasp(&mut random, count, mu, gamma)).collect()
}

/// A grasp whose contacts drift by about a millimetre from each state to the next, as along a transfer.
fn drifting(count: u8, mu: f64) -> Vec<Grasp<'static>> {
    let mut random = Random::from_key(2, u64::from(count), 0, 0);
    let mut all = Vec::with_capacity(SET);
    while all.len() < SET {
        let start = grasp(&mut random, count, mu, 0.0);
        for step in 0..32 {
            let mut moved = Grasp::new(Vec3::zeros());
            for (i, contact) in start.contacts().iter().enumerate() {
                let drift = Vec3::new(0.001, -0.0007, 0.0005) * f64::from(step) * (i as f64 - 1.5) * 0.5;
                let p_OC = contact.p_OC + drift;
                let n_O = (contact.n_O + drift * 10.0).normalize();
                moved.push(GraspContact { p_OC, n_O, ..contact.clone() });
            }
            all.push(moved);
        }
    }
    all
}

fn context() -> Context<'static> {
    Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted)
}

/// One test a turn, through the set round and round; `warm` keeps the hint.
fn verdicts(c: &mut Criterion, name: &str, test: &dyn StabilityTest, set: &[Grasp<'_>], warm: bool) {
    let (mut context, mut hint, mut next) = (context(), Hint::default(), 0);
    let closed = set.iter().filter(|grasp| {
        test.test(grasp, &mut Hint::default(), &mut context).is_ok_and(regrasp_api::Stability::is_stable)
    });
    let share = 100 * closed.count() / set.len();
    c.bench_function(&format!("{name} ({share} % closed)"), |bencher| {
        bencher.iter(|| {
            next = (next + 1) % set.len();
            if !warm {
                hint = Hint::default();
            }
            test.test(black_box(&set[next]), &mut hint, &mut context)
        });
    });
}

fn force_closure(c: &mut Criterion) {
    let test = ForceClosure::new(ForceClosureSettings::default()).expect("defaults are in range");
    verdicts(c, "3 PCWF", &test, &grasps(3, 0.8, 0.0), false);
    verdicts(c, "4 PCWF cold", &test, &grasps(4, 0.8, 0.0), false);
    verdicts(c, "6 PCWF cold", &test, &grasps(6, 0.8, 0.0), false);
    verdicts(c, "2 soft fingers cold", &test, &grasps(2, 0.8, 0.002), false);
    verdicts(c, "4 soft fingers cold", &test, &grasps(4, 0.8, 0.002), false);
    verdicts(c, "8 frictionless cold", &test, &grasps(8, 0.0, 0.0), false);
    verdicts(c, "4 PCWF drifting, cold", &test, &drifting(4, 0.8), false);
    verdicts(c, "4 PCWF drifting, warm", &test, &drifting(4, 0.8), true);
    let four = grasps(4, 0.8, 0.0);
    let (mut context, mut next) = (context(), 0);
    c.bench_function("liftable, 4 PCWF", |bencher| {
        bencher.iter(|| {
            next = (next + 1) % SET;
            test.liftable(black_box(&four[next]), 0, &mut context)
        });
    });
    c.bench_function("assess, 4 PCWF", |bencher| {
        bencher.iter(|| {
            next = (next + 1) % SET;
            test.assess(black_box(&four[next]), None, None, &mut context)
        });
    });
}

fn linearised(c: &mut Criterion) {
    for edges in [4, 8, 16, 64] {
        let test = Linearised::new(LinearisedSettings { edges }).expect("in range");
        verdicts(c, &format!("linearised, {edges} edges, 4 PCWF"), &test, &grasps(4, 0.8, 0.0), false);
    }
    let test = Linearised::new(LinearisedSettings::default()).expect("defaults are in range");
    verdicts(c, "linearised, 8 edges, 4 soft fingers", &test, &grasps(4, 0.8, 0.002), false);
}

fn wrench_ball(c: &mut Criterion) {
    let four = grasps(4, 0.8, 0.0);
    for least_margin in [0.0, 0.01, 0.1, 0.3] {
        let settings = WrenchBallSettings { least_margin, ..WrenchBallSettings::default() };
        let test = WrenchBall::new(settings, Vec3::zeros()).expect("in range");
        verdicts(c, &format!("wrench-ball above {least_margin}, 4 PCWF"), &test, &four, false);
    }
    let test = WrenchBall::new(WrenchBallSettings::default(), Vec3::zeros()).expect("defaults are in range");
    let (mut context, mut next) = (context(), 0);
    c.bench_function("wrench-ball, assess, 4 PCWF", |bencher| {
        bencher.iter(|| {
            next = (next + 1) % SET;
            test.assess(black_box(&four[next]), None, None, &mut context)
        });
    });
}

/// Under gravity along some axis of the object.
fn equilibrium(c: &mut Criterion) {
    let test =
        Equilibrium::new(EquilibriumSettings::default(), 0.1, Vec3::zeros()).expect("defaults are in range");
    for count in [3, 4] {
        let mut set = grasps(count, 0.8, 0.0);
        set.iter_mut().for_each(|grasp| grasp.g_O = Vec3::new(0.0, 0.0, -9.81));
        verdicts(c, &format!("equilibrium, {count} PCWF"), &test, &set, false);
    }
}

fn reference(c: &mut Criterion) {
    let test = Socp::new(SocpSettings::default()).expect("defaults are in range");
    verdicts(c, "socp, 4 PCWF", &test, &grasps(4, 0.8, 0.0), false);
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(30).measurement_time(std::time::Duration::from_secs(1)).warm_up_time(std::time::Duration::from_millis(300));
    targets = force_closure, linearised, wrench_ball, equilibrium, reference
}
criterion_main!(benches);
