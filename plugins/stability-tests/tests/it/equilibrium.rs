//! Equilibrium under a load: closed forms, a conic program a disturbance, and the laws.

use crate::support;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use nalgebra::{DMatrix, Vector6};
use proptest::prelude::*;
use regrasp_api::{
    Assessment, Certificate, Cone, ConeEdge, Criterion, FingerIndex, Grasp, GraspContact, Random, Rotation,
    Stability, StabilityTest, Vec3, any_orthogonal,
};
use regrasp_stability_tests::{Equilibrium, EquilibriumSettings};
use support::{Family, Touch, grasp_of, moved, random_touches, touch, verdict, verdict_of, with_context};

const DOWN: Vec3 = Vec3::new(0.0, 0.0, -9.81);

/// A load that only just disturbs.
const GENTLE: EquilibriumSettings =
    EquilibriumSettings { disturbance_force: 1e-3, disturbance_torque: 1e-6, max_normal_force: 10.0 };

fn test_of(settings: EquilibriumSettings, mass: f64, p_OCm: Vec3) -> Equilibrium {
    Equilibrium::new(settings, mass, p_OCm).unwrap()
}

fn with_gravity(touches: &[Touch], g_O: Vec3) -> Grasp<'static> {
    let mut grasp = grasp_of(touches);
    grasp.g_O = g_O;
    grasp
}

fn holds(settings: EquilibriumSettings, mass: f64, touches: &[Touch], g_O: Vec3) -> bool {
    verdict_of(&test_of(settings, mass, Vec3::zeros()), &with_gravity(touches, g_O)).is_stable()
}

fn assess(test: &Equilibrium, grasp: &Grasp<'_>) -> Assessment {
    with_context(|context| test.assess(grasp, None, None, context))
}

/// Contacts around the equator of a ball of 30 mm radius.
fn equator(count: usize, mu: f64) -> Vec<Touch> {
    let at = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
        touch([0.03 * cos, 0.03 * sin, 0.0], [cos, sin, 0.0], mu)
    };
    (0..count).map(at).collect()
}

#[test]
fn fingers_around_a_ball_carry_what_friction_allows() {
    // Normals are level: each finger lifts at most μ N, n of them n μ N.
    for (count, mu) in [(3, 0.5), (4, 0.8), (5, 0.3)] {
        let most = count as f64 * mu * GENTLE.max_normal_force / 9.81;
        assert!(holds(GENTLE, 0.99 * most, &equator(count, mu), DOWN), "{count} {mu}");
        assert!(!holds(GENTLE, 1.01 * most, &equator(count, mu), DOWN), "{count} {mu}");
    }
}

#[test]
fn the_bound_of_the_force_is_kept_by_every_finger_alone() {
    // Two pairs at unlike heights above the centre of mass: the same count, but the weight hangs beside two
    // of the fingers.
    let shifted = Vec3::new(0.02, 0.0, 0.0);
    let touches = equator(4, 0.8);
    let most = |p_OCm: Vec3| {
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            let test = test_of(GENTLE, middle, p_OCm);
            if verdict_of(&test, &with_gravity(&touches, DOWN)).is_stable() {
                low = middle
            } else {
                high = middle
            }
        }
        low
    };
    // At the lever 20 mm of 30 mm: the finger there alone would carry most of it.
    assert!(most(shifted) < 0.9 * most(Vec3::zeros()), "{} {}", most(shifted), most(Vec3::zeros()));
}

#[test]
fn a_ball_on_three_fingers_from_below_is_held_up_but_not_upside_down() {
    let below: Vec<_> = (0..3)
        .map(|k| {
            let (sin, cos) = (2.1 * k as f64).sin_cos();
            let n = Vec3::new(0.6 * cos, 0.6 * sin, -0.8);
            Touch { p: n * 0.03, n, mu: 0.5, gamma: 0.0 }
        })
        .collect();
    // No closure: all push upwards.
    assert_eq!(verdict(&below), Stability::Unstable);
    assert!(holds(GENTLE, 0.1, &below, DOWN));
    assert!(!holds(GENTLE, 0.1, &below, -DOWN));
    assert!(!holds(GENTLE, 0.1, &below, Vec3::zeros()));
    // The turn decides which fingers may be lifted.
    let four = [&below[..], &[touch([0.0, 0.0, 0.03], [0.0, 0.0, 1.0], 0.5)]].concat();
    let lifted = |g_O: Vec3| {
        let test = test_of(GENTLE, 0.1, Vec3::zeros());
        with_context(|context| test.liftable(&with_gravity(&four, g_O), 0, context))
    };
    assert!(lifted(DOWN).contains(FingerIndex(3)) && !lifted(-DOWN).contains(FingerIndex(3)));
}

