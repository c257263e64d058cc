//! Cones of edges: never a false yes, misses as theory says, polyhedral cones exactly.

use crate::support;

use proptest::prelude::*;
use regrasp_api::{Certificate, ConeEdge, Hint, Random, Stability, StabilityTest, Vec3, any_orthogonal};
use regrasp_stability_tests::{Linearised, WrenchBallSettings};
use support::{
    Family, Touch, assess, check_certificate, force_closure, grasp_of, linearised, polyhedral, pyramids,
    random_touches, scaled_friction, socp, verdict, verdict_of, with_context, wrench_ball,
};

fn grasp(random: &mut Random) -> Vec<Touch> {
    let families = [Family::Pcwf, Family::SoftFinger, Family::Frictionless, Family::Mixed];
    let family = families[random.index(4)];
    let count =
        if matches!(family, Family::Frictionless) { 7 + random.index(2) } else { 2 + random.index(5) };
    random_touches(random, count, family)
}

fn says(test: &Linearised, touches: &[Touch]) -> bool {
    verdict_of(test, &grasp_of(touches)).is_stable()
}

#[test]
fn no_yes_is_false_and_every_answer_proves_itself() {
    let mut random = Random::from_key(31, 0, 0, 0);
    let (mut yes, mut proved) = (0, 0);
    for i in 0..6_000 {
        let touches = grasp(&mut random);
        let test = linearised([3, 4, 8, 16, 64][i % 5]);
        let found = assess_quickly(&test, &touches);
        if found.0.is_stable() {
            assert_eq!(verdict(&touches), Stability::Stable, "a false yes: {touches:?}");
            yes += 1;
        }
        if let Some(found) = found.1 {
            let certificate = found.certificate.clone();
            // A separating twist speaks of the edges; round cones may resist it.
            if matches!(certificate, Certificate::InternalForce { .. }) {
                check_certificate(&touches, &found);
                proved += 1;
            }
        }
    }
    assert!(yes > 1_000 && proved > 100, "{yes} {proved}");
}

/// The verdict, and for some grasps the whole assessment.
fn assess_quickly(test: &Linearised, touches: &[Touch]) -> (Stability, Option<regrasp_api::Assessment>) {
    let stability = verdict_of(test, &grasp_of(touches));
    let whole = touches[0].p.x.to_bits().is_multiple_of(8).then(|| assess(test, touches));
    assert!(whole.as_ref().is_none_or(|found| found.stability == stability));
    (stability, whole)
}

#[test]
fn no_yes_is_false_against_the_conic_program() {
    let mut random = Random::from_key(32, 0, 0, 0);
    let (test, reference) = (linearised(64), socp());
    for _ in 0..1_500 {
        let touches = grasp(&mut random);
        if says(&test, &touches) {
            assert_ne!(verdict_of(&reference, &grasp_of(&touches)), Stability::Unstable, "{touches:?}");
        }
    }
}

/// How many of the closed grasps a test misses, and how many there are.
fn misses(edges: usize, family: Family, count: usize) -> (usize, usize) {
    let mut random = Random::from_key(33, 0, 0, 0);
    let test = linearised(edges);
    let (mut missed, mut closed) = (0, 0);
    for _ in 0..count {
        let contacts = 3 + random.index(3);
        let touches = random_touches(&mut random, contacts, family);
        if verdict(&touches).is_stable() {
            closed += 1;
            missed += usize::from(!says(&test, &touches));
        }
    }
    (missed, closed)
}

#[test]
fn misses_fall_with_the_square_of_the_edges() {
    for family in [Family::Pcwf, Family::SoftFinger] {
        let shares = [4, 8, 16, 32].map(|edges| {
            let (missed, closed) = misses(edges, family, 12_000);
            println!("{family:?}, {edges} edges: {missed} of {closed} missed");
            missed as f64 / closed as f64
        });
        // 1/cos(π/m) - 1 goes with 1/m²: each doubling leaves about a quarter.
        for pair in shares.windows(2) {
            assert!(pair[1] < 0.45 * pair[0], "{shares:?}");
        }
        assert!(shares[0] > 0.01 && shares[1] < 0.06 && shares[2] < 0.015, "{shares:?}");
    }
}

