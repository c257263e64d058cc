//! When each state is passed: as fast as the joints' limits allow along a given motion.
//!
//! With states q_k at times t_k, v_k = (q_{k+1} - q_k)/(t_{k+1} - t_k) and a_k = 2 (v_k - v_{k-1})/(t_{k+1} - t_{k-1}), over the whole motion
//! and across the borders of segments, every joint keeps |v_k| ≤ its velocity and |a_k| ≤ its acceleration. The hand rests before and after:
//! v = 0 there, taking no time (so that a_0 = 2 v_0/(t_1 - t_0)).
//!
//! Time-optimal motion along a prescribed path goes back to Bobrow, Dubowsky and Gibson, "Time-optimal control of robotic manipulators along
//! specified paths", IJRR 1985. As in Pham and Pham, "A new approach to time-optimal path parameterization based on reachability analysis",
//! T-RO 2018, and Consolini et al., "Optimal time-complexity speed planning for robot manipulators", T-RO 2019, passes forward and backward
//! lower the speed of each step until it can be reached from, and braked to, its neighbour's. Here the unknown is each step's rate
//! u_k = 1/(t_{k+1} - t_k), since the path is piecewise linear and its corners are what limits the acceleration.

use crate::Motion;
use nalgebra::Vector3;
use regrasp_api::{FingerIndex, Hand, angle_between};
use thiserror::Error;

/// Bounds beside those of the joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimingLimits {
    /// Largest speed of the object's origin (m/s), if any.
    pub object_speed: Option<f64>,
    /// Largest angular speed of the object (rad/s), if any.
    pub object_turn_rate: Option<f64>,
    /// Shortest time between two states (s), positive: also states between which no joint moves are apart.
    pub shortest_step: f64,
}

impl Default for TimingLimits {
    fn default() -> Self {
        Self { object_speed: None, object_turn_rate: None, shortest_step: 1e-3 }
    }
}

/// Why a motion cannot be timed.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum TimingError {
    /// A state does not belong to this hand, or holds a number that is not finite.
    #[error("segment {segment}, state {state}: a pose or joint is not finite, or not of this hand")]
    State {
        /// The segment.
        segment: usize,
        /// The state.
        state: usize,
    },
    /// A limit that is not a positive number.
    #[error("the {what} must be a positive number")]
    Limit {
        /// Which limit.
        what: String,
    },
}

/// Fills in the times of all states, from 0. Shared states of consecutive segments get the same time, all others strictly increasing ones.
///
/// Cost: linear in the number of states, a handful of passes.
pub fn assign_times(motion: &mut Motion, hand: &dyn Hand, limits: &TimingLimits) -> Result<(), TimingError> {
    let bounds = JointBounds::of(hand, limits)?;
    let steps = Steps::of(motion, hand, &bounds, limits)?;
    let rates = steps.rates(&bounds);
    // The passes end with rounding errors and after a bounded number of sweeps; slowing everything down alike keeps every limit for certain.
    let slower = steps.worst_ratio(&bounds, &rates).max(1.0);
    let mut durations = rates.iter().map(|u| slower / u);
    let mut time = 0.0;
    for segment in &mut motion.segments {
        segment.times.clear();
        for k in 0..segment.states.len() {
            time += if k == 0 { 0.0 } else { durations.next().expect("one step for each pair of states") };
            segment.times.push(time);
        }
    }
    Ok(())
}

/// How much of the limits is used: the rest is for rounding, here and where the times are read back.
const USED: f64 = 1.0 - 1e-6;
/// Most sweeps over the motion, forward and backward together; two or three are usual.
const MOST_SWEEPS: usize = 60;

/// Velocity and acceleration limits of all joints of the hand in a row.
struct JointBounds {
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

impl JointBounds {
    fn of(hand: &dyn Hand, limits: &TimingLimits) -> Result<Self, TimingError> {
        let check = |what: &str, value: f64| {
            let good = value > 0.0 && value.is_finite();
            if good { Ok(value * USED) } else { Err(TimingError::Limit { what: what.into() }) }
        };
        check("shortest time between two states", limits.shortest_step)?;
        check("object's largest speed", limits.object_speed.unwrap_or(1.0))?;
        check("object's largest angular speed", limits.object_turn_rate.unwrap_or(1.0))?;
        let mut bounds = Self { velocity: Vec::new(), acceleration: Vec::new() };
        for finger in (0..hand.finger_count() as u8).map(FingerIndex) {
            for joint in &hand.finger(finger).joints {
                bounds.velocity.push(check(&format!("velocity of joint `{}`", joint.name), joint.velocity)?);
                let name = format!("acceleration of joint `{}`", joint.name);
                bounds.acceleration.push(check(&name, joint.acceleration)?);
            }
        }
        Ok(bounds)
    }

