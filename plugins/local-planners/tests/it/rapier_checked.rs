//! Transfers that are simulated: what is accepted, what is refused and why.
use crate::support;

use regrasp_api::*;
use regrasp_contact_models::{SoftFinger, SoftFingerSettings};
use regrasp_local_planners::{RapierChecked, RapierCheckedSettings, Rolling, RollingSettings};
use support::{Bench, context};

fn checked(bench: &Bench, settings: RapierCheckedSettings) -> RapierChecked {
    RapierChecked::new(settings, &Parts::new(&bench.object, &*bench.hand)).unwrap()
}

fn heavy_task(bench: &Bench) -> Task<'_> {
    Task { g_H: Vec3::new(0.0, 0.0, -9.81), ..bench.task() }
}

/// Transfers that rolling makes: start, goal and where it ends.
fn transfers(bench: &Bench, count: usize) -> Vec<(Configuration, Pose, Reached)> {
    let mut random = Random::from_key(17, 0, 0, 0);
    let rolling = Rolling::new(RollingSettings::default(), &*bench.hand).unwrap();
    let mut all = Vec::new();
    while all.len() < count {
        let from = support::grasp(bench, &mut random);
        let to = support::nearby(&from.X_HO, &mut random, 0.008, 0.8);
        let reached = rolling
            .connect(&heavy_task(bench), &from, &Target::Transfer(&to), None, &mut context(1))
            .unwrap();
        if reached.fraction > 0.1 {
            all.push((from, to, reached));
        }
    }
    all
}

fn connect(
    bench: &Bench,
    planner: &RapierChecked,
    from: &Configuration,
    to: &Pose,
) -> (Reached, Path, Context<'static>) {
    let (mut path, mut context) = (Path::default(), context(1));
    let target = Target::Transfer(to);
    let reached = planner.connect(&heavy_task(bench), from, &target, Some(&mut path), &mut context).unwrap();
    (reached, path, context)
}

