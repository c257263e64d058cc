//! When each state is passed and how fast: as fast as the joints' limits allow along a given motion.
//!
//! A motion means straight lines in joint space from state to state. What a trajectory controller plays is
//! the cubic through the states' positions and velocities (Hermite). [`assign_times`] chooses times and
//! velocities so that this cubic
//!
//! - starts and ends at rest, and keeps every joint's velocity and acceleration at all times (a cubic's
//!   acceleration is largest at its ends);
//! - never takes a fingertip farther than [`TimingLimits::deviation`] from where the motion means it to be.
//!
//! The speed along the path follows from reachability: Q.-C. Pham, H. Pham, "A new approach to time-optimal
//! path parameterization based on reachability analysis", IEEE T-RO 2018. A pass backward finds from which
//! speeds the rest can still be driven, a pass forward takes the highest of them. A state where the path
//! turns too sharply for the cubic is a corner: in a regrasp it gets states beside it where that lets it be
//! passed; otherwise it is passed at rest, as are the borders of regrasps.

mod blend;
mod passes;
mod path;

use crate::Motion;
use path::Path;
use regrasp_api::{FingerIndex, FingerJoints, Hand, PerFinger, Tolerances};
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
    /// How far the cubic may take a fingertip from the motion that the states mean (m), positive: half of a
    /// plan's closure tolerance.
    pub deviation: f64,
}

impl Default for TimingLimits {
    fn default() -> Self {
        Self { object_speed: None, object_turn_rate: None, shortest_step: 1e-3, deviation: 10e-6 }
    }
}

impl TimingLimits {
    /// The limits for plans that must keep these tolerances.
    pub fn within(tolerances: &Tolerances) -> Self {
        Self { deviation: tolerances.closure / 2.0, ..Self::default() }
    }
}

/// Why a motion cannot be timed.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum TimingError {
    /// A state does not belong to this hand, or holds a number that is not finite.
    #[error(
        "segment {}, state {}: a pose or joint is not finite, or not of this hand",
        .segment + 1,
        .state + 1
    )]
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

/// Fills in times, from 0, and joint velocities of all states, and adds states beside corners of regrasps, on
/// the straight steps that the motion means. Shared states of consecutive segments get the
/// same, all others strictly increasing times.
///
/// Cost: linear in the number of states, some microseconds each.
pub fn assign_times(motion: &mut Motion, hand: &dyn Hand, limits: &TimingLimits) -> Result<(), TimingError> {
    let bounds = JointBounds::of(hand, limits)?;
    let mut path = Path::of(motion, hand, &bounds, limits)?;
    if blend::blend(motion, &path, &bounds) {
        path = Path::of(motion, hand, &bounds, limits)?;
    }
    let pace = passes::pace(&path, &bounds);
    let (mut time, mut state) = (0.0, 0);
    for segment in &mut motion.segments {
        segment.times.clear();
        segment.velocities.clear();
        for k in 0..segment.states.len() {
            if k > 0 {
                time += pace.durations[state];
                state += 1;
            }
            segment.times.push(time);
            segment.velocities.push(velocities(&path, state, pace.speeds[state], hand));
        }
    }
    Ok(())
}

/// The joint velocities of a state that is passed at this speed.
fn velocities(path: &Path, state: usize, speed: f64, hand: &dyn Hand) -> PerFinger<FingerJoints> {
    let mut tangent = path.tangent(state).iter().map(|t| t * speed);
    PerFinger::from_fn(hand.finger_count(), |finger: FingerIndex| {
        let mut joints = FingerJoints::zeros(hand.finger(finger).joints.len());
        joints.iter_mut().for_each(|v| *v = tangent.next().unwrap_or(0.0));
        joints
    })
}

/// The part of the limits that is used: the rest is for rounding, here and where the times are read back.
const USED: f64 = 1.0 - 1e-6;

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
        check("fingertips' largest deviation", limits.deviation)?;
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
