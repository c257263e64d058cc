//! The path as timing sees it: straight steps between states, a tangent at each state, and where it must
//! stop.
//!
//! A step's *span* is the time (s) that it takes with the slowest joint at its velocity limit. Along the path
//! a parameter σ grows by the span of each step; the speed dσ/dt is at most 1. The *chord* of a step is its
//! change over its span; the *tangent* of a state is the slope there of the parabola through it and its
//! neighbours, or zero where the path stops.

use super::{JointBounds, TimingError, TimingLimits};
use crate::{Motion, SegmentKind};
use regrasp_api::{Configuration, Hand, angle_between};

/// The largest value of f (1 - f)² and f² (1 - f) over 0 ≤ f ≤ 1, times 2: how far the cubic leaves the
/// chord, in units of the span times the difference of tangent and chord, for whatever speeds at the step's
/// two ends.
const BULGE: f64 = 8.0 / 27.0;
/// The part of the deviation that is used: tips are placed once for a step, where they stray most.
const USED_DEVIATION: f64 = 0.9;

/// The whole motion in a row, states that segments share counted once.
pub(super) struct Path {
    joints: usize,
    /// For each step the chord of every joint, in a row (rad/s; m/s).
    chords: Vec<f64>,
    /// For each state the tangent of every joint, in a row (rad/s; m/s).
    tangents: Vec<f64>,
    /// For each step its span (s).
    pub(super) spans: Vec<f64>,
    /// For each step the shortest time that it may take, from rest to rest (s).
    pub(super) rest_to_rest: Vec<f64>,
    /// For each state whether the motion rests there.
    pub(super) stops: Vec<bool>,
    /// For each state the highest speed, as far as the velocities and the shortest step say.
    pub(super) caps: Vec<f64>,
    /// For each corner, a state at rest between two steps that it would be left by too far otherwise: the
    /// span of steps so short that it would not. 0 for all other states.
    pub(super) reaches: Vec<f64>,
}

impl Path {
    pub(super) fn of(
        motion: &Motion,
        hand: &dyn Hand,
        bounds: &JointBounds,
        limits: &TimingLimits,
    ) -> Result<Self, TimingError> {
        let row = row(motion, hand)?;
        let (joints, steps) = (bounds.count(), row.len().saturating_sub(1));
        let mut path = Self {
            joints,
            chords: Vec::with_capacity(steps * joints),
            tangents: vec![0.0; row.len() * joints],
            spans: Vec::with_capacity(steps),
            rest_to_rest: Vec::with_capacity(steps),
            stops: row.iter().map(|(_, stop)| *stop).collect(),
            caps: vec![1.0; row.len()],
            reaches: vec![0.0; row.len()],
        };
        for (k, pair) in row.windows(2).enumerate() {
            path.add_step(k, (pair[0].0, pair[1].0), bounds, limits);
        }
        (1..steps).for_each(|k| path.turn(k, row[k].0, hand, limits));
        path.cap(bounds, limits);
        Ok(path)
    }

    fn add_step(
        &mut self,
        k: usize,
        (from, to): (&Configuration, &Configuration),
        bounds: &JointBounds,
        limits: &TimingLimits,
    ) {
        let first = self.chords.len();
        for (finger, joints) in from.joints.iter() {
            self.chords.extend(to.joints[finger].iter().zip(joints.iter()).map(|(b, a)| b - a));
        }
        let changes = &mut self.chords[first..];
        let distance = || (to.X_HO.translation.vector - from.X_HO.translation.vector).norm();
        let angle = || angle_between(&from.X_HO.rotation, &to.X_HO.rotation);
        let speed = limits.object_speed.map_or(0.0, |limit| distance() / limit);
        let turn = limits.object_turn_rate.map_or(0.0, |limit| angle() / limit);
        let over =
            |limits: &[f64]| changes.iter().zip(limits).map(|(d, limit)| d.abs() / limit).fold(0.0, f64::max);
        let object = speed.max(turn);
        let span = over(&bounds.velocity).max(object);
        // The cubic from rest to rest over a time h has the largest speed 1.5 d/h and the largest
        // acceleration 6 d/h².
        let rest_to_rest = (1.5 * span).max((6.0 * over(&bounds.acceleration)).sqrt());
        self.rest_to_rest.push(rest_to_rest.max(limits.shortest_step));
        if changes.iter().all(|&d| d == 0.0) {
            self.stops[k] = true;
            self.stops[k + 1] = true;
        }
        let scale = if span > 0.0 { 1.0 / span } else { 0.0 };
        changes.iter_mut().for_each(|d| *d *= scale);
        self.spans.push(span);
    }