fn benches() -> [(&'static str, Bench); 3] {
    [("sphere", support::sphere()), ("cube", support::cube()), ("ellipsoid", support::ellipsoid())]
        .map(|(name, object)| (name, Bench::new(support::four_finger(), object)))
}

#[test]
fn what_rolls_is_accepted_at_the_objects_own_friction_and_mass() {
    for (name, bench) in benches() {
        let planner = checked(&bench, RapierCheckedSettings::default());
        let all = transfers(&bench, 8);
        let same = all.iter().filter(|(from, to, rolled)| connect(&bench, &planner, from, to).0 == *rolled);
        let same = same.count();
        assert!(same >= 7, "{name}: {same} of {}", all.len());
    }
}

#[test]
fn the_same_motion_is_refused_where_friction_is_far_lower_or_the_object_far_heavier() {
    let slippery = RapierCheckedSettings { friction: Some(0.05), ..Default::default() };
    let heavy = RapierCheckedSettings { mass: Some(10.0), ..Default::default() };
    for (name, bench) in benches() {
        for settings in [slippery, heavy] {
            let planner = checked(&bench, settings);
            for (from, to, rolled) in transfers(&bench, 4) {
                let (reached, path, context) = connect(&bench, &planner, &from, &to);
                let stop = reached.stop.expect("it cannot be held");
                assert!(matches!(stop, Reason::Stray | Reason::Slip), "{name}: {stop:?}");
                assert_eq!((reached.fraction, path.states.len()), (0.0, 1), "{name} {settings:?}");
                assert_eq!(reached.end, from);
                assert_eq!(context.tally.rejections(Slot::TransferPlanner, stop), 1);
                assert!(rolled.fraction > 0.1);
            }
        }
    }
}

#[test]
fn an_object_that_no_allowed_force_holds_is_refused_as_unstable() {
    let (_, mut bench) = benches().into_iter().next().unwrap();
    let all = transfers(&bench, 2);
    // 100 N on four fingers whose joints give 1 N·m.
    bench.object.mass = 10.0;
    let planner = checked(&bench, RapierCheckedSettings::default());
    for (from, to, _) in all {
        assert_eq!(connect(&bench, &planner, &from, &to).0.stop, Some(Reason::Stability));
    }
}

#[test]
fn a_motion_that_fails_late_is_cut_to_what_was_simulated() {
    let (_, bench) = benches().into_iter().next().unwrap();
    // A bound that a long motion exceeds in the end and half of it does not.
    let mut cut = 0;
    for (from, to, rolled) in transfers(&bench, 12) {
        for max_slip in [1.5e-5, 2.5e-5, 3.5e-5, 5e-5] {
            let settings = RapierCheckedSettings { max_slip, retries: 4, ..Default::default() };
            let (reached, path, _) = connect(&bench, &checked(&bench, settings), &from, &to);
            assert_eq!(path.states[0], from);
            assert_eq!(path.states.last(), Some(&reached.end));
            assert_eq!(reached.is_complete(), reached.fraction == 1.0);
            assert!(reached.fraction <= rolled.fraction);
            let there = interpolate(&from.X_HO, &to, reached.fraction);
            assert!((there.translation.vector - reached.end.X_HO.translation.vector).norm() < 1e-9);
            assert!(angle_between(&there.rotation, &reached.end.X_HO.rotation) < 1e-7);
            cut += usize::from(reached.stop == Some(Reason::Slip) && reached.fraction > 0.0);
        }
    }
    assert!(cut > 0, "no motion was cut: the test shows nothing");
}

#[test]
fn equal_arguments_give_equal_bits_with_or_without_a_path() {
    let (_, bench) = benches().into_iter().nth(2).unwrap();
    let planner = checked(&bench, RapierCheckedSettings::default());
    for (from, to, _) in transfers(&bench, 3) {
        let (reached, path, _) = connect(&bench, &planner, &from, &to);
        let again = connect(&bench, &checked(&bench, RapierCheckedSettings::default()), &from, &to);
        assert_eq!((&reached, &path), (&again.0, &again.1));
        let target = Target::Transfer(&to);
        let without = planner.connect(&heavy_task(&bench), &from, &target, None, &mut context(9)).unwrap();
        assert_eq!(reached, without);
    }
}

#[test]
fn contacts_that_count_on_torsion_are_refused_with_that_reason() {
    let (_, bench) = benches().into_iter().next().unwrap();
    let soft = SoftFinger::new(SoftFingerSettings::default()).unwrap();
    let task = Task { contact_model: &soft, ..heavy_task(&bench) };
    let (from, to, _) = transfers(&bench, 1).pop().unwrap();
    let planner = checked(&bench, RapierCheckedSettings::default());
    let error = planner.connect(&task, &from, &Target::Transfer(&to), None, &mut context(1)).unwrap_err();
    assert!(
        matches!(error, CallError::Unsupported { .. }) && error.to_string().contains("torsion"),
        "{error}"
    );
}

#[test]
fn settings_outside_their_ranges_are_refused() {
    for json in [
        r#"{"max_distance": 0}"#,
        r#"{"friction": -0.1}"#,
        r#"{"time_step": 0.1}"#,
        r#"{"speed": 0}"#,
        r#"{"mass": 0}"#,
        r#"{"rolling": {"halvings": 21}}"#,
        r#"{"unknown": 1}"#,
    ] {
        assert!(RapierCheckedSettings::from_json(json).is_err(), "{json}");
    }
    assert!(RapierCheckedSettings::from_json(r#"{"mass": 0.2, "friction": null}"#).is_ok());
}

#[test]
fn free_fingertips_on_slides_carry_too() {
    let mut hand = support::free_tips();
    hand.finger.iter_mut().flat_map(|finger| &mut finger.joint).for_each(|joint| {
        (joint.effort, joint.velocity) = (10.0, 0.3);
    });
    let bench = Bench::new(hand, support::cube());
    let planner = checked(&bench, RapierCheckedSettings::default());
    let all = transfers(&bench, 6);
    let same =
        all.iter().filter(|(from, to, rolled)| connect(&bench, &planner, from, to).0 == *rolled).count();
    assert!(same >= 5, "{same} of {}", all.len());
}