#[test]
fn the_friction_needed_is_overestimated_by_no_more_than_theory_says() {
    let mut random = Random::from_key(34, 0, 0, 0);
    let mut tried = 0;
    while tried < 300 {
        let contacts = 3 + random.index(3);
        let touches = random_touches(&mut random, contacts, Family::Pcwf);
        let critical = |closed: &dyn Fn(&[Touch]) -> bool| {
            let (mut low, mut high) = (1e-3, 4.0);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                if closed(&scaled_friction(&touches, middle)) { high = middle } else { low = middle }
            }
            high
        };
        let exact = critical(&|touches| verdict(touches).is_stable());
        if exact > 3.5 {
            continue;
        }
        tried += 1;
        for edges in [8, 16] {
            let test = linearised(edges);
            let over = critical(&|touches| says(&test, touches)) / exact - 1.0;
            let most = 1.0 / (std::f64::consts::PI / edges as f64).cos() - 1.0;
            assert!(over > -1e-6 && over < most + 1e-4, "{edges} edges: {over}, theory {most}");
        }
    }
}

#[test]
fn edges_given_as_a_polyhedral_cone_are_the_same_edges() {
    let mut random = Random::from_key(35, 0, 0, 0);
    let mut stable = 0;
    for _ in 0..1_000 {
        let touches = random_touches(&mut random, 4, Family::Pcwf);
        let edges = pyramids(&touches, 8);
        let given = verdict_of(&linearised(3), &polyhedral(&touches, &edges));
        assert_eq!(given, verdict_of(&linearised(8), &grasp_of(&touches)), "{touches:?}");
        assert_eq!(given, verdict_of(&force_closure(), &polyhedral(&touches, &edges)), "{touches:?}");
        stable += usize::from(given.is_stable());
    }
    assert!((200..800).contains(&stable), "{stable}");
}

/// An edge is a frictionless contact with the edge's direction as normal: the conic program decides those on
/// its own.
#[test]
fn polyhedral_cones_are_decided_as_the_conic_program_decides_their_edges() {
    let mut random = Random::from_key(36, 0, 0, 0);
    let (mut closed, mut clear) = (0, 0);
    for _ in 0..1_500 {
        let touches = random_touches(&mut random, 4, Family::Pcwf);
        let mut edges: Vec<Vec<ConeEdge>> = Vec::new();
        let mut single: Vec<Touch> = Vec::new();
        for (i, touch) in touches.iter().enumerate() {
            let count = [3, 3, 1, 1][i];
            let any = |random: &mut Random| ConeEdge {
                tangential: [random.range(-2.0, 2.0), random.range(-2.0, 2.0)],
                torsion: 0.0,
            };
            let own: Vec<_> = (0..count).map(|_| any(&mut random)).collect();
            single.extend(own.iter().map(|edge| {
                let t1 = any_orthogonal(&-touch.n);
                let t2 = (-touch.n).cross(&t1);
                let f = -touch.n + t1 * edge.tangential[0] + t2 * edge.tangential[1];
                Touch { n: -f.normalize(), mu: 0.0, gamma: 0.0, ..*touch }
            }));
            edges.push(own);
        }
        let ours = verdict_of(&linearised(8), &polyhedral(&touches, &edges));
        let reference = verdict_of(&socp(), &grasp_of(&single));
        if ours != Stability::Undecided && reference != Stability::Undecided {
            assert_eq!(ours, reference, "{touches:?} {edges:?}");
            clear += 1;
            closed += usize::from(ours.is_stable());
        }
    }
    assert!(clear > 1_450 && closed > 5, "{clear} {closed}");
}

#[test]
fn torsion_as_an_edge_holds_an_axis() {
    let pair = [Vec3::x(), -Vec3::x()].map(|n| Touch { p: n, n, mu: 0.5, gamma: 0.0 });
    let with = |torsion: f64| {
        let mut edges = pyramids(&pair, 4);
        for edges in &mut edges {
            edges.extend([torsion, -torsion].map(|torsion| ConeEdge { tangential: [0.0; 2], torsion }));
        }
        verdict_of(&linearised(8), &polyhedral(&pair, &edges))
    };
    assert_eq!(with(0.1), Stability::Stable);
    assert_eq!(with(0.0), Stability::Unstable);
}

