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
    /// The time (s, from 0) at which each state is passed: the speeds of `speed`, started and stopped at
    /// constant acceleration.
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

/// The time at which a motion of duration `total` reaches what it would have reached at `time`, were it not
/// started and stopped within `ramp` each.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_starts_and_stops_at_rest_and_keeps_its_speed_in_between() {
        let (total, ramp) = (1.0, 0.2);
        let at = |time: f64| ramped(time, total, ramp);
        assert_eq!((at(0.0), at(total)), (0.0, total + ramp));
        // In between as fast as before, and half a ramp later.
        assert!((at(0.5) - 0.6).abs() < 1e-12 && (at(0.6) - at(0.5) - 0.1).abs() < 1e-12);
        // Constant acceleration 1/ramp: after the time t it has come t² / 2 ramp far.
        assert!((at(0.1 * 0.1 / (2.0 * ramp)) - 0.1).abs() < 1e-12);
        assert!((1..=1000).all(|i| at(f64::from(i) * 1e-3) > at(f64::from(i - 1) * 1e-3)));
    }

    #[test]
    fn a_short_motion_is_all_ramp() {
        assert!((ramped(0.05, 0.1, 0.1) - 0.1).abs() < 1e-12);
        assert_eq!(ramped(0.1, 0.1, 0.1), 0.2);
        assert_eq!(ramped(0.0, 0.0, 0.0), 0.0);
    }
}
