//! Transfers: closed forms, and the path's meaning checked at ten times its resolution.
use crate::support;

use regrasp_api::*;
use regrasp_local_planners::{Rolling, RollingSettings};
use support::{check, context};

fn roll(bench: &support::Bench, from: &Configuration, to: &Pose, path: Option<&mut Path>) -> Reached {
    let rolling = Rolling::new(RollingSettings::default(), &*bench.hand).unwrap();
    rolling.connect(&bench.task(), from, &Target::Transfer(to), path, &mut context(1)).unwrap()
}

/// A path's ends, steps, closure, normals and slip.
fn assert_means_rolling(
    bench: &support::Bench,
    from: &Configuration,
    to: &Pose,
) -> (Reached, check::Transfer) {
    let mut path = Path::default();
    let reached = roll(bench, from, to, Some(&mut path));
    assert_eq!(path.states[0], *from);
    assert_eq!(path.states.last(), Some(&reached.end));
    assert_eq!(reached.fraction == 1.0, reached.is_complete());
    if reached.is_complete() {
        assert_eq!(reached.end.X_HO, *to);
    }
    assert_eq!(roll(bench, from, to, None), reached, "storing must not change the motion");
    let worst = check::transfer(bench, &path);
    assert!(worst.closure <= 10e-6 * 1.05, "{worst:?}");
    assert!(worst.slip <= 50e-6 * 1.05, "{worst:?}");
    assert!(worst.normal < 1e-6, "{worst:?}");
    assert!(worst.jump <= LONGEST_JUMP * bench.radius(), "{worst:?}");
    assert!(worst.step < 1.3e-3, "{worst:?}");
    (reached, worst)
}