#[test]
fn degenerate_grasps_are_never_closed() {
    let pair = [Vec3::x(), -Vec3::x()].map(|n| Touch { p: n, n, mu: 0.8, gamma: 0.0 });
    let on_line = Touch { p: Vec3::x() * 0.2, n: Vec3::y(), mu: 0.8, gamma: 0.0 };
    let face = [Vec3::x(), Vec3::y(), -Vec3::x() - Vec3::y()].map(|p| Touch {
        p,
        n: Vec3::z(),
        mu: 2.0,
        gamma: 0.0,
    });
    for touches in
        [&pair[..], &[pair[0]; 4], &[pair[0], pair[1], on_line], &[pair[0], pair[1], pair[1]], &face]
    {
        for edges in [3, 8, 64] {
            assert_ne!(verdict_of(&linearised(edges), &grasp_of(touches)), Stability::Stable, "{touches:?}");
        }
    }
    // No edges at all hold nothing.
    let none = vec![vec![]; 2];
    assert_ne!(verdict_of(&linearised(8), &polyhedral(&pair, &none)), Stability::Stable);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn verdicts_keep_the_laws(seed in any::<u64>(), factor in 1.0..3.0_f64, exponent in -2.0..2.0_f64, turn in 1..6_usize) {
        let mut random = Random::from_key(seed, 37, 0, 0);
        let touches = grasp(&mut random);
        let test = linearised(3 + random.index(20));
        let stable = says(&test, &touches);
        let scale = 10_f64.powf(exponent);
        let resized: Vec<_> = touches.iter().map(|t| Touch { p: t.p * scale, gamma: t.gamma * scale, ..*t }).collect();
        prop_assert_eq!(says(&test, &resized), stable);
        let mut permuted = touches.clone();
        permuted.rotate_left(turn % touches.len());
        prop_assert_eq!(says(&test, &permuted), stable);
        let shifted: Vec<_> = touches.iter().map(|t| Touch { p: t.p + Vec3::new(1.0, 2.0, -1.0) * scale, ..*t }).collect();
        prop_assert_eq!(says(&test, &shifted), stable);
        if stable {
            prop_assert!(says(&test, &scaled_friction(&touches, factor)));
            if touches.len() < 8 {
                let p = touches[0].p + random.direction() * 0.01;
                let more = [&touches[..], &[Touch { p, n: random.direction(), mu: 0.3, gamma: 0.0 }]].concat();
                prop_assert!(says(&test, &more));
            }
        }
    }

    #[test]
    fn hints_are_left_alone(seed in any::<u64>(), tag in 0..4_u64, values in prop::array::uniform16(-1.0..1.0_f64)) {
        let touches = grasp(&mut Random::from_key(seed, 38, 0, 0));
        let mut hint = Hint { tag, values };
        let hinted = with_context(|context| linearised(8).test(&grasp_of(&touches), &mut hint, context));
        prop_assert_eq!(hinted, verdict_of(&linearised(8), &grasp_of(&touches)));
    }
}

#[test]
fn lifting_agrees_with_single_tests_and_margins_with_the_wrench_ball() {
    let mut random = Random::from_key(39, 0, 0, 0);
    let (test, mut compared) = (linearised(8), 0);
    let ball = wrench_ball(WrenchBallSettings { cone_edges: Some(8), ..Default::default() });
    for _ in 0..60 {
        let touches = random_touches(&mut random, 4, Family::Mixed);
        let lifted = with_context(|context| test.liftable(&grasp_of(&touches), 0, context));
        for (i, finger) in grasp_of(&touches).contacts().iter().map(|contact| contact.finger).enumerate() {
            let mut rest = touches.clone();
            rest.remove(i);
            assert_eq!(lifted.contains(finger), says(&test, &rest));
        }
        if says(&test, &touches) && compared < 12 {
            let (ours, exact) = (assess(&test, &touches), assess(&force_closure(), &touches));
            assert_eq!(ours.margin_upper, assess(&ball, &touches).margin_upper);
            assert!(ours.margin_lower > 0.0 && ours.margin_lower <= exact.margin_upper * (1.0 + 1e-6));
            compared += 1;
        }
    }
    assert!(compared > 5);
}