#[test]
fn without_gravity_every_stable_grasp_is_force_closure() {
    let mut random = Random::from_key(51, 0, 0, 0);
    let (mut yes, mut closed) = (0, 0);
    for _ in 0..3_000 {
        let count = 2 + random.index(4);
        let touches = random_touches(&mut random, count, Family::Mixed);
        let held = holds(GENTLE, 1.0, &touches, Vec3::zeros());
        let closure = verdict(&touches).is_stable();
        assert!(closure || !held, "{touches:?}");
        yes += usize::from(held);
        closed += usize::from(closure);
    }
    // A force at an object's own origin is far off for grasps elsewhere: not all closed grasps hold it.
    assert!(yes > closed / 2 && yes > 300, "{yes} of {closed}");
}

/// How far inside some forces that balance `wanted` (force, torque about O's origin) can be, as a part of the
/// largest: by Clarabel.
fn reference(touches: &[Touch], wanted: &Vector6<f64>, most: f64, length: f64) -> Option<f64> {
    let columns = 4 * touches.len() + 1;
    // Rows: balance; f_n + t ≤ 1; (f_n - t, u) in the cone.
    let mut A = DMatrix::<f64>::zeros(6 + 5 * touches.len(), columns);
    let mut b = vec![0.0; A.nrows()];
    let mut cones = vec![SupportedConeT::ZeroConeT(6), SupportedConeT::NonnegativeConeT(touches.len())];
    for (i, touch) in touches.iter().enumerate() {
        let n = -touch.n;
        let t1 = any_orthogonal(&n);
        let forces = [n, t1 * touch.mu, n.cross(&t1) * touch.mu];
        for (k, f) in forces.iter().enumerate() {
            let m = touch.p.cross(f) / length;
            A.view_mut((0, 4 * i + k), (6, 1)).copy_from(&Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z));
        }
        A.view_mut((3, 4 * i + 3), (3, 1)).copy_from(&(n * (touch.gamma / length)));
        A[(6 + i, 4 * i)] = 1.0;
        A[(6 + i, columns - 1)] = 1.0;
        b[6 + i] = 1.0;
        let first = 6 + touches.len() + 4 * i;
        (0..4).for_each(|k| A[(first + k, 4 * i + k)] = -1.0);
        A[(first, columns - 1)] = 1.0;
        cones.push(SupportedConeT::SecondOrderConeT(4));
    }
    for k in 0..6 {
        b[k] = wanted[k] / most / if k < 3 { 1.0 } else { length };
    }
    let mut cost = vec![0.0; columns];
    cost[columns - 1] = -1.0;
    let settings = DefaultSettingsBuilder::default().verbose(false).build().unwrap();
    let P = CscMatrix::zeros((columns, columns));
    let mut solver = DefaultSolver::new(&P, &cost, &compressed(&A), &b, &cones, settings).unwrap();
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => Some(solver.solution.x[columns - 1]),
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Some(f64::NEG_INFINITY),
        _ => None,
    }
}

fn compressed(dense: &DMatrix<f64>) -> CscMatrix<f64> {
    let rows: Vec<Vec<f64>> = dense.row_iter().map(|row| row.iter().copied().collect()).collect();
    CscMatrix::from(&rows)
}

/// The wrenches that the contacts must give: against the weight alone, and with each vertex of the
/// disturbances.
fn loads(settings: &EquilibriumSettings, mass: f64, p_OCm: Vec3, g_O: Vec3) -> Vec<Vector6<f64>> {
    let wrench = |f: Vec3, m: Vec3| {
        let m = p_OCm.cross(&f) + m;
        Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
    };
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut all = vec![wrench(-g_O * mass, Vec3::zeros())];
    for (short, long) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        for v in [Vec3::new(0.0, short, long), Vec3::new(short, long, 0.0), Vec3::new(long, 0.0, short)] {
            let v = v / (golden * golden / 3.0_f64.sqrt());
            all.push(wrench(-g_O * mass + v * settings.disturbance_force, Vec3::zeros()));
            all.push(wrench(-g_O * mass, v * settings.disturbance_torque));
        }
    }
    all
}

