//! Whether the cubic that a trajectory controller plays stays close to the motion that the plan means.
//!
//! Over a step the plan means a straight line in joint space. The cubic's progress along that line is its
//! best fit to the joints; how far a fingertip is then from where the line has it must stay within half of
//! the closure tolerance. A bound over all times comes first: the part of each joint's cubic that is not
//! progress, times how far the joint can move the tip. Only where that does not do, the tip is placed at
//! samples.

use crate::hand::Chains;
use crate::scene::Scene;
use crate::track::{Frames, Leg, State};
use crate::verdict::{Check, Gauge, Side};
use regrasp_api::{Body, FingerIndex, MAX_FINGER_JOINTS, MAX_FINGERS};
use regrasp_plan::Place;

/// How many times within a step the tips are placed where the bound does not do.
const PLACES: usize = 20;

/// Holds every step's cubic against its line.
pub(crate) struct ControllerCheck {
    gauge: Gauge,
    frames: [Frames; 2],
    /// Whether a state carries no velocities.
    is_unplayed: bool,
}

impl ControllerCheck {
    pub(crate) fn new(hand: &Chains, closure: f64) -> Self {
        Self {
            gauge: Gauge::new("controller", "m", Side::AtMost, closure / 2.0),
            frames: [Frames::new(hand), Frames::new(hand)],
            is_unplayed: false,
        }
    }

    /// Takes in the step after a state.
    pub(crate) fn step(&mut self, hand: &Chains, scene: &Scene, leg: &Leg<'_>, state: usize) {
        let Some(step) = Step::of(&leg.states[state], &leg.states[state + 1]) else {
            self.is_unplayed = true;
            return;
        };
        let bounds = step.bounds(hand, scene);
        let bound = bounds.iter().copied().fold(0.0, f64::max);
        let gauge = &mut self.gauge;
        if bound <= gauge.limit().min(gauge.worst().unwrap_or(0.0)) {
            return;
        }
        if bound <= gauge.limit() {
            return gauge.note(bound, || leg.at(state));
        }
        for i in 1..PLACES {
            let f = i as f64 / PLACES as f64;
            for (finger, bound) in bounds.iter().enumerate().take(hand.fingers.len()) {
                // What cannot be the worst is not placed.
                let worst = gauge.worst().unwrap_or(0.0);
                if *bound > worst && (bound.is_infinite() || step.bound(hand, scene, finger, f) > worst) {
                    let distance = step.strays(hand, &mut self.frames, finger, f);
                    gauge.note(distance, || Place { finger: Some(finger), ..leg.between(state, f) });
                }
            }
        }
    }

    /// Takes in what was gathered later in the plan.
    pub(crate) fn join(&mut self, later: Self) {
        self.gauge.join(later.gauge);
        self.is_unplayed |= later.is_unplayed;
    }

    /// `None` where states carry no velocities.
    pub(crate) fn check(self) -> Option<Check> {
        (!self.is_unplayed).then(|| self.gauge.check())
    }
}

/// One step: joints at its ends, and the end velocities times the duration.
struct Step<'s> {
    from: &'s [f64],
    change: Vec<f64>,
    slopes: [Vec<f64>; 2],
    /// The slopes' parts along the change.
    along: [f64; 2],
}

impl<'s> Step<'s> {
    fn of(from: &'s State<'_>, to: &State<'_>) -> Option<Self> {
        let h = to.record.time - from.record.time;
        let change: Vec<f64> = to.joints.iter().zip(&from.joints).map(|(b, a)| b - a).collect();
        let slopes = [from, to].map(|state| Some(state.velocities.as_ref()?.iter().map(|v| v * h).collect()));
        let [Some(first), Some(second)] = slopes else { return None };
        let slopes: [Vec<f64>; 2] = [first, second];
        let square: f64 = change.iter().map(|d| d * d).sum();
        let fit = |slope: &[f64]| -> f64 {
            let dot: f64 = slope.iter().zip(&change).map(|(s, d)| s * d).sum();
            if square > 0.0 { dot / square } else { 0.0 }
        };
        let along = [fit(&slopes[0]), fit(&slopes[1])];
        Some(Self { from: &from.joints, change, slopes, along })
    }

    /// How far each tip can be from the line (m), at any time; infinite where the progress may leave the
    /// step.
    ///
    /// What is not progress is f (1 - f)² e0 - f² (1 - f) e1 with the slopes' parts e0, e1 across the change:
    /// at most 4/27 (|e0| + |e1|), and the progress stays within the step where both its slopes lie between 0
    /// and 3 (Fritsch and Carlson, "Monotone piecewise cubic interpolation", SINUM 1980).
    fn bounds(&self, hand: &Chains, scene: &Scene) -> [f64; MAX_FINGERS] {
        if !self.along.iter().all(|a| (0.0..=3.0).contains(a)) {
            return [f64::INFINITY; MAX_FINGERS];
        }
        let across = |j: usize| {
            let e = |end: usize| (self.slopes[end][j] - self.along[end] * self.change[j]).abs();
            4.0 / 27.0 * (e(0) + e(1))
        };
        let mut bounds = [0.0; MAX_FINGERS];
        for (finger, (chain, bound)) in hand.fingers.iter().zip(&mut bounds).enumerate() {
            let levers = scene.tip_levers(FingerIndex(finger as u8));
            *bound = (0..chain.joints.len()).map(|j| times(levers[j], across(chain.first + j))).sum::<f64>();
        }
        bounds
    }

    /// How far a tip can be from the line at a fraction of the time (m), where the progress stays within the
    /// step.
    fn bound(&self, hand: &Chains, scene: &Scene, finger: usize, f: f64) -> f64 {
        let (levers, g) = (scene.tip_levers(FingerIndex(finger as u8)), 1.0 - f);
        let chain = &hand.fingers[finger];
        let across = |j: usize| {
            let e = |end: usize| self.slopes[end][j] - self.along[end] * self.change[j];
            (f * g * g * e(0) - f * f * g * e(1)).abs()
        };
        let bound: f64 = (0..chain.joints.len()).map(|j| times(levers[j], across(chain.first + j))).sum();
        bound * (1.0 + 1e-9)
    }

    /// How far a tip is from the line at a fraction of the time (m).
    fn strays(&self, hand: &Chains, frames: &mut [Frames; 2], finger: usize, f: f64) -> f64 {
        let cubic = |change: f64, slopes: [f64; 2]| {
            let (rising, g) = (f * f * (3.0 - 2.0 * f), 1.0 - f);
            change * rising + slopes[0] * f * g * g - slopes[1] * f * f * g
        };
        let progress = cubic(1.0, self.along).clamp(0.0, 1.0);
        let played = |j: usize| self.from[j] + cubic(self.change[j], [self.slopes[0][j], self.slopes[1][j]]);
        frames[0].place_finger(hand, finger, played);
        frames[1].place_finger(hand, finger, |j| self.from[j] + self.change[j] * progress);
        (frames[0].p_HTip[finger] - frames[1].p_HTip[finger]).norm()
    }
}

/// A joint that does not stray moves nothing, however far its finger reaches.
fn times(lever: f64, across: f64) -> f64 {
    if across == 0.0 { 0.0 } else { lever * across }
}

impl Scene {
    /// How far a fingertip's centre can move for one unit of each joint of its finger (m).
    fn tip_levers(&self, finger: FingerIndex) -> &[f64; MAX_FINGER_JOINTS] {
        let tip = self.bodies.iter().find(|solidity| solidity.body == Body::Fingertip(finger));
        &tip.expect("every finger has a tip").levers
    }
}
