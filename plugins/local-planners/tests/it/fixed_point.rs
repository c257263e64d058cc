//! Transfers with contact points that stay put: where the tips are, what stops them, which hands are refused.
use crate::support;

use regrasp_api::*;
use regrasp_local_planners::{FixedPoint, FixedPointSettings};
use support::{Bench, context, geometry};

fn points(mut hand: HandDescription) -> HandDescription {
    hand.fingertip = Fingertip::Point;
    hand
}

fn carry(bench: &Bench, from: &Configuration, to: &Pose, path: Option<&mut Path>) -> Reached {
    let planner = FixedPoint::new(FixedPointSettings::default(), &*bench.hand).unwrap();
    planner.connect(&bench.task(), from, &Target::Transfer(to), path, &mut context(1)).unwrap()
}

/// The most (m) that a holding tip's centre strays from its place on the object, looked at ten times between
/// states.
fn stray(bench: &Bench, path: &Path) -> f64 {
    let mut worst: f64 = 0.0;
    for pair in path.states.windows(2) {
        for finger in pair[0].holding().iter() {
            let place = path.states[0].contacts[finger].unwrap().tip_center(bench.radius());
            for i in 0..=10 {
                let s = f64::from(i) / 10.0;
                let joints = pair[0].joints[finger].interpolate(&pair[1].joints[finger], s);
                let X_HO = interpolate(&pair[0].X_HO, &pair[1].X_HO, s);
                let p_OF = geometry::to_object(&X_HO, &bench.hand.tip_center(finger, &joints));
                worst = worst.max((p_OF - place).norm());
            }
        }
    }
    worst
}

#[test]
fn random_transfers_keep_their_contacts_and_half_of_every_tolerance() {
    for object in [support::sphere(), support::cube(), support::ring()] {
        for hand in [support::four_finger(), support::free_tips(), support::redundant()] {
            let bench = Bench::new(points(hand), object.clone());
            let (mut random, mut moved) = (Random::from_key(3, 1, 4, 2), 0.0);
            for _ in 0..8 {
                let from = support::grasp(&bench, &mut random);
                let to = support::nearby(&from.X_HO, &mut random, 0.005, 0.6);
                let mut path = Path::default();
                let reached = carry(&bench, &from, &to, Some(&mut path));
                assert_eq!(carry(&bench, &from, &to, None), reached, "storing must not change the motion");
                assert_eq!((&path.states[0], path.states.last()), (&from, Some(&reached.end)));
                assert_eq!(reached.is_complete(), reached.fraction == 1.0);
                assert!(!reached.is_complete() || reached.end.X_HO == to);
                assert!(path.states.iter().all(|q| q.contacts == from.contacts));
                assert!(stray(&bench, &path) <= 10e-6 * 1.05, "{}", stray(&bench, &path));
                moved += reached.fraction;
            }
            assert!(moved > 2.0, "hardly anything moved ({moved})");
        }
    }
}

/// Four tips around the equator (x, y, -x, -y), holding the object by glue.
fn around_the_equator(hand: HandDescription, object: ObjectModel, X_HO: &Pose) -> (Bench, Configuration) {
    let mut bench = Bench::new(points(hand), object);
    bench.stability = Box::new(support::Glue);
    let axes = [Vec3::x(), Vec3::y(), -Vec3::x(), -Vec3::y()];
    let q = support::touching_along(&bench, X_HO, &axes);
    (bench, q)
}

#[test]
fn tips_ride_on_the_object_through_half_a_turn() {
    let (bench, from) = around_the_equator(support::free_tips(), support::sphere(), &Pose::identity());
    let to = Pose::translation(0.0, 0.01, 0.0) * Rotation::from_scaled_axis(Vec3::z() * 3.1);
    let mut path = Path::default();
    let reached = carry(&bench, &from, &to, Some(&mut path));
    assert!(reached.is_complete(), "{:?}", reached.stop);
    for (finger, contact) in from.contacts.iter() {
        // The joints of a free tip are its centre's coordinates: to · (p + r n).
        let center = geometry::to_hand(&to, &contact.unwrap().tip_center(bench.radius()));
        let joints = Vec3::from_row_slice(&reached.end.joints[finger]);
        assert!((joints - center).norm() < 1e-9, "{joints} {center}");
    }
    assert!(path.states.len() > 100, "1.5° a step");
}

#[test]
fn what_stops_a_transfer_has_its_reason() {
    let X_HO = Pose::translation(0.0, 0.0, 0.085);
    let (bench, from) = around_the_equator(support::four_finger(), support::sphere(), &X_HO);
    let far = Pose::translation(0.0, 0.0, 0.3);
    let reached = carry(&bench, &from, &far, None);
    assert!(matches!(reached.stop, Some(Reason::Reach | Reason::Limits)), "{:?}", reached.stop);
    assert!(0.0 < reached.fraction && reached.fraction < 1.0);
    let down = carry(&bench, &from, &Pose::translation(0.0, 0.0, 0.02), None);
    assert!(matches!(down.stop, Some(Reason::Collision | Reason::Limits)), "{:?}", down.stop);
    let mut lone = from.clone();
    (1..4).for_each(|finger| lone.contacts[FingerIndex(finger)] = None);
    let bench = Bench::new(points(support::four_finger()), support::sphere());
    let reached = carry(&bench, &lone, &Pose::translation(0.0, 0.0, 0.08), None);
    assert_eq!((reached.stop, reached.fraction), (Some(Reason::Stability), 0.0));
}

#[test]
fn balls_and_points_are_for_one_transfer_planner_each() {
    let build = |id: &str, hand: HandDescription| {
        let bench = Bench::new(hand, support::sphere());
        let parts = Parts::new(&bench.object, &*bench.hand);
        let entry = inventory::iter::<Entry>.into_iter().find(|entry| entry.id == id).unwrap();
        let Build::LocalPlanner(build) = entry.build else { panic!("another role") };
        build("", &parts).map(drop)
    };
    for (id, other, ball) in [
        ("local-planner/rolling", "local-planner/fixed-point", true),
        ("local-planner/fixed-point", "local-planner/rolling", false),
    ] {
        let (balls, tips) = (support::four_finger(), points(support::four_finger()));
        let (mine, wrong) = if ball { (balls, tips) } else { (tips, balls) };
        build(id, mine).unwrap();
        let error = build(id, wrong).unwrap_err();
        assert!(matches!(&error, BuildError::Unsupported(text) if text.contains(other)), "{error}");
    }
}

#[test]
fn other_targets_and_bad_settings_are_refused() {
    let bench = Bench::new(points(support::four_finger()), support::sphere());
    let from = support::grasp(&bench, &mut Random::from_key(1, 0, 0, 0));
    let planner = FixedPoint::new(FixedPointSettings::default(), &*bench.hand).unwrap();
    let wrong = planner.connect(&bench.task(), &from, &Target::Grasp(&from), None, &mut context(1));
    assert!(matches!(wrong, Err(CallError::Unsupported { .. })));
    let bad = FixedPointSettings { tolerance_share: 0.0, ..Default::default() };
    assert!(FixedPoint::new(bad, &*bench.hand).is_err());
}
