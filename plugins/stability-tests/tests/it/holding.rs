//! `holding`: proofs of both verdicts, and what they must follow.
use crate::support;

use regrasp_api::*;
use regrasp_stability_tests::{Holding, HoldingSettings};
use support::with_context;

/// A ball of 30 mm and 100 g.
fn ball() -> ObjectModel {
    let unit = 0.03 / 3.0_f64.sqrt();
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let vertices: Vec<Vec3> = corners.iter().map(|corner| Vec3::from(*corner) * unit).collect();
    let mesh = Mesh::new(vertices, vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);
    let mut object = ObjectModel::new(mesh.expect("a tetrahedron is closed"), None, 0.1, 0.8);
    object.p_OCm = Vec3::zeros();
    object
}

fn test_with(settings: HoldingSettings) -> Holding {
    Holding::new(settings, &ball()).unwrap()
}

#[derive(Clone, Debug)]
struct Case {
    contacts: Vec<(Vec3, f64, EffortBounds)>,
    g_O: Vec3,
}

/// Contacts around a ball, three or four joints behind each, a weight in some direction.
fn case(random: &mut Random, count: usize) -> Case {
    let contact = |random: &mut Random| {
        let joints = 3 + random.index(2);
        let joint = |_| JointBound {
            column_O: random.direction() * random.range(0.01, 0.1),
            spin: 0.0,
            limit: random.range(0.01, 0.3),
        };
        let bounds: Vec<JointBound> = (0..joints).map(joint).collect();
        (random.direction(), random.range(0.3, 1.0), EffortBounds::from_joints(bounds))
    };
    let contacts = (0..count).map(|_| contact(random)).collect();
    Case { contacts, g_O: random.direction() * random.range(1.0, 15.0) }
}

fn grasp(case: &Case, friction: f64, efforts: f64, weight: f64) -> Grasp<'static> {
    let mut grasp = Grasp::new(case.g_O * weight);
    for (i, (n_O, mu, bounds)) in case.contacts.iter().enumerate() {
        let cone = Cone::Elliptic { mu: mu * friction, gamma: 0.0 };
        let contact = GraspContact { finger: FingerIndex(i as u8), p_OC: n_O * 0.03, n_O: *n_O, cone };
        grasp.push_bounded(contact, bounds.with_share(efforts));
    }
    grasp
}

fn verdict(test: &Holding, grasp: &Grasp<'_>) -> Stability {
    with_context(|context| test.test(grasp, &mut Hint::default(), context))
}

/// What the default reserve leaves of friction and efforts.
const KEPT: f64 = 0.95;

#[test]
fn a_yes_is_proved_by_forces_in_balance_within_cones_and_efforts() {
    let test = test_with(HoldingSettings::default());
    let mut random = Random::from_key(31, 0, 0, 0);
    let mut found = [0; 2];
    for k in 0..600 {
        let case = case(&mut random, 3 + k % 3);
        let grasp = grasp(&case, 1.0, 1.0, 1.0);
        let assessed = with_context(|context| test.assess(&grasp, None, None, context));
        assert_eq!(assessed.stability, verdict(&test, &grasp));
        match assessed.certificate {
            Certificate::InternalForce { forces_O, .. } => {
                assert!(assessed.stability.is_stable());
                found[0] += 1;
                let mut sum = (case.g_O * 0.1, Vec3::zeros());
                for (force, (n_O, mu, bounds)) in forces_O.iter().zip(&case.contacts) {
                    let normal = -n_O.dot(force);
                    assert!((force + n_O * normal).norm() <= KEPT * mu * normal);
                    let efforts = bounds.efforts_of(force, 0.0);
                    assert!(efforts.iter().zip(bounds.joints()).all(|(e, j)| e.abs() <= KEPT * j.limit));
                    sum.0 += force;
                    sum.1 += (n_O * 0.03).cross(force);
                }
                assert!(sum.0.norm() < 1e-8 && sum.1.norm() < 1e-9, "{sum:?}");
            }
            Certificate::SeparatingTwist { v_O, w_O } => {
                assert_eq!(assessed.stability, Stability::Unstable);
                found[1] += 1;
                // The object gives way so that its weight does more work than the fingers at their limits
                // can.
                let centroid =
                    case.contacts.iter().map(|c| c.0 * 0.03).sum::<Vec3>() / case.contacts.len() as f64;
                let at = |p: Vec3| v_O + w_O.cross(&(p - centroid));
                let work = -(case.g_O * 0.1).dot(&at(Vec3::zeros()));
                let most: f64 =
                    case.contacts.iter().map(|contact| most_power(contact, &at(contact.0 * 0.03))).sum();
                assert!(work > most * (1.0 - 1e-6), "{k}: {work} {most}");
            }
            Certificate::None => assert_eq!(assessed.stability, Stability::Undecided),
        }
    }
    assert!(found[0] > 80 && found[1] > 80, "{found:?}");
}