    fn count(&self) -> usize {
        self.velocity.len()
    }
}

/// The steps between consecutive states of the whole motion.
struct Steps {
    /// For each step the change of every joint, in a row.
    changes: Vec<f64>,
    /// For each step the highest rate (1/s) that velocities, reversals and the ends allow.
    caps: Vec<f64>,
}

impl Steps {
    fn of(
        motion: &Motion,
        hand: &dyn Hand,
        bounds: &JointBounds,
        limits: &TimingLimits,
    ) -> Result<Self, TimingError> {
        let mut steps = Self { changes: Vec::new(), caps: Vec::new() };
        for (s, segment) in motion.segments.iter().enumerate() {
            for (k, q) in segment.states.iter().enumerate() {
                let fits = q.joints.len() == hand.finger_count()
                    && q.joints.iter().all(|(f, joints)| joints.len() == hand.finger(f).joints.len());
                let pose = q.X_HO.translation.vector.iter().chain(q.X_HO.rotation.coords.iter());
                let finite = pose.chain(q.joints.iter().flat_map(|(_, joints)| joints.iter()));
                if !fits || !finite.copied().all(f64::is_finite) {
                    return Err(TimingError::State { segment: s, state: k });
                }
            }
            for pair in segment.states.windows(2) {
                for (finger, joints) in pair[0].joints.iter() {
                    let change = pair[1].joints[finger].iter().zip(joints.iter()).map(|(b, a)| b - a);
                    steps.changes.extend(change);
                }
                let p: Vector3<f64> = pair[1].X_HO.translation.vector - pair[0].X_HO.translation.vector;
                let angle = angle_between(&pair[0].X_HO.rotation, &pair[1].X_HO.rotation);
                let speed = limits.object_speed.map_or(0.0, |limit| p.norm() / limit);
                let turn = limits.object_turn_rate.map_or(0.0, |limit| angle / limit);
                steps.caps.push(1.0 / limits.shortest_step.max(speed).max(turn));
            }
        }
        steps.cap(bounds);
        Ok(steps)
    }

    fn change(&self, step: usize, bounds: &JointBounds) -> &[f64] {
        &self.changes[step * bounds.count()..(step + 1) * bounds.count()]
    }

    /// Lowers the caps to the joints' velocities, and where a joint turns back or the motion starts or ends to the rate from which that
    /// joint can stop within the step.
    fn cap(&mut self, bounds: &JointBounds) {
        for k in 0..self.caps.len() {
            for j in 0..bounds.count() {
                let at = |step: usize| self.changes[step * bounds.count() + j];
                let d = at(k);
                let turns = |other: Option<usize>| {
                    other.filter(|&o| o < self.caps.len()).is_none_or(|o| at(o) * d < 0.0)
                };
                let mut cap = self.caps[k].min(bounds.velocity[j] / d.abs());
                if d != 0.0 && (turns(k.checked_sub(1)) || turns(Some(k + 1))) {
                    cap = cap.min((bounds.acceleration[j] / (2.0 * d.abs())).sqrt());
                }
                self.caps[k] = cap;
            }
        }
    }

    /// The highest rates that keep every limit, up to the last sweep's tolerance.
    fn rates(&self, bounds: &JointBounds) -> Vec<f64> {
        let mut rates = self.caps.clone();
        // What a step allows its neighbour changes only when its own rate does: the sweeps visit nothing else.
        let mut stale = vec![[true; 2]; rates.len()];
        for _ in 0..MOST_SWEEPS {
            let forward = (1..rates.len()).map(|k| (k, k - 1, 0));
            let backward = (1..rates.len()).rev().map(|k| (k - 1, k, 1));
            let mut lowered = false;
            for (k, by, side) in forward.chain(backward) {
                if std::mem::take(&mut stale[k][side]) && self.lower(&mut rates, k, by, bounds) {
                    lowered = true;
                    if let Some(next) = stale.get_mut(k + 1) {
                        next[0] = true;
                    }
                    if k > 0 {
                        stale[k - 1][1] = true;
                    }
                }
            }
            if !lowered {
                break;
            }
        }
        rates
    }

    /// Lowers the rate of step `k` to what its neighbour `by` allows; says whether that changed it.
    ///
    /// For a joint that moves by d at rate u here and by e (of the same sign) at rate w there, the limit a reads
    /// d u - a/(2u) ≤ φ(w) = e w + a/(2w). φ falls before it rises; its smallest value over the rates from w up to the cap takes its
    /// place, so that both sides rise: then the highest solution exists and sweeps from above find it.
    fn lower(&self, rates: &mut [f64], k: usize, by: usize, bounds: &JointBounds) -> bool {
        let mut rate = rates[k];
        for ((&d, &e), &a) in
            self.change(k, bounds).iter().zip(self.change(by, bounds)).zip(&bounds.acceleration)
        {
            if d == 0.0 || d * e < 0.0 {
                continue; // A reversal is in the caps.
            }
            let (d, e) = (d.abs(), e.abs());
            let falling = 2.0 * e * rates[by] * rates[by] < a;
            let w = if falling { (a / (2.0 * e)).sqrt().min(self.caps[by]) } else { rates[by] };
            let phi = e * w + a / (2.0 * w);
            if d * rate <= phi + a / (2.0 * rate) {
                continue; // The limit holds; the root is not needed.
            }
            rate = rate.min((phi + (phi * phi + 2.0 * d * a).sqrt()) / (2.0 * d));
        }
        let lowered = rate < rates[k] * (1.0 - 1e-9);
        rates[k] = rate;
        lowered
    }

    /// By how much all steps must last longer for every limit to hold; at most 1 where all hold.
    fn worst_ratio(&self, bounds: &JointBounds, rates: &[f64]) -> f64 {
        let mut worst = 0.0_f64;
        let velocity = |k: usize, j: usize| self.changes[k * bounds.count() + j] * rates[k];
        for j in 0..bounds.count() {
            for k in 0..=rates.len() {
                let (before, v_before) =
                    k.checked_sub(1).map_or((0.0, 0.0), |b| (1.0 / rates[b], velocity(b, j)));
                let (after, v_after) = rates.get(k).map_or((0.0, 0.0), |u| (1.0 / u, velocity(k, j)));
                if before + after > 0.0 {
                    let acceleration = 2.0 * (v_after - v_before).abs() / (before + after);
                    worst = worst.max((acceleration / bounds.acceleration[j]).sqrt());
                    worst = worst.max(v_after.abs() / bounds.velocity[j]);
                }
            }
        }
        worst
    }
}
