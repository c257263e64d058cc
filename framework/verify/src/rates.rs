//! Whether joints can be driven as the plan says: their velocities and accelerations, and what a trajectory
//! controller makes of the plan.
//!
//! Where states carry velocities, a controller plays the cubic through positions and velocities (Hermite).
//! Its velocity is a parabola and its acceleration a straight line over each step, so that the largest values
//! over *all* times are known. Where states carry none, joints move linearly and change their velocity at the
//! states: each change counts over the shorter of its two steps.

use crate::hand::Chains;
use crate::motion_checks::joint_place;
use crate::track::Leg;
use crate::verdict::{Check, Gauge, Side};

/// What rounding may add to a fraction of a limit.
const ROUNDING: f64 = 1e-6;

/// One joint over one step: duration, mean velocity, velocities at both ends.
#[derive(Clone, Copy)]
struct Cubic {
    h: f64,
    mean: f64,
    v: [f64; 2],
}

impl Cubic {
    /// The largest velocity at any time, in size.
    fn fastest(&self) -> f64 {
        let [v0, v1] = self.v;
        if self.h.is_nan() || self.h <= 0.0 {
            return f64::INFINITY;
        }
        // v(f) = v0 + 2 f (b - v0) + f² (v0 - 2 b + v1) with b = 3 mean - v0 - v1.
        let b = 3.0 * self.mean - v0 - v1;
        let (slope, bend) = (b - v0, v0 - 2.0 * b + v1);
        let f = -slope / bend;
        let inside = if f > 0.0 && f < 1.0 { (v0 + f * slope).abs() } else { 0.0 };
        v0.abs().max(v1.abs()).max(inside)
    }

    /// The largest acceleration at any time, in size: it is reached at an end.
    fn steepest(&self) -> f64 {
        let [v0, v1] = self.v;
        let at_start = (6.0 * self.mean - 4.0 * v0 - 2.0 * v1) / self.h;
        let at_end = (2.0 * v0 + 4.0 * v1 - 6.0 * self.mean) / self.h;
        at_start.abs().max(at_end.abs())
    }
}

/// Velocities and accelerations of every joint over the whole motion, which starts and ends at rest.
pub(crate) fn rates(hand: &Chains, legs: &[Leg<'_>]) -> [Check; 2] {
    let mut velocities = Gauge::new("velocities", "of the limit", Side::AtMost, 1.0 + ROUNDING);
    let mut accelerations = Gauge::new("accelerations", "of the limit", Side::AtMost, 1.0 + ROUNDING);
    let played = legs.iter().flat_map(|leg| &leg.states).all(|state| state.velocities.is_some());
    if played {
        cubics(hand, legs, &mut velocities, &mut accelerations);
    } else {
        lines(hand, legs, &mut velocities, &mut accelerations);
    }
    [velocities.check(), accelerations.check()]
}

fn cubics(hand: &Chains, legs: &[Leg<'_>], velocities: &mut Gauge, accelerations: &mut Gauge) {
    for leg in legs {
        for k in 0..leg.states.len() - 1 {
            for (j, joint) in hand.joints().enumerate() {
                let cubic = cubic(leg, k, j);
                velocities.note(cubic.fastest() / joint.velocity, || joint_place(hand, leg, k, j));
                accelerations.note(cubic.steepest() / joint.acceleration, || joint_place(hand, leg, k, j));
            }
        }
    }
    // A velocity at the very start or end is reached in no time.
    let ends = [legs.first().map(|leg| (leg, 0)), legs.last().map(|leg| (leg, leg.states.len() - 1))];
    for (leg, state) in ends.into_iter().flatten() {
        for (j, v) in leg.states[state].velocities.iter().flatten().enumerate() {
            if *v != 0.0 {
                accelerations.note(f64::INFINITY, || joint_place(hand, leg, state, j));
            }
        }
    }
}

fn cubic(leg: &Leg<'_>, k: usize, j: usize) -> Cubic {
    let (from, to) = (&leg.states[k], &leg.states[k + 1]);
    let h = to.record.time - from.record.time;
    let v = |state: &crate::track::State<'_>| state.velocities.as_ref().map_or(0.0, |v| v[j]);
    Cubic { h, mean: (to.joints[j] - from.joints[j]) / h, v: [v(from), v(to)] }
}

fn lines(hand: &Chains, legs: &[Leg<'_>], velocities: &mut Gauge, accelerations: &mut Gauge) {
    // The motion's steps in a row.
    let steps: Vec<(&Leg<'_>, usize)> =
        legs.iter().flat_map(|leg| (0..leg.states.len() - 1).map(move |k| (leg, k))).collect();
    for (j, joint) in hand.joints().enumerate() {
        // At rest before the start and after the end, for as long as it takes.
        let (mut h_before, mut v_before) = (f64::INFINITY, 0.0);
        for &(leg, k) in &steps {
            let Cubic { h, mean: v, .. } = cubic(leg, k, j);
            let place = || joint_place(hand, leg, k, j);
            velocities.note(v.abs() / joint.velocity, place);
            accelerations.note((v - v_before).abs() / h.min(h_before) / joint.acceleration, place);
            (h_before, v_before) = (h, v);
        }
        if let Some(&(leg, k)) = steps.last() {
            let place = || joint_place(hand, leg, k + 1, j);
            accelerations.note(v_before.abs() / h_before / joint.acceleration, place);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    #[test]
    fn the_largest_rates_are_those_of_a_fine_sampling() {
        let mut random = Random::from_key(5, 0, 0, 0);
        for _ in 0..500 {
            let mut draw = || random.range(-2.0, 2.0);
            let cubic = Cubic { h: 0.5 + draw().abs(), mean: draw(), v: [draw(), draw()] };
            let b = 3.0 * cubic.mean - cubic.v[0] - cubic.v[1];
            let velocity =
                |f: f64| (1.0 - f) * (1.0 - f) * cubic.v[0] + 2.0 * f * (1.0 - f) * b + f * f * cubic.v[1];
            let samples = 2000;
            let all: Vec<f64> = (0..=samples).map(|i| velocity(f64::from(i) / f64::from(samples))).collect();
            let fastest = all.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            assert!((fastest - cubic.fastest()).abs() < 1e-5, "{fastest} {}", cubic.fastest());
            let dt = cubic.h / f64::from(samples);
            let steepest = all.windows(2).map(|w| ((w[1] - w[0]) / dt).abs()).fold(0.0, f64::max);
            let exact = cubic.steepest();
            assert!(steepest <= exact + 1e-6 && steepest > 0.99 * exact - 1e-3, "{steepest} {exact}");
        }
    }
}
