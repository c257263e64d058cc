//! The wrench ball against a dense reference, closed forms and its laws.

use crate::support;

use proptest::prelude::*;
use regrasp_api::{
    CallError, Context, Hint, Random, Rotation, Stability, StabilityTest, Uninterrupted, Vec3,
};
use regrasp_stability_tests::{WrenchBall, WrenchBallSettings};
use support::{
    Family, Touch, assess, center_and_length, check_certificate, depth_along, force_closure, grasp_of, moved,
    polyhedral, pyramids, random_touches, scaled_friction, touch, verdict, verdict_of, with_context,
    wrench_ball,
};

fn default_ball() -> WrenchBall {
    wrench_ball(WrenchBallSettings::default())
}

fn closed_grasp(random: &mut Random, family: Family) -> Vec<Touch> {
    loop {
        let touches = random_touches(random, 4, family);
        if verdict(&touches).is_stable() {
            return touches;
        }
    }
}

/// Q1 by a pattern search from many random directions: an upper bound, and near it.
fn dense(touches: &[Touch], random: &mut Random) -> f64 {
    let value = depth_along(touches);
    (0..24)
        .map(|_| descend(&value, std::array::from_fn(|_| random.normal()), random))
        .fold(f64::INFINITY, f64::min)
}

fn descend(value: &dyn Fn(&[f64; 6]) -> f64, mut w: [f64; 6], random: &mut Random) -> f64 {
    let (mut here, mut step) = (value(&w), 0.5);
    while step > 1e-6 {
        let before = here;
        for _ in 0..40 {
            let next: [f64; 6] = std::array::from_fn(|i| w[i] + step * random.normal());
            let there = value(&next);
            if there < here {
                (w, here) = (next, there);
            }
        }
        if here == before {
            step *= 0.5;
        }
    }
    here
}

#[test]
fn margins_are_within_a_percent_of_a_dense_reference() {
    let mut random = Random::from_key(41, 0, 0, 0);
    let mut close = 0;
    for i in 0..30 {
        let touches = closed_grasp(&mut random, [Family::Pcwf, Family::SoftFinger, Family::Mixed][i % 3]);
        let found = assess(&default_ball(), &touches);
        let dense = dense(&touches, &mut random);
        assert!(found.margin_lower <= dense * (1.0 + 1e-9), "{found:?} {dense}");
        assert!(found.margin_upper - found.margin_lower <= 0.0051 * found.margin_upper, "{found:?}");
        // The dense search stalls where supports meet: it may end above the direction that counts, never
        // undercut it.
        assert!(found.margin_upper <= dense * 1.006, "{found:?} {dense}");
        close += usize::from(dense <= found.margin_upper * 1.01);
    }
    assert!(close >= 12, "the dense search comes within a percent in {close} of 30");
}

/// The smallest distance of a hyperplane through six of the points that has all others on one side: Q1 by
/// enumeration.
fn enumerated(points: &[nalgebra::Vector6<f64>]) -> f64 {
    let (mut depth, mut chosen) = (f64::INFINITY, [0, 1, 2, 3, 4, 5]);
    loop {
        let rows = nalgebra::Matrix6::from_fn(|i, j| points[chosen[i]][j]);
        // n·p = 1 on all six; a hyperplane through the origin itself would mean depth 0.
        if let Some(n) = rows.lu().solve(&nalgebra::Vector6::repeat(1.0))
            && points.iter().all(|p| n.dot(p) <= 1.0 + 1e-9)
        {
            depth = depth.min(1.0 / n.norm());
        }
        let Some(k) = (0..6).rev().find(|&k| chosen[k] < points.len() - 6 + k) else { return depth };
        chosen[k] += 1;
        (k + 1..6).for_each(|l| chosen[l] = chosen[l - 1] + 1);
    }
}

