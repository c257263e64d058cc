//! What tells the samplers apart, with hands and objects of several kinds.
use proptest::prelude::*;
use regrasp_api::*;
use regrasp_conformance::fixtures::{Bench, four_finger};
use regrasp_samplers::*;
use std::sync::OnceLock;

fn context(key: u64) -> Context<'static> {
    Context::new(Random::from_key(key, 0, 0, 0), &Uninterrupted)
}

fn all_by_default() -> [(&'static str, Box<dyn ClosedChainSampler>); 3] {
    [
        ("rlg", Box::new(Rlg::new(Default::default()).unwrap())),
        ("projection", Box::new(ProjectionSampler::new(Default::default()).unwrap())),
        ("grasp-first", Box::new(GraspFirst::new(Default::default()).unwrap())),
    ]
}

/// Four fingers with one joint to spare each: the last link bends once more.
fn redundant() -> &'static Bench {
    static BENCH: OnceLock<Bench> = OnceLock::new();
    BENCH.get_or_init(|| {
        let mut hand = four_finger();
        for finger in &mut hand.finger {
            let mut last = finger.joint[2].clone();
            last.name += "-tip";
            (last.lower, last.upper) = (-0.4, 0.8);
            last.origin.position = [0.0, 0.0, 0.03];
            last.link.clear();
            finger.joint.push(last);
            finger.tip = [0.0, 0.0, 0.02];
            finger.rest.push(0.1);
        }
        Bench::new(hand, ObjectShape::Sphere { radius: 0.03, facets: 320 }, Vec::new())
    })
}

/// Distance (m) of each holding fingertip from where its contact wants it.
fn gaps(bench: &Bench, q: &Configuration) -> Vec<f64> {
    let hand = &bench.world.hand;
    let gap = |finger| {
        let wanted = q.contact_tip_center(finger, bench.radius()).unwrap();
        (hand.tip_center(finger, &q.joints[finger]) - wanted).norm()
    };
    q.holding().iter().map(gap).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..Default::default() })]

    #[test]
    fn samples_close_within_limits_whatever_hand_and_object(seed in 0..1_000_000_u64) {
        for bench in [Bench::free_cube(), Bench::hand_ellipsoid(), redundant()] {
            for (name, sampler) in all_by_default() {
                let task = bench.task();
                let found = sampler.sample(&task, PoseRequest::Anywhere, FingerSet::first(4), &mut context(seed)).unwrap();
                let Some(q) = found else { continue };
                prop_assert!(gaps(bench, &q).into_iter().all(|gap| gap < 1e-9), "{}: \
                    {:?}", name, gaps(bench, &q));
                prop_assert!(q.joints.iter().all(|(finger, joints)| task.hand.within_limits(finger, joints)));
                prop_assert_eq!(task.admissible.admit(&task, &q, &mut context(0)).unwrap(), None);
                // Closing what was sampled gives the same joints back.
                let again = sampler.close(&task, &q.X_HO, &q.contacts, &q, &mut context(0)).unwrap().unwrap();
                for (finger, joints) in q.joints.iter() {
                    prop_assert!(joints.max_difference(&again.joints[finger]) < 1e-6, "{}", name);
                }
            }
        }
    }

    #[test]
    fn samples_near_a_configuration_stay_near(seed in 0..1_000_000_u64, radius in 0.0..0.01, angle in 0.0..1.0) {
        let bench = Bench::hand_sphere();
        let task = bench.task();
        let at = PoseRequest::At(Bench::center());
        let rlg = Rlg::new(Default::default()).unwrap();
        let near = rlg.sample(&task, at, FingerSet::first(4), &mut context(seed)).unwrap().unwrap();
        for (name, sampler) in all_by_default() {
            let request = PoseRequest::Near { configuration: &near, radius, angle };
            let found = sampler.sample(&task, request, FingerSet::first(4), &mut context(seed)).unwrap();
            let Some(q) = found else { continue };
            let moved = (q.X_HO.translation.vector - near.X_HO.translation.vector).norm();
            let turned = angle_between(&q.X_HO.rotation, &near.X_HO.rotation);
            prop_assert!(moved <= radius + 1e-12 && turned <= angle + 1e-9, "{}: {} m, {} \
                rad", name, moved, turned);
        }
    }
}

#[test]
fn every_sampler_finds_most_of_what_there_is() {
    for bench in [Bench::hand_sphere(), Bench::free_cube(), redundant()] {
        for (name, sampler) in all_by_default() {
            let mut found = 0;
            for key in 0..10 {
                let request =
                    if key % 2 == 0 { PoseRequest::Anywhere } else { PoseRequest::At(Bench::center()) };
                let q =
                    sampler.sample(&bench.task(), request, FingerSet::first(4), &mut context(key)).unwrap();
                found += usize::from(q.is_some());
            }
            assert!(found >= 8, "{name}: {found} of 10");
        }
    }
}