fn shapes() -> [(&'static str, ObjectModel); 4] {
    [
        ("sphere", support::sphere()),
        ("cube", support::cube()),
        ("ellipsoid", support::ellipsoid()),
        ("ring", support::ring()),
    ]
}

#[test]
fn random_transfers_keep_half_of_every_tolerance() {
    for (name, object) in shapes() {
        for hand in [support::four_finger(), support::free_tips(), support::redundant()] {
            let bench = support::Bench::new(hand, object.clone());
            let (mut random, mut moved) = (Random::from_key(3, 1, 4, 1), 0.0);
            for _ in 0..8 {
                let from = support::grasp(&bench, &mut random);
                let to = support::nearby(&from.X_HO, &mut random, 0.005, 0.6);
                let (reached, _) = assert_means_rolling(&bench, &from, &to);
                moved += reached.fraction;
            }
            assert!(moved > 1.0, "{name}: hardly anything moved ({moved})");
        }
    }
}

/// A ring's inner side is concave one way and convex the other: the ball touches two facets at once there,
/// and its contact goes over to the other.
#[test]
fn contacts_on_a_ring_go_over_from_facet_to_facet() {
    let bench = support::Bench::new(support::four_finger(), support::ring());
    let (mut random, mut over, mut moved) = (Random::from_key(8, 1, 0, 0), 0, 0.0);
    for _ in 0..60 {
        let from = support::grasp(&bench, &mut random);
        let to = support::nearby(&from.X_HO, &mut random, 0.005, 0.6);
        let (reached, worst) = assert_means_rolling(&bench, &from, &to);
        over += usize::from(worst.jump > bench.tolerances.closure);
        moved += reached.fraction;
    }
    assert!(over > 0 && moved > 5.0, "{over} transfers over a concave edge, {moved} in all");
}

/// A ring of few facets bends too sharply inside: the two places that the ball touches at once are far from
/// each other, and rolling ends.
#[test]
fn contacts_do_not_jump_over_sharp_dents() {
    let bench = support::Bench::new(support::four_finger(), support::sharp_ring());
    let (mut random, mut lost) = (Random::from_key(8, 1, 0, 0), 0);
    for _ in 0..60 {
        let from = support::grasp(&bench, &mut random);
        let to = support::nearby(&from.X_HO, &mut random, 0.005, 0.6);
        let (reached, worst) = assert_means_rolling(&bench, &from, &to);
        lost += usize::from(reached.stop == Some(Reason::Closure) && worst.jump < 1e-5);
    }
    assert!(lost > 0, "no contact came to a dent");
}

/// Four free tips around the object's equator (x, y, -x, -y), holding it by glue.
fn around_the_equator(object: ObjectModel) -> (support::Bench, Configuration) {
    let mut bench = support::Bench::new(support::free_tips(), object);
    bench.stability = Box::new(support::Glue);
    let axes = [Vec3::x(), Vec3::y(), -Vec3::x(), -Vec3::y()];
    let q = support::touching_along(&bench, &Pose::identity(), &axes);
    (bench, q)
}

#[test]
fn tips_that_do_not_turn_roll_their_own_arc_on_flat_faces() {
    // In O the tip turns by -φ about z: its centre moves by -φ z × r n.
    let (bench, from) = around_the_equator(support::cube());
    let angle = 0.7;
    let to = Pose::rotation(Vec3::z() * angle);
    let (reached, worst) = assert_means_rolling(&bench, &from, &to);
    assert!(reached.is_complete());
    for (finger, contact) in reached.end.contacts.iter() {
        let (a, b) = (from.contacts[finger].unwrap(), contact.unwrap());
        let expected = a.p_OC - Vec3::z().cross(&a.n_O) * (bench.radius() * angle);
        assert!((b.p_OC - expected).norm() < 1e-6, "{:e}", (b.p_OC - expected).norm());
        assert!((worst.rolled[finger.index()] - bench.radius() * angle).abs() < 1e-5);
    }
}

#[test]
fn tips_that_do_not_turn_roll_on_a_sphere_by_the_ratio_of_the_radii() {
    // (R + r) n' = r w × n: the contact moves on the sphere by R r φ / (R + r).
    let fine = support::object("{ kind = \"sphere\", radius = 0.03, facets = 20480 }");
    let (bench, from) = around_the_equator(fine);
    let (angle, mut path) = (0.9, Path::default());
    assert!(roll(&bench, &from, &Pose::rotation(Vec3::z() * angle), Some(&mut path)).is_complete());
    let expected = 0.03 * 0.01 / 0.04 * angle;
    for finger in from.holding().iter() {
        let places = path.states.iter().map(|q| q.contacts[finger].unwrap().p_OC).collect::<Vec<_>>();
        let length: f64 = places.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        assert!((length / expected - 1.0).abs() < 0.015, "{length} {expected}");
    }
}

#[test]
fn an_object_that_does_not_turn_keeps_its_contacts() {
    let (bench, from) = around_the_equator(support::ellipsoid());
    let to = Pose::translation(0.02, -0.01, 0.03);
    let (reached, worst) = assert_means_rolling(&bench, &from, &to);
    assert!(reached.is_complete());
    for (finger, contact) in reached.end.contacts.iter() {
        assert!((contact.unwrap().p_OC - from.contacts[finger].unwrap().p_OC).norm() < 1e-9);
    }
    assert!(worst.slip < 1e-9);
}

#[test]
fn on_an_edge_the_normal_turns_and_the_point_stays() {
    // A quarter turn rolls 15.7 mm on a face of 10 mm: past the edge, where 45 mm faces give 12.5 mm away
    // from it.
    let (bench, from) =
        around_the_equator(support::object("{ kind = \"cuboid\", size = [0.02, 0.02, 0.06] }"));
    let angle = 1.5;
    let mut path = Path::default();
    let to = Pose::rotation(Vec3::z() * angle);
    let reached = roll(&bench, &from, &to, Some(&mut path));
    assert_means_rolling(&bench, &from, &to);
    // 10 mm of face to the edge take 1 rad; the rest turns the normal.
    assert!(reached.is_complete(), "{:?}", reached.stop);
    for (finger, contact) in reached.end.contacts.iter() {
        let (a, b) = (from.contacts[finger].unwrap(), contact.unwrap());
        let edge = a.p_OC - Vec3::z().cross(&a.n_O) * 0.01;
        assert!((b.p_OC - edge).norm() < 1e-6);
        let turned = a.n_O.dot(&b.n_O).acos();
        assert!((turned - (angle - 1.0)).abs() < 1e-4, "{turned}");
    }
}

#[test]
fn rolling_back_returns_to_the_start() {
    for (_, object) in shapes() {
        let bench = support::Bench::new(support::four_finger(), object);
        let mut random = Random::from_key(9, 0, 0, 0);
        for _ in 0..5 {
            let from = support::grasp(&bench, &mut random);
            let to = support::nearby(&from.X_HO, &mut random, 0.003, 0.3);
            let there = roll(&bench, &from, &to, None);
            if !there.is_complete() {
                continue;
            }
            let back = roll(&bench, &there.end, &from.X_HO, None);
            assert!(back.is_complete(), "{:?}", back.stop);
            for (finger, contact) in back.end.contacts.iter() {
                let off = (contact.unwrap().p_OC - from.contacts[finger].unwrap().p_OC).norm();
                assert!(off < 2e-5, "{off:e}");
            }
        }
    }
}

#[test]
fn net_slip_is_seen_and_bounded() {
    let mut bench = support::Bench::new(support::four_finger(), support::ellipsoid());
    // Coarse steps, so that there is something to see.
    bench.tolerances = Tolerances { slip: 6e-6, closure: 2e-4, ..bench.tolerances };
    bench.resolution.transfer_turn = 4f64.to_radians();
    bench.resolution.transfer_step = 3e-3;
    let (mut random, mut stopped) = (Random::from_key(4, 0, 0, 0), 0);
    for _ in 0..10 {
        let from = support::grasp(&bench, &mut random);
        let to = support::nearby(&from.X_HO, &mut random, 0.005, 0.8);
        let mut path = Path::default();
        let reached = roll(&bench, &from, &to, Some(&mut path));
        let slip = check::transfer(&bench, &path).slip_at_states;
        assert!(slip < 3.6e-6, "{slip:e}");
        if reached.stop == Some(Reason::Slip) {
            stopped += 1;
        }
    }
    assert!(stopped > 2, "{stopped}");
}

#[test]
fn it_stops_at_the_limits_with_the_reason_counted() {
    let (bench, from) = around_the_equator(support::sphere());
    let rolling = Rolling::new(RollingSettings::default(), &*bench.hand).unwrap();
    let (mut context, to) = (context(1), Pose::translation(0.2, 0.0, 0.0));
    let reached = rolling.connect(&bench.task(), &from, &Target::Transfer(&to), None, &mut context).unwrap();
    // The foremost tip is 40 mm ahead of the centre and may go to 150 mm.
    assert_eq!(reached.stop, Some(Reason::Limits));
    assert!((reached.end.X_HO.translation.vector.x - 0.11).abs() < 1.5e-3);
    assert_eq!(context.tally.rejections(Slot::TransferPlanner, Reason::Limits), 1);
}

#[test]
fn a_target_where_it_is_already_needs_no_step() {
    let (bench, from) = around_the_equator(support::sphere());
    let mut path = Path::default();
    let reached = roll(&bench, &from, &from.X_HO, Some(&mut path));
    assert_eq!((reached.end, reached.fraction, reached.stop, path.states.len()), (from, 1.0, None, 1));
}

#[test]
fn other_targets_and_bad_settings_are_refused() {
    let (bench, from) = around_the_equator(support::sphere());
    let rolling = Rolling::new(RollingSettings::default(), &*bench.hand).unwrap();
    let answer = rolling.connect(&bench.task(), &from, &Target::Grasp(&from), None, &mut context(1));
    assert!(matches!(answer, Err(CallError::Unsupported { .. })), "{answer:?}");
    let settings = RollingSettings { tolerance_share: 1.5, ..RollingSettings::default() };
    let message = Rolling::new(settings, &*bench.hand).unwrap_err().to_string();
    assert!(message.contains("tolerance_share") && message.contains("0.01..=1"), "{message}");
}