/// The most power of one contact's forces on the velocity of its point, from below: rays of its cone as far
/// as the efforts let them go.
fn most_power((n_O, mu, bounds): &(Vec3, f64, EffortBounds), velocity: &Vec3) -> f64 {
    let tangent = any_orthogonal(n_O);
    let other = n_O.cross(&tangent);
    let mut most = 0.0_f64;
    for k in 0..120 {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 120.0).sin_cos();
        for part in 0..=6 {
            let rim = KEPT * mu * f64::from(part) / 6.0;
            let force = -n_O + tangent * (rim * cos) + other * (rim * sin);
            let efforts = bounds.efforts_of(&force, 0.0);
            let shares = efforts.iter().zip(bounds.joints()).map(|(e, j)| e.abs() / (KEPT * j.limit));
            let taken = shares.fold(1e-12, f64::max);
            most = most.max(force.dot(velocity) / taken);
        }
    }
    most
}

#[test]
fn more_friction_stronger_joints_and_less_weight_never_lose_a_grasp() {
    let test = test_with(HoldingSettings::default());
    let mut random = Random::from_key(32, 0, 0, 0);
    let mut held = 0;
    for k in 0..400 {
        let case = case(&mut random, 3 + k % 3);
        if !verdict(&test, &grasp(&case, 1.0, 1.0, 1.0)).is_stable() {
            continue;
        }
        held += 1;
        for (friction, efforts, weight) in
            [(1.3, 1.0, 1.0), (1.0, 1.5, 1.0), (1.0, 1.0, 0.6), (1.2, 1.2, 0.9)]
        {
            assert!(verdict(&test, &grasp(&case, friction, efforts, weight)).is_stable(), "{k}");
        }
    }
    assert!(held > 50, "{held}");
}

#[test]
fn hints_of_a_grasp_nearby_change_no_verdict() {
    let test = test_with(HoldingSettings { disturbance_force: 0.05, ..Default::default() });
    let mut random = Random::from_key(33, 0, 0, 0);
    for k in 0..80 {
        let (mut case, mut hint) = (case(&mut random, 3 + k % 3), Hint::default());
        for _ in 0..6 {
            let grasp = grasp(&case, 1.0, 1.0, 1.0);
            let warm = with_context(|context| test.test(&grasp, &mut hint, context));
            assert_eq!(warm.is_stable(), verdict(&test, &grasp).is_stable(), "{k}");
            case.g_O += random.direction() * 0.05;
            case.contacts.iter_mut().for_each(|c| c.0 = (c.0 + random.direction() * 0.01).normalize());
        }
    }
}

#[test]
fn disturbances_ask_for_more_than_the_weight() {
    let (calm, shaken) =
        (HoldingSettings::default(), HoldingSettings { disturbance_force: 0.5, ..Default::default() });
    let [calm, shaken] = [calm, shaken].map(test_with);
    let mut random = Random::from_key(34, 0, 0, 0);
    let (mut both, mut calm_alone) = (0, 0);
    for k in 0..300 {
        let grasp = grasp(&case(&mut random, 3 + k % 3), 1.0, 1.0, 1.0);
        match [&calm, &shaken].map(|test| verdict(test, &grasp).is_stable()) {
            [true, true] => both += 1,
            [true, false] => calm_alone += 1,
            [false, shaken] => assert!(!shaken, "{k}"),
        }
    }
    assert!(both > 10 && calm_alone > 10, "{both} {calm_alone}");
}

/// The grasp with each cone, or every second one, replaced by `count` edges on it.
fn edged(grasp: &Grasp<'_>, count: usize, all: bool) -> Grasp<'static> {
    let mut edged = Grasp::new(grasp.g_O);
    for (i, contact) in grasp.contacts().iter().enumerate() {
        let Cone::Elliptic { mu, .. } = contact.cone else { panic!("the cases are round") };
        let edge = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
            ConeEdge { tangential: [mu * cos, mu * sin], torsion: 0.0 }
        };
        let edges = (0..count).map(edge).collect::<Vec<_>>();
        let is_round = !all && i % 2 == 1;
        let cone = if is_round { Cone::Elliptic { mu, gamma: 0.0 } } else { Cone::Polyhedral(edges.into()) };
        let contact = GraspContact { finger: contact.finger, p_OC: contact.p_OC, n_O: contact.n_O, cone };
        edged.push_bounded(contact, *grasp.efforts(i).expect("the cases have joints"));
    }
    edged
}

