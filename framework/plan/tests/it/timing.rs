//! Times keep the limits of every joint, with an own evaluation of the definition.

use crate::common;

use common::*;
use proptest::prelude::*;
use regrasp_api::*;
use regrasp_plan::*;

/// All states once: joints, velocities and times.
struct Row {
    q: Vec<Vec<f64>>,
    v: Vec<Vec<f64>>,
    t: Vec<f64>,
}

fn row(motion: &Motion) -> Row {
    let flat =
        |joints: &PerFinger<FingerJoints>| joints.iter().flat_map(|(_, j)| j.to_vec()).collect::<Vec<_>>();
    let mut row = Row { q: Vec::new(), v: Vec::new(), t: Vec::new() };
    for (s, segment) in motion.segments.iter().enumerate() {
        for (k, q) in segment.states.iter().enumerate() {
            let (v, t) = (flat(&segment.velocities[k]), segment.times[k]);
            if s > 0 && k == 0 {
                assert_eq!((Some(&v), Some(&t)), (row.v.last(), row.t.last()), "shared states share all");
                continue;
            }
            row.q.push(flat(&q.joints));
            row.v.push(v);
            row.t.push(t);
        }
    }
    row
}

/// The cubic through positions and velocities at a time.
fn played(row: &Row, step: usize, t: f64) -> Vec<f64> {
    let h = row.t[step + 1] - row.t[step];
    let f = (t - row.t[step]) / h;
    let g = 1.0 - f;
    let joint = |j: usize| {
        let [a, b] = [row.q[step][j], row.q[step + 1][j]];
        let [v, w] = [row.v[step][j] * h, row.v[step + 1][j] * h];
        a * (1.0 + 2.0 * f) * g * g + b * f * f * (3.0 - 2.0 * f) + v * f * g * g - w * f * f * g
    };
    (0..row.q[0].len()).map(joint).collect()
}

/// How far the played tips are from the straight step, all joints having made the same part of it.
fn strays(row: &Row, step: usize, q: &[f64]) -> f64 {
    let change: Vec<f64> = row.q[step + 1].iter().zip(&row.q[step]).map(|(b, a)| b - a).collect();
    let square: f64 = change.iter().map(|d| d * d).sum();
    let made: f64 = q.iter().zip(&row.q[step]).zip(&change).map(|((q, a), d)| (q - a) * d).sum();
    let part = if square > 0.0 { (made / square).clamp(0.0, 1.0) } else { 0.0 };
    let off = |j: usize| q[j] - row.q[step][j] - part * change[j];
    let tip = |f: usize| (0..3).map(|i| off(3 * f + i).powi(2)).sum::<f64>().sqrt();
    (0..q.len() / 3).map(tip).fold(0.0, f64::max)
}

/// The largest velocity and acceleration as fractions of their limits, and the largest deviation (m), of what
/// a controller plays at 1 kHz: by differences of the sampled positions alone.
fn utilisation(motion: &Motion, hand: &dyn Hand) -> (f64, f64, f64) {
    let row = row(motion);
    assert!(row.t.windows(2).all(|pair| pair[1] > pair[0]), "times increase");
    let fingers = (0..hand.finger_count() as u8).map(|f| hand.finger(FingerIndex(f)));
    let models: Vec<&JointModel> = fingers.flat_map(|finger| &finger.joints).collect();
    // The hand rests before and after.
    let (mut before, mut last) = (row.q[0].clone(), row.q[0].clone());
    let (mut fastest, mut steepest, mut farthest) = (0.0_f64, 0.0_f64, 0.0_f64);
    let (dt, end) = (1e-3, *row.t.last().unwrap());
    let mut step = 0;
    for i in 1..=(end / dt) as usize + 3 {
        let t = (i as f64 * dt).min(end);
        while step + 2 < row.t.len() && row.t[step + 1] < t {
            step += 1;
        }
        let q = played(&row, step, t);
        farthest = farthest.max(strays(&row, step, &q));
        for (j, model) in models.iter().enumerate() {
            fastest = fastest.max((q[j] - last[j]).abs() / dt / model.velocity);
            let acceleration = (q[j] - 2.0 * last[j] + before[j]).abs() / (dt * dt);
            steepest = steepest.max(acceleration / model.acceleration);
        }
        before = std::mem::replace(&mut last, q);
    }
    (fastest, steepest, farthest)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn what_a_controller_plays_keeps_every_limit(seed in 0_u64..1_000_000, states in 2_usize..60,
                                                 velocity in 0.05_f64..5.0, acceleration in 0.5_f64..50.0) {
        let hand = Fingertips::new(3, velocity, acceleration);
        let mut motion = walk(seed, 3, states);
        let limits = TimingLimits { deviation: 1e-4, ..Default::default() };
        assign_times(&mut motion, &hand, &limits).unwrap();
        let (v, a, deviation) = utilisation(&motion, &hand);
        prop_assert!(v <= 1.0 && a <= 1.01 && deviation <= limits.deviation, "{v} {a} {deviation}");
    }
}

