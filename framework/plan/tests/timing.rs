//! Times keep the limits of every joint, with an own evaluation of the definition.

mod common;

use common::*;
use proptest::prelude::*;
use regrasp_api::*;
use regrasp_plan::*;

/// All states once, with their times.
fn flat(motion: &Motion) -> (Vec<Vec<f64>>, Vec<f64>) {
    let (mut joints, mut times) = (Vec::new(), Vec::new());
    for (s, segment) in motion.segments.iter().enumerate() {
        for (k, q) in segment.states.iter().enumerate() {
            if s > 0 && k == 0 {
                assert_eq!(segment.times[0], *times.last().unwrap(), "shared states share their time");
                continue;
            }
            joints.push(q.joints.iter().flat_map(|(_, joints)| joints.to_vec()).collect());
            times.push(segment.times[k]);
        }
    }
    (joints, times)
}

/// Largest velocity and acceleration as fractions of their limits; panics where times do not increase.
fn utilisation(motion: &Motion, hand: &dyn Hand) -> (f64, f64) {
    let (q, t) = flat(motion);
    let (mut velocity, mut acceleration) = (0.0_f64, 0.0_f64);
    let models: Vec<_> =
        (0..hand.finger_count() as u8).map(|f| &hand.finger(FingerIndex(f)).joints).collect();
    for (j, model) in models.into_iter().flatten().enumerate() {
        let v = |k: usize| (q[k + 1][j] - q[k][j]) / (t[k + 1] - t[k]);
        for k in 0..q.len() {
            if k + 1 < q.len() {
                assert!(t[k + 1] > t[k], "times increase");
                velocity = velocity.max(v(k).abs() / model.velocity);
            }
            let (before, from) = if k > 0 { (v(k - 1), t[k - 1]) } else { (0.0, t[k]) };
            let (after, to) = if k + 1 < q.len() { (v(k), t[k + 1]) } else { (0.0, t[k]) };
            acceleration = acceleration.max(2.0 * (after - before).abs() / (to - from) / model.acceleration);
        }
    }
    (velocity, acceleration)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn random_motions_keep_every_limit(seed in 0_u64..1_000_000, states in 2_usize..60,
                                       velocity in 0.05_f64..5.0, acceleration in 0.05_f64..50.0) {
        let hand = Fingertips::new(3, velocity, acceleration);
        let mut motion = walk(seed, 3, states);
        assign_times(&mut motion, &hand, &TimingLimits::default()).unwrap();
        let (v, a) = utilisation(&motion, &hand);
        prop_assert!(v <= 1.0 && a <= 1.0, "{v} {a}");
    }
}

/// One joint moves from 0 to `distance` in equal steps.
fn straight(distance: f64, steps: usize) -> Motion {
    let mut q = state(&mut Random::from_key(1, 1, 1, 1), 1);
    q.joints[FingerIndex(0)].fill(0.0);
    let at = |k: usize| {
        let mut q = q.clone();
        q.joints[FingerIndex(0)][0] = distance * k as f64 / steps.max(1) as f64;
        q
    };
    let states = (0..=steps).map(at).collect();
    Motion { segments: vec![Segment { kind: SegmentKind::Transfer, states, times: vec![] }] }
}

#[test]
fn a_straight_line_takes_the_time_of_the_bang_bang_profile() {
    // Acceleration only: 2 sqrt(d/a). With the velocity limit: d/v + v/a.
    for (velocity, expected) in [(100.0, 2.0 * (0.5_f64 / 2.0).sqrt()), (0.4, 0.5 / 0.4 + 0.4 / 2.0)] {
        let hand = Fingertips::new(1, velocity, 2.0);
        let mut motion = straight(0.5, 400);
        assign_times(&mut motion, &hand, &TimingLimits::default()).unwrap();
        let duration = *motion.segments[0].times.last().unwrap();
        assert!((duration / expected - 1.0).abs() < 0.02, "{duration} against {expected}");
        let (v, a) = utilisation(&motion, &hand);
        assert!(v <= 1.0 && a <= 1.0 && a > 0.99, "{v} {a}");
    }
}

#[test]
fn the_object_keeps_its_own_speed() {
    let hand = Fingertips::new(1, 10.0, 1000.0);
    let mut motion = straight(0.1, 10);
    for (k, q) in motion.segments[0].states.iter_mut().enumerate() {
        q.X_HO = Pose::translation(0.01 * k as f64, 0.0, 0.0)
            * Rotation::from_scaled_axis(Vec3::z() * (0.1 * k as f64));
    }
    let limits = TimingLimits { object_speed: Some(0.1), ..Default::default() };
    assign_times(&mut motion, &hand, &limits).unwrap();
    let by_speed = *motion.segments[0].times.last().unwrap();
    assert!((0.99..1.1).contains(&by_speed), "{by_speed}");
    let limits = TimingLimits { object_turn_rate: Some(0.25), ..limits };
    assign_times(&mut motion, &hand, &limits).unwrap();
    let by_turn = *motion.segments[0].times.last().unwrap();
    assert!((3.99..4.1).contains(&by_turn), "{by_turn}");
}

#[test]
fn resting_states_are_apart_in_time_and_single_states_are_fine() {
    let hand = Fingertips::new(1, 1.0, 1.0);
    let mut motion = straight(0.0, 5);
    assign_times(&mut motion, &hand, &TimingLimits::default()).unwrap();
    let times = &motion.segments[0].times;
    assert!(times.windows(2).all(|pair| pair[1] - pair[0] > 0.9e-3), "{times:?}");
    let mut single = straight(0.0, 0);
    assign_times(&mut single, &hand, &TimingLimits::default()).unwrap();
    assert_eq!(single.segments[0].times, [0.0]);
    assign_times(&mut Motion::default(), &hand, &TimingLimits::default()).unwrap();
}

#[test]
fn what_cannot_be_timed_is_refused_with_its_place() {
    let hand = Fingertips::new(1, 1.0, 1.0);
    let mut motion = straight(0.1, 5);
    motion.segments[0].states[3].joints[FingerIndex(0)][1] = f64::NAN;
    let error = assign_times(&mut motion, &hand, &TimingLimits::default()).unwrap_err();
    assert_eq!(error, TimingError::State { segment: 0, state: 3 });
    let zero = Fingertips::new(1, 0.0, 1.0);
    let error = assign_times(&mut straight(0.1, 5), &zero, &TimingLimits::default()).unwrap_err();
    assert!(error.to_string().contains("velocity of joint `axis-0`"), "{error}");
    let limits = TimingLimits { shortest_step: 0.0, ..Default::default() };
    assert!(assign_times(&mut straight(0.1, 5), &hand, &limits).is_err());
}