/// The cone of m edges on a round one lies between it and the round one of cos(π/m) times the friction.
#[test]
fn edges_hold_what_lies_between_two_round_cones() {
    let shaken = HoldingSettings { disturbance_force: 0.05, disturbance_torque: 5e-4, ..Default::default() };
    for settings in [HoldingSettings::default(), shaken] {
        let (test, mut random) = (test_with(settings), Random::from_key(35, 0, 0, 0));
        let (mut held, mut lost, mut undecided) = (0, 0, 0);
        for k in 0..240 {
            let case = case(&mut random, 3 + k % 3);
            let (count, all) = ([4, 8, 16][k % 3], k % 4 != 0);
            // In a grasp of both kinds the round cones are taken by edges on them, 24.
            let inner = (std::f64::consts::PI / count as f64).cos();
            let [outer, middle, inner] = [1.0, 1.0, inner * 0.99].map(|part| grasp(&case, part, 1.0, 1.0));
            let middle = edged(&middle, count, all);
            let verdicts = [&outer, &middle, &inner].map(|grasp| verdict(&test, grasp));
            assert!(!verdicts[1].is_stable() || verdicts[0].is_stable(), "{k}: {verdicts:?}");
            assert!(!verdicts[2].is_stable() || verdicts[1].is_stable(), "{k}: {verdicts:?}");
            held += u32::from(verdicts[1].is_stable());
            lost += u32::from(verdicts[1] == Stability::Unstable);
            undecided += u32::from(verdicts[1] == Stability::Undecided);
        }
        assert!(held > 15 && lost > 60 && undecided < 12, "{held} held, {lost} lost, {undecided} undecided");
    }
}

#[test]
fn what_edges_hold_is_proved_by_weights_within_cones_and_efforts() {
    let test = test_with(HoldingSettings::default());
    let mut random = Random::from_key(36, 0, 0, 0);
    let mut found = [0; 2];
    for k in 0..150 {
        let case = case(&mut random, 3 + k % 3);
        let grasp = edged(&grasp(&case, 1.0, 1.0, 1.0), 8, true);
        let assessed = with_context(|context| test.assess(&grasp, None, None, context));
        assert_eq!(assessed.stability, verdict(&test, &grasp));
        assert!(assessed.margin_lower <= assessed.margin_upper, "{assessed:?}");
        match assessed.certificate {
            Certificate::InternalForce { forces_O, .. } => {
                found[0] += 1;
                assert!(assessed.stability.is_stable() && assessed.margin_lower >= 0.0);
                let mut sum = (case.g_O * 0.1, Vec3::zeros());
                for (force, (n_O, mu, bounds)) in forces_O.iter().zip(&case.contacts) {
                    // Within the octagon of each edge's friction: its sides are cos(π/8) from the middle.
                    let normal = -n_O.dot(force);
                    let [t1, t2] = tangents(&-n_O);
                    for side in 0..8 {
                        let (sin, cos) = (std::f64::consts::FRAC_PI_4 * (f64::from(side) + 0.5)).sin_cos();
                        let along = force.dot(&(t1 * cos + t2 * sin));
                        let most = KEPT * mu * normal * std::f64::consts::FRAC_PI_8.cos();
                        assert!(along <= most * (1.0 + 1e-9), "{k}: {along} {most}");
                    }
                    let efforts = bounds.efforts_of(force, 0.0);
                    assert!(efforts.iter().zip(bounds.joints()).all(|(e, j)| e.abs() <= KEPT * j.limit));
                    sum.0 += force;
                    sum.1 += (n_O * 0.03).cross(force);
                }
                assert!(sum.0.norm() < 1e-7 && sum.1.norm() < 1e-8, "{k}: {sum:?}");
            }
            Certificate::SeparatingTwist { v_O, w_O } => {
                found[1] += 1;
                assert_eq!(assessed.stability, Stability::Unstable);
                let centroid =
                    case.contacts.iter().map(|c| c.0 * 0.03).sum::<Vec3>() / case.contacts.len() as f64;
                let at = |p: Vec3| v_O + w_O.cross(&(p - centroid));
                let work = -(case.g_O * 0.1).dot(&at(Vec3::zeros()));
                let most: f64 = case.contacts.iter().map(|c| most_power_of_edges(c, &at(c.0 * 0.03))).sum();
                assert!(work > most * (1.0 - 1e-6), "{k}: {work} {most}");
            }
            Certificate::None => assert_eq!(assessed.stability, Stability::Undecided),
        }
    }
    assert!(found[0] > 15 && found[1] > 20, "{found:?}");
}