#[test]
fn polyhedral_margins_are_those_of_the_hulls_facets() {
    let mut random = Random::from_key(48, 0, 0, 0);
    let mut compared = 0;
    while compared < 25 {
        let touches = closed_grasp(&mut random, Family::Pcwf);
        let edges: Vec<Vec<regrasp_api::ConeEdge>> = (0..4).map(|_| odd_edges(&mut random)).collect();
        let grasp = polyhedral(&touches, &edges);
        let found = with_context(|c| default_ball().assess(&grasp, None, None, c));
        if !found.stability.is_stable() {
            continue;
        }
        let exact = enumerated(&wrenches(&touches, &edges));
        assert!(found.margin_lower <= exact * (1.0 + 1e-6), "{found:?} {exact}");
        assert!(exact <= found.margin_upper * (1.0 + 1e-6), "{found:?} {exact}");
        assert!(found.margin_upper <= exact * 1.006, "{found:?} {exact}");
        compared += 1;
    }
}

fn odd_edges(random: &mut Random) -> Vec<regrasp_api::ConeEdge> {
    let turn = random.range(0.0, 6.0);
    let edge = |k: usize, random: &mut Random| {
        let (sin, cos) = (turn + std::f64::consts::TAU * k as f64 / 4.0).sin_cos();
        let size = random.range(0.7, 1.3);
        regrasp_api::ConeEdge { tangential: [size * cos, size * sin], torsion: 0.0 }
    };
    (0..4).map(|k| edge(k, random)).collect()
}

/// Every edge's wrench about the centroid, torques over the length.
fn wrenches(touches: &[Touch], edges: &[Vec<regrasp_api::ConeEdge>]) -> Vec<nalgebra::Vector6<f64>> {
    let (center, length) = center_and_length(touches);
    let mut all = Vec::new();
    for (touch, edges) in touches.iter().zip(edges) {
        let t1 = regrasp_api::any_orthogonal(&-touch.n);
        let t2 = (-touch.n).cross(&t1);
        for edge in edges {
            let f = -touch.n + t1 * edge.tangential[0] + t2 * edge.tangential[1];
            let m = ((touch.p - center) / length).cross(&f);
            all.push(nalgebra::Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z));
        }
    }
    all
}

#[test]
fn margins_agree_with_those_of_force_closure() {
    let mut random = Random::from_key(42, 0, 0, 0);
    for _ in 0..20 {
        let touches = closed_grasp(&mut random, Family::Pcwf);
        let (ours, exact) = (assess(&default_ball(), &touches), assess(&force_closure(), &touches));
        assert!(ours.margin_lower <= exact.margin_upper * (1.0 + 1e-6), "{ours:?} {exact:?}");
        assert!(exact.margin_upper <= ours.margin_upper * 1.006, "{ours:?} {exact:?}");
        check_certificate(&touches, &ours);
    }
}

#[test]
fn two_antipodal_soft_fingers_are_as_deep_as_theory_says() {
    for (mu, gamma) in [(0.5, 0.2), (0.5, 0.7), (0.3, 0.1)] {
        let pair = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]].map(|p| Touch { gamma, ..touch(p, p, mu) });
        let least = gamma.min(mu / f64::sqrt(2.0 + mu * mu));
        let found = assess(&default_ball(), &pair);
        assert!(
            found.margin_lower <= least && least <= found.margin_upper * (1.0 + 1e-9),
            "{found:?} {least}"
        );
        for (factor, stable) in [(0.99, true), (1.01, false)] {
            let settings = WrenchBallSettings { least_margin: factor * least, ..Default::default() };
            assert_eq!(verdict_of(&wrench_ball(settings), &grasp_of(&pair)).is_stable(), stable);
        }
    }
}

#[test]
fn the_bound_decides_as_the_reported_margin_does() {
    let mut random = Random::from_key(43, 0, 0, 0);
    let mut undecided = 0;
    for i in 0..30 {
        let touches = closed_grasp(&mut random, [Family::Pcwf, Family::Mixed][i % 2]);
        let cone_edges = [None, Some(8)][i / 2 % 2];
        let settings = WrenchBallSettings { cone_edges, ..Default::default() };
        let found = assess(&wrench_ball(settings), &touches);
        for factor in [0.2, 0.8, 0.97, 1.03, 1.2] {
            let least_margin = factor * found.margin_upper;
            let ball = wrench_ball(WrenchBallSettings { least_margin, ..settings });
            match verdict_of(&ball, &grasp_of(&touches)) {
                Stability::Undecided => undecided += 1,
                said => assert_eq!(said.is_stable(), factor < 1.0 && found.stability.is_stable()),
            }
            let again = assess(&ball, &touches);
            assert!(again.stability == verdict_of(&ball, &grasp_of(&touches)));
        }
    }
    assert!(undecided < 5, "{undecided}");
}