/// A random problem of a few centimetres: contacts, mass, centre of mass, gravity, load.
fn problem(random: &mut Random) -> (Vec<Touch>, Equilibrium, EquilibriumSettings, f64, Vec3, Vec3) {
    let count = 2 + random.index(4);
    let family = [Family::Pcwf, Family::SoftFinger, Family::Mixed][random.index(3)];
    let touches = loop {
        let touches = random_touches(random, count, family);
        let reach = touches.iter().map(|touch| touch.p.norm()).fold(0.0, f64::max);
        if reach > 1e-3 {
            let scale = 0.04 / reach;
            break touches
                .into_iter()
                .map(|t| Touch { p: t.p * scale, gamma: t.gamma * scale, ..t })
                .collect::<Vec<_>>();
        }
    };
    let settings = EquilibriumSettings {
        disturbance_force: 10_f64.powf(random.range(-3.0, 0.3)),
        disturbance_torque: 10_f64.powf(random.range(-5.0, -2.0)),
        max_normal_force: 10_f64.powf(random.range(0.0, 1.5)),
    };
    let mass = 10_f64.powf(random.range(-2.0, 0.3));
    let p_OCm = touches.iter().map(|t| t.p).sum::<Vec3>() / count as f64 + random.direction() * 0.01;
    (touches, test_of(settings, mass, p_OCm), settings, mass, p_OCm, random.direction() * 9.81)
}

#[test]
fn verdicts_are_those_of_a_conic_program_for_every_disturbance() {
    let mut random = Random::from_key(52, 0, 0, 0);
    let (mut stable, mut unclear) = (0, 0);
    for _ in 0..1_200 {
        let (touches, test, settings, mass, p_OCm, g_O) = problem(&mut random);
        let found = verdict_of(&test, &with_gravity(&touches, g_O));
        let (mut least, mut lost) = (f64::INFINITY, false);
        for wanted in loads(&settings, mass, p_OCm, g_O) {
            match reference(&touches, &wanted, settings.max_normal_force, 0.04) {
                Some(slack) => least = least.min(slack),
                None => lost = true,
            }
            if least < -1e-7 {
                break;
            }
        }
        stable += usize::from(found.is_stable());
        if found == Stability::Undecided || least.abs() < 1e-7 || lost && least > 0.0 {
            unclear += 1;
            continue;
        }
        assert_eq!(found.is_stable(), least > 0.0, "slack {least}: {touches:?} {test:?} {g_O:?}");
    }
    assert!((200..1_000).contains(&stable) && unclear < 40, "{stable} stable, {unclear} unclear");
}

#[test]
fn certificates_balance_the_weight_inside_cones_and_bounds() {
    let mut random = Random::from_key(53, 0, 0, 0);
    let mut checked = 0;
    for _ in 0..400 {
        let (touches, test, settings, mass, p_OCm, g_O) = problem(&mut random);
        let found = assess(&test, &with_gravity(&touches, g_O));
        if !found.stability.is_stable() {
            assert!(found.margin_lower <= 0.0 && found.certificate == Certificate::None);
            continue;
        }
        let Certificate::InternalForce { forces_O, torsions } = &found.certificate else {
            panic!("{found:?}")
        };
        let (mut f_sum, mut m_sum) = (g_O * mass, p_OCm.cross(&(g_O * mass)));
        for ((touch, f), m) in touches.iter().zip(forces_O).zip(torsions) {
            let normal = -f.dot(&touch.n);
            let tangential = (f + touch.n * normal).norm();
            let spin = if touch.gamma > 0.0 { m / touch.gamma } else { 0.0 };
            let part = if touch.mu > 0.0 { tangential / touch.mu } else { 0.0 };
            assert!(normal < settings.max_normal_force && part.hypot(spin) < normal);
            f_sum += f;
            m_sum += touch.p.cross(f) - touch.n * *m;
        }
        assert!(
            f_sum.norm() < 1e-9 * settings.max_normal_force
                && m_sum.norm() < 1e-10 * settings.max_normal_force
        );
        checked += 1;
    }
    assert!(checked > 80, "{checked}");
}