    /// The tangent of an inner state, or a stop where the cubic would leave the chords by too much.
    fn turn(&mut self, k: usize, q: &Configuration, hand: &dyn Hand, limits: &TimingLimits) {
        if self.stops[k] {
            return;
        }
        let (before, after) = (self.spans[k - 1], self.spans[k]);
        let weight = after / (before + after);
        let tangent: Vec<f64> = (self.chord(k - 1).iter().zip(self.chord(k)))
            .map(|(c, d)| c * weight + d * (1.0 - weight))
            .collect();
        let sides = [(self.chord(k - 1), -before), (self.chord(k), after)];
        let strays = sides.map(|(chord, span)| strays(hand, q, (chord, &tangent), span));
        let most = USED_DEVIATION * limits.deviation;
        if strays.iter().all(|stray| *stray <= most) {
            self.tangents[k * self.joints..][..self.joints].copy_from_slice(&tangent);
            return;
        }
        self.stops[k] = true;
        // A side strays by its span squared over the sum of both, times what the corner is made of.
        let rates = [(strays[0], before), (strays[1], after)]
            .map(|(stray, span)| stray * (before + after) / (span * span));
        // A little less, for rounding and what bends.
        self.reaches[k] = 1.9 * most / rates[0].max(rates[1]);
    }

    /// The highest speeds at which joints keep their velocities at the states and in between, and steps their
    /// shortest time.
    ///
    /// A step's velocity lies in the convex hull of those at its ends and 3 m - v0 - v1 with the mean m (its
    /// Bézier points).
    fn cap(&mut self, bounds: &JointBounds, limits: &TimingLimits) {
        for k in 0..self.stops.len() {
            if self.stops[k] {
                self.caps[k] = 0.0;
                continue;
            }
            let mut cap = 1.0_f64;
            for step in [k - 1, k] {
                cap = cap.min(self.spans[step] / limits.shortest_step);
                for j in 0..self.joints {
                    let (t, c) = (self.tangent(k)[j], self.chord(step)[j]);
                    let fastest = t.abs().max((c - 2.0 * (t - c)).abs());
                    cap = cap.min(bounds.velocity[j] / fastest);
                }
            }
            self.caps[k] = cap;
        }
    }

    pub(super) fn chord(&self, step: usize) -> &[f64] {
        &self.chords[step * self.joints..][..self.joints]
    }

    pub(super) fn tangent(&self, state: usize) -> &[f64] {
        &self.tangents[state * self.joints..][..self.joints]
    }

    /// Tangent less chord of a joint, for a step and one of its ends; zero where the path stops.
    pub(super) fn excess(&self, step: usize, end: usize, joint: usize) -> f64 {
        let state = step + end;
        if self.stops[state] { 0.0 } else { self.tangent(state)[joint] - self.chord(step)[joint] }
    }
}

/// How far (m) the cubic takes a fingertip from a step's chord, at most, when it passes a state at its end
/// with the tangent; the span is negative for the step before the state.
///
/// What is not progress along the chord is f (1 - f)² of the tangent's part across it, in units of twice the
/// span where the other end is slow: most at a third of the way, where the tips are placed.
fn strays(hand: &dyn Hand, q: &Configuration, (chord, tangent): (&[f64], &[f64]), span: f64) -> f64 {
    let square: f64 = chord.iter().map(|c| c * c).sum();
    let along = tangent.iter().zip(chord).map(|(t, c)| t * c).sum::<f64>() / square;
    // The progress stays within the step where its slope, twice this at most, is between 0 and 3.
    let along = if (0.0..=1.5).contains(&along) { along } else { 1.0 };
    let (mut first, mut most) = (0, 0.0_f64);
    for (finger, joints) in q.joints.iter() {
        let count = joints.len();
        let [c, t] = [chord, tangent].map(|row| &row[first..first + count]);
        first += count;
        if t.iter().zip(c).all(|(t, c)| t == c) {
            continue;
        }
        let (mut line, mut cubic) = (*joints, *joints);
        for j in 0..count {
            line[j] += 0.5 * span * c[j];
            cubic[j] = line[j] + BULGE * span * (t[j] - along * c[j]);
        }
        most = most.max((hand.tip_center(finger, &cubic) - hand.tip_center(finger, &line)).norm());
    }
    most
}

/// All states in a row, each with whether the motion must rest there: at its ends, and where a regrasp begins
/// or ends.
fn row<'m>(motion: &'m Motion, hand: &dyn Hand) -> Result<Vec<(&'m Configuration, bool)>, TimingError> {
    let mut row: Vec<(&Configuration, bool)> = Vec::new();
    for (s, segment) in motion.segments.iter().enumerate() {
        let regrasp = matches!(segment.kind, SegmentKind::Regrasp(_));
        for (k, q) in segment.states.iter().enumerate() {
            let fits = q.joints.len() == hand.finger_count()
                && q.joints.iter().all(|(f, joints)| joints.len() == hand.finger(f).joints.len());
            let pose = q.X_HO.translation.vector.iter().chain(q.X_HO.rotation.coords.iter());
            let finite = pose.chain(q.joints.iter().flat_map(|(_, joints)| joints.iter()));
            if !fits || !finite.copied().all(f64::is_finite) {
                return Err(TimingError::State { segment: s, state: k });
            }
            match row.last_mut().filter(|_| k == 0) {
                Some(shared) => shared.1 |= regrasp,
                None => row.push((q, k == 0)),
            }
        }
        if let Some(last) = row.last_mut() {
            last.1 |= regrasp;
        }
    }
    if let Some(last) = row.last_mut() {
        last.1 = true;
    }
    Ok(row)
}