/// The most power of one contact's eight edges on the velocity of its point, from below: each edge as far as
/// the efforts let it go.
fn most_power_of_edges((n_O, mu, bounds): &(Vec3, f64, EffortBounds), velocity: &Vec3) -> f64 {
    let [t1, t2] = tangents(&-n_O);
    let of_edge = |k: i32| {
        let (sin, cos) = (std::f64::consts::FRAC_PI_4 * f64::from(k)).sin_cos();
        let force = -n_O + t1 * (KEPT * mu * cos) + t2 * (KEPT * mu * sin);
        let efforts = bounds.efforts_of(&force, 0.0);
        let shares = efforts.iter().zip(bounds.joints()).map(|(e, j)| e.abs() / (KEPT * j.limit));
        force.dot(velocity) / shares.fold(1e-12, f64::max)
    };
    (0..8).map(of_edge).fold(0.0, f64::max)
}

/// Three contacts on the equator of the ball that drag with up to `drag` (m).
fn dragging(mu: f64, drag: f64) -> Grasp<'static> {
    let mut grasp = Grasp::new(Vec3::z() * -9.81);
    for i in 0..3_u8 {
        let (y, x) = (f64::from(i) * std::f64::consts::TAU / 3.0).sin_cos();
        let (n_O, cone) = (Vec3::new(x, y, 0.0), Cone::Elliptic { mu, gamma: 0.0 });
        grasp.push(GraspContact { finger: FingerIndex(i), p_OC: n_O * 0.03, n_O, cone });
        grasp.drags(drag);
    }
    grasp
}

/// The torque that drag gives about a horizontal axis is borne by friction along the other one: a radius of
/// torsion that is small against μ r is held, one that is larger than 2 μ r is not.
#[test]
fn drag_must_be_balanced_whichever_way() {
    let settings = |drag| HoldingSettings { drag, max_normal_force: Some(10.0), ..Default::default() };
    let (all, none, half) = (test_with(settings(1.0)), test_with(settings(0.0)), test_with(settings(0.5)));
    let mut last = true;
    for drag in [0.0, 0.004, 0.01, 0.02, 0.03, 0.06, 0.1] {
        let grasp = dragging(0.8, drag);
        assert!(verdict(&none, &grasp).is_stable(), "who counts no drag holds it at {drag}");
        let stable = verdict(&all, &grasp).is_stable();
        assert!(last || !stable, "more drag is no easier: {drag}");
        assert_eq!(verdict(&half, &dragging(0.8, 2.0 * drag)).is_stable(), stable, "half of twice as much");
        last = stable;
    }
    assert!(verdict(&all, &dragging(0.8, 0.004)).is_stable() && !last);
}

/// What is held with all of the drag either way is held with every part of it.
#[test]
fn parts_of_a_drag_are_held_where_all_of_it_is() {
    let settings = HoldingSettings { drag: 1.0, max_normal_force: Some(10.0), ..Default::default() };
    let test = test_with(settings);
    let press = regrasp_physics::Press { max_normal_force: Some(10.0), effort_share: 0.95 };
    let (mass, p_OCm) = (0.1, Vec3::zeros());
    let load = regrasp_physics::HeldLoad { mass, p_OCm, length: 0.03, disturbance: (0.0, 0.0), press };
    let mut random = Random::from_key(9, 0, 0, 0);
    let mut held = 0;
    for _ in 0..300 {
        let grasp = dragging(random.range(0.2, 1.0), random.range(0.0, 0.03));
        if !verdict(&test, &grasp).is_stable() {
            continue;
        }
        held += 1;
        let parts: Vec<f64> = (0..3).map(|_| random.range(-1.0, 1.0)).collect();
        let bearings = load.bearings(&grasp, None, (0.95, 0.95), |i| parts[i]).unwrap();
        assert!(load.held(&bearings, &grasp.g_O, 1.0, &mut Hint::default()).holds, "{grasp:?} {parts:?}");
    }
    assert!((50..290).contains(&held), "both are common: {held}");
}