#[test]
fn a_smooth_path_is_driven_through_and_a_corner_is_a_stop() {
    let hand = Fingertips::new(1, 1.0, 20.0);
    let mut arc = straight(0.0, 60);
    for (k, q) in arc.segments[0].states.iter_mut().enumerate() {
        let angle = 0.02 * k as f64;
        q.joints[FingerIndex(0)].copy_from_slice(&[0.05 * angle.cos(), 0.05 * angle.sin(), 0.0]);
    }
    assign_times(&mut arc, &hand, &TimingLimits::default()).unwrap();
    let resting = |motion: &Motion| row(motion).v.iter().filter(|v| v.iter().all(|&v| v == 0.0)).count();
    assert_eq!(resting(&arc), 2, "at both ends");
    let (v, a, deviation) = utilisation(&arc, &hand);
    assert!(v <= 1.0 && a <= 1.01 && deviation < 10e-6, "{v} {a} {deviation}");
    let mut corner = straight(0.02, 20);
    for q in &mut corner.segments[0].states[11..] {
        let x = q.joints[FingerIndex(0)][0] - 0.01;
        q.joints[FingerIndex(0)].copy_from_slice(&[0.01, x, 0.0]);
    }
    assign_times(&mut corner, &hand, &TimingLimits::default()).unwrap();
    assert_eq!(resting(&corner), 3, "and at the corner");
    let (_, a, deviation) = utilisation(&corner, &hand);
    assert!(a <= 1.01 && deviation < 1e-9, "{a} {deviation}");
}

/// Lines of 20 steps of 1.5 mm with a corner of this angle (rad) between them, by a finger in the air.
fn bend(angle: f64) -> Motion {
    let mut motion = straight(0.06, 40);
    let segment = &mut motion.segments[0];
    segment.kind = SegmentKind::Regrasp(FingerIndex(0));
    for (k, q) in segment.states.iter_mut().enumerate() {
        let (before, after) = (0.0015 * k.min(20) as f64, 0.0015 * k.saturating_sub(20) as f64);
        let place = [before + after * angle.cos(), after * angle.sin(), 0.0];
        q.joints[FingerIndex(0)].copy_from_slice(&place);
    }
    motion
}

#[test]
fn a_finger_in_the_air_passes_a_corner_by_states_beside_it_on_the_way_that_was_meant() {
    let hand = Fingertips::new(1, 1.0, 20.0);
    let duration = |motion: &Motion| *motion.segments[0].times.last().unwrap();
    for (angle, added) in [(0.0, 0), (0.15, 2), (1.5, 0)] {
        let meant = bend(angle);
        let mut motion = meant.clone();
        assign_times(&mut motion, &hand, &TimingLimits::default()).unwrap();
        let states = &motion.segments[0].states;
        assert_eq!(states.len(), 41 + added, "a corner of {angle}");
        assert!(meant.segments[0].states.iter().all(|q| states.contains(q)), "the old states stay");
        let (v, a, deviation) = utilisation(&motion, &hand);
        assert!(v <= 1.0 && a <= 1.01 && deviation <= 10e-6, "{v} {a} {deviation}");
        // As a transfer the corner is a stop.
        let mut stopped = meant;
        stopped.segments[0].kind = SegmentKind::Transfer;
        assign_times(&mut stopped, &hand, &TimingLimits::default()).unwrap();
        let saved = duration(&stopped) - duration(&motion);
        assert!(if added > 0 { saved > 0.01 } else { saved.abs() < 1e-12 }, "{angle}: {saved}");
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
    Motion { segments: vec![Segment::new(SegmentKind::Transfer, states)] }
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
        let (v, a, _) = utilisation(&motion, &hand);
        assert!(v <= 1.0 && a <= 1.01 && a > 0.99, "{v} {a}");
    }
}

#[test]
fn the_object_keeps_its_own_speed() {
    let hand = Fingertips::new(1, 10.0, 1000.0);
    let mut motion = straight(0.1, 100);
    for (k, q) in motion.segments[0].states.iter_mut().enumerate() {
        q.X_HO = Pose::translation(0.001 * k as f64, 0.0, 0.0)
            * Rotation::from_scaled_axis(Vec3::z() * (0.01 * k as f64));
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