#[test]
fn edges_make_the_ball_smaller_and_more_of_them_less_so() {
    let mut random = Random::from_key(44, 0, 0, 0);
    for _ in 0..10 {
        let touches = closed_grasp(&mut random, Family::Pcwf);
        let margin = |cone_edges| {
            assess(&wrench_ball(WrenchBallSettings { cone_edges, ..Default::default() }), &touches)
        };
        let exact = margin(None);
        assert!(margin(Some(8)).margin_lower <= exact.margin_upper * (1.0 + 1e-9));
        let fine = margin(Some(64));
        assert!(fine.margin_upper >= exact.margin_lower * 0.9 && fine.margin_lower <= exact.margin_upper);
        // As a list of edges the cones are the same.
        let edges = pyramids(&touches, 8);
        let given = with_context(|c| default_ball().assess(&polyhedral(&touches, &edges), None, None, c));
        assert!((given.margin_upper - margin(Some(8)).margin_upper).abs() <= 0.006 * given.margin_upper);
    }
}

#[test]
fn length_and_center_are_those_asked_for() {
    let mut random = Random::from_key(45, 0, 0, 0);
    for _ in 0..8 {
        let touches = closed_grasp(&mut random, Family::SoftFinger);
        let (center, length) = center_and_length(&touches);
        let about = center + random.direction() * length;
        let exact = support::margins(&touches, 2.0 * length, about);
        let asked =
            with_context(|c| default_ball().assess(&grasp_of(&touches), Some(2.0 * length), Some(about), c));
        assert!(asked.margin_lower <= exact.1 * (1.0 + 1e-6) && exact.1 <= asked.margin_upper * 1.006);
        let settings = WrenchBallSettings {
            length: Some(2.0 * length),
            center: regrasp_stability_tests::Center::CenterOfMass,
            ..Default::default()
        };
        let own = assess(&WrenchBall::new(settings, about).unwrap(), &touches);
        assert_eq!((own.margin_lower, own.margin_upper), (asked.margin_lower, asked.margin_upper));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn margins_keep_the_laws(seed in any::<u64>(), factor in 1.0..2.0_f64) {
        let mut random = Random::from_key(seed, 46, 0, 0);
        let touches = closed_grasp(&mut random, Family::Pcwf);
        let (center, length) = center_and_length(&touches);
        let (R, t): (Rotation, Vec3) = (random.rotation(), random.direction());
        let margin = |touches: &[Touch], length, center| {
            with_context(|c| default_ball().assess(&grasp_of(touches), length, center, c))
        };
        let here = margin(&touches, None, None);
        let there = margin(&moved(&touches, &R, t), None, None);
        prop_assert!((here.margin_upper - there.margin_upper).abs() <= 0.011 * here.margin_upper);
        let rougher = margin(&scaled_friction(&touches, factor), Some(length), Some(center));
        prop_assert!(here.margin_lower <= rougher.margin_upper * (1.0 + 1e-9));
        let more = [&touches[..], &[Touch { p: center, ..touches[0] }]].concat();
        prop_assert!(here.margin_lower <= margin(&more, Some(length), Some(center)).margin_upper * (1.0 + 1e-9));
    }
}

#[test]
fn with_no_bound_every_closure_counts() {
    let mut random = Random::from_key(47, 0, 0, 0);
    let (ball, mut context) = (default_ball(), Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted));
    for _ in 0..2_000 {
        let count = 2 + random.index(4);
        let touches = random_touches(&mut random, count, Family::Mixed);
        let said: Result<_, CallError> = ball.test(&grasp_of(&touches), &mut Hint::default(), &mut context);
        assert_eq!(said.unwrap(), verdict(&touches));
    }
}