#[test]
fn margins_say_by_how_much_disturbances_may_grow() {
    let mut random = Random::from_key(54, 0, 0, 0);
    let mut checked = 0;
    while checked < 40 {
        let (touches, test, settings, mass, p_OCm, g_O) = problem(&mut random);
        let found = assess(&test, &with_gravity(&touches, g_O));
        if !found.stability.is_stable() || found.margin_upper > 100.0 {
            continue;
        }
        checked += 1;
        for (factor, stable) in
            [(0.999 * (1.0 + found.margin_lower), true), (1.001 * (1.0 + found.margin_upper), false)]
        {
            let grown = EquilibriumSettings {
                disturbance_force: settings.disturbance_force * factor,
                disturbance_torque: settings.disturbance_torque * factor,
                ..settings
            };
            let test = test_of(grown, mass, p_OCm);
            assert_eq!(verdict_of(&test, &with_gravity(&touches, g_O)).is_stable(), stable, "{found:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn verdicts_keep_the_laws(seed in any::<u64>(), factor in 1.0..3.0_f64, turn in 1..5_usize) {
        let mut random = Random::from_key(seed, 55, 0, 0);
        let (touches, test, settings, mass, p_OCm, g_O) = problem(&mut random);
        let grasp = with_gravity(&touches, g_O);
        let found = verdict_of(&test, &grasp);
        prop_assert_eq!(assess(&test, &grasp).stability, found);
        // A translation; a turn by a symmetry of the icosahedra, which the object's axes carry.
        let third = Rotation::from_scaled_axis(Vec3::repeat(std::f64::consts::TAU / 3.0 / 3.0_f64.sqrt()));
        let t = random.direction();
        let elsewhere = test_of(settings, mass, third * p_OCm + t);
        let there = verdict_of(&elsewhere, &with_gravity(&moved(&touches, &third, t), third * g_O));
        let doubt = found == Stability::Undecided || there == Stability::Undecided;
        prop_assert!(doubt || found == there);
        let mut permuted = touches.clone();
        permuted.rotate_left(turn % touches.len());
        prop_assert_eq!(verdict_of(&test, &with_gravity(&permuted, g_O)).is_stable(), found.is_stable());
        if found.is_stable() {
            let rougher = support::scaled_friction(&touches, factor);
            prop_assert!(verdict_of(&test, &with_gravity(&rougher, g_O)).is_stable());
            let stronger = EquilibriumSettings { max_normal_force: settings.max_normal_force * factor, ..settings };
            prop_assert!(verdict_of(&test_of(stronger, mass, p_OCm), &grasp).is_stable());
            let more = [&touches[..], &[Touch { n: random.direction(), ..touches[0] }]].concat();
            prop_assert!(verdict_of(&test, &with_gravity(&more, g_O)).is_stable());
        }
    }
}

#[test]
fn it_says_what_it_means_and_takes_edges() {
    let test = test_of(EquilibriumSettings::default(), 0.1, Vec3::zeros());
    match test.criterion() {
        Criterion::Equilibrium(load) => assert_eq!(load.max_normal_force, 20.0),
        other => panic!("{other:?}"),
    }
    assert_eq!(support::force_closure().criterion(), Criterion::Closure);
    // Four pyramids round a ball carry it; three edges along one line carry nothing.
    let carried = |edges: Vec<ConeEdge>| {
        let mut grasp = Grasp::new(DOWN);
        for touch in equator(4, 0.8) {
            let (p_OC, n_O, cone) = (touch.p, touch.n, Cone::Polyhedral(edges.clone().into()));
            grasp.push(GraspContact { finger: FingerIndex(0), p_OC, n_O, cone });
        }
        let found = assess(&test, &grasp);
        assert_eq!(found.stability.is_stable(), found.certificate != Certificate::None, "{found:?}");
        found.stability.is_stable()
    };
    let edge = |x: f64, y: f64| ConeEdge { tangential: [x, y], torsion: 0.0 };
    assert!(carried(vec![edge(0.7, 0.0), edge(-0.7, 0.0), edge(0.0, 0.7), edge(0.0, -0.7)]));
    assert!(!carried(vec![edge(0.5, 0.0), edge(0.0, 0.0), edge(-0.5, 0.0)]));
}