#[test]
fn spare_joints_are_sampled() {
    for (name, sampler) in all_by_default() {
        let bench = redundant();
        let posture = |key| {
            let request = PoseRequest::At(Bench::center());
            let q = sampler.sample(&bench.task(), request, FingerSet::first(4), &mut context(key)).unwrap();
            q.map(|q| q.joints[FingerIndex(0)])
        };
        let spare = bench.task().hand.finger(FingerIndex(0)).spare[0];
        let values: Vec<f64> = (0..20).filter_map(posture).map(|joints| joints[spare]).collect();
        let (low, high) =
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
        assert!(values.len() > 10 && high - low > 0.4, "{name}: {values:?}");
    }
}

#[test]
fn poses_are_drawn_near_the_motion_as_often_as_the_settings_say() {
    // From upright to a quarter turn about the vertical.
    let bench = Bench::free_sphere();
    let quarter = Pose::from_parts(
        Bench::center().translation,
        Rotation::from_scaled_axis(Vec3::z() * std::f64::consts::FRAC_PI_2),
    );
    let landmarks = [Bench::center(), quarter];
    let task = Task { landmarks: &landmarks, ..bench.task() };
    let off_the_motion = |q: &Configuration| {
        (0..=90)
            .map(|i| slerp(&landmarks[0].rotation, &quarter.rotation, f64::from(i) / 90.0))
            .map(|R| angle_between(&R, &q.X_HO.rotation))
            .fold(f64::INFINITY, f64::min)
    };
    for (anywhere, low, high) in [(0.0, 0, 0), (1.0, 70, 100)] {
        let rlg = Rlg::new(RlgSettings { anywhere, spread_deg: 20.0, ..Default::default() }).unwrap();
        let far = (0..100).filter(|&key| {
            let found =
                rlg.sample(&task, PoseRequest::Anywhere, FingerSet::first(4), &mut context(key)).unwrap();
            off_the_motion(&found.expect("free fingertips hold a ball anywhere")) > 20.5_f64.to_radians()
        });
        let far = far.count();
        assert!((low..=high).contains(&far), "{far} of 100 far from the motion with anywhere = {anywhere}");
    }
}

#[test]
fn a_try_is_counted_with_its_reason() {
    // At a pose out of reach each try fails, and each is counted once.
    let far = PoseRequest::At(Pose::translation(0.0, 0.0, 0.5));
    let samplers: [Box<dyn ClosedChainSampler>; 3] = [
        Box::new(Rlg::new(RlgSettings { poses: 7, ..Default::default() }).unwrap()),
        Box::new(ProjectionSampler::new(ProjectionSettings { starts: 7, ..Default::default() }).unwrap()),
        Box::new(GraspFirst::new(GraspFirstSettings { grasps: 7, ..Default::default() }).unwrap()),
    ];
    for sampler in samplers {
        let mut context = context(1);
        let found =
            sampler.sample(&Bench::hand_sphere().task(), far, FingerSet::first(4), &mut context).unwrap();
        assert!(found.is_none());
        let count: u64 = Reason::ALL.iter().map(|&r| context.tally.rejections(Slot::Sampler, r)).sum();
        assert_eq!((count, context.tally.calls(Slot::Sampler)), (7, 1));
    }
}

#[test]
fn settings_are_refused_beyond_their_ranges() {
    let range = |key: &str, error: SettingsError| {
        let SettingsError::Departs(departure) = error else { panic!("{error}") };
        assert_eq!(departure.path.to_string(), key);
        // What is not a number is none as JSON either: a fault of type.
        assert!(matches!(departure.fault, Fault::Range { .. } | Fault::Type { .. }), "{departure}");
    };
    range("poses", RlgSettings { poses: 0, ..Default::default() }.validate().unwrap_err());
    range("contacts", RlgSettings { contacts: 10_001, ..Default::default() }.validate().unwrap_err());
    range("steps", ProjectionSettings { steps: 0, ..Default::default() }.validate().unwrap_err());
    range("draws", ProjectionSettings { draws: 0, ..Default::default() }.validate().unwrap_err());
    range("near", ProjectionSettings { near: 1.1, ..Default::default() }.validate().unwrap_err());
    range("grasps", GraspFirstSettings { grasps: 0, ..Default::default() }.validate().unwrap_err());
    range(
        "spread_deg",
        GraspFirstSettings { spread_deg: f64::NAN, ..Default::default() }.validate().unwrap_err(),
    );
    assert!(GraspFirst::new(GraspFirstSettings { poses: 0, ..Default::default() }).is_err());
}
