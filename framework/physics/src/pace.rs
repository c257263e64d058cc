//! When a simulated motion passes its states.

use regrasp_api::{Configuration, Hand};

/// How fast a motion without times of its own is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// What part of the joints' velocity limits is used, in (0, 1].
    pub speed: f64,
    /// Time (s) in which the motion starts, and in which it stops.
    pub ramp: f64,
}

/// The least time (s) between two states.
const LEAST: f64 = 1e-4;

impl Pace {
    /// The time (s, from 0) at which each state is passed: the speeds of `speed`, started and stopped at constant acceleration.
    pub fn times(&self, hand: &dyn Hand, states: &[Configuration]) -> Vec<f64> {
        let mut times = Vec::with_capacity(states.len());
        let mut now = 0.0;
        for (i, state) in states.iter().enumerate() {
            if i > 0 {
                now += self.span(hand, &states[i - 1], state);
            }
            times.push(now);
        }
        let ramp = self.ramp.min(now);
        times.iter_mut().for_each(|time| *time = ramped(*time, now, ramp));
        times
    }

    fn span(&self, hand: &dyn Hand, a: &Configuration, b: &Configuration) -> f64 {
        let fingers = a.joints.fingers().map(|finger| {
            let models = hand.finger(finger).joints.iter();
            let moved = a.joints[finger].iter().zip(b.joints[finger].iter()).map(|(a, b)| (a - b).abs());
            moved.zip(models).map(|(moved, model)| moved / model.velocity).fold(0.0, f64::max)
        });
        (fingers.fold(0.0, f64::max) / self.speed).max(LEAST)
    }
}

/// The time at which a motion of duration `total` reaches what it would have reached at `time`, were it not started and stopped within
/// `ramp` each.
fn ramped(time: f64, total: f64, ramp: f64) -> f64 {
    let half = 0.5 * ramp;
    if time < half {
        (2.0 * ramp * time).sqrt()
    } else if time > total - half {
        total + ramp - (2.0 * ramp * (total - time)).max(0.0).sqrt()
    } else {
        time + half
    }
}
