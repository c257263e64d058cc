//! One transfer, simulated.

use crate::force::Friction;
use crate::hold::{Held, Holder};
use crate::pace::Pace;
use crate::simulator::{Knot, Scene, Simulator};
use crate::surface::ball_surface;
use crate::{Bounds, Failure, Happening, Outcome, PhysicsError, SimulationSettings, Stage};
use rapier3d_f64::prelude::SharedShape;
use regrasp_api::{Configuration, Hand, ObjectModel, Vec3};

/// How long (s) the object must stay held after its motion.
const HOLD: f64 = 0.05;

/// Simulates transfers of one object.
pub struct TransferSimulator {
    settings: SimulationSettings,
    shape: SharedShape,
}

impl TransferSimulator {
    /// Prepares the object's shape, or says what is wrong with the settings or the shape.
    pub fn new(settings: SimulationSettings, object: &ObjectModel) -> Result<Self, PhysicsError> {
        settings.validate()?;
        Ok(Self { settings, shape: ball_surface(&object.mesh)? })
    }

    /// Moves the object through the states at the given pace, and holds it at the end for a moment.
    ///
    /// The forces are planned for the friction coefficient `mu` and the object's own mass, whatever the
    /// settings simulate. `g_H` is the acceleration of gravity (m/s², in H). Cost: about 20 µs for each time
    /// step of four fingers.
    pub fn simulate(
        &self,
        (hand, object, g_H): (&dyn Hand, &ObjectModel, Vec3),
        states: &[Configuration],
        pace: &Pace,
        mu: f64,
        bounds: &Bounds,
    ) -> Outcome {
        let holder = Holder::new((hand, object, g_H), Friction::point(mu), &self.settings);
        let times = pace.times(hand, states);
        let knot = |((q, held), &time): ((&Configuration, Option<Held>), &f64)| {
            let Held { efforts: feed, .. } = held.filter(|held| held.share <= 1.0)?;
            Some(Knot { time, X_HO: q.X_HO, joints: q.joints, feed, holding: q.holding() })
        };
        let stage = Stage { states, times: &times, moving: None, forces: &[] };
        let held = holder.stage(&stage);
        let mut knots: Vec<Knot> = states.iter().zip(held).zip(&times).map_while(knot).collect();
        let held = knots.len();
        if let Some(last) = knots.last() {
            knots.push(Knot { time: last.time + HOLD, ..last.clone() });
        }
        let mut outcome = Outcome::new(hand.finger_count());
        if let Some(first) = knots.first() {
            let scene = Scene { hand, object, shape: &self.shape, fixed: &[], hull: None, g_H };
            Simulator::new(&scene, &self.settings, first).run(&knots, bounds, &mut outcome, &mut |_, _| ());
        }
        if held < states.len() && outcome.is_good() {
            let time = times.get(held).copied().unwrap_or(0.0);
            outcome.failure = Some(Failure { what: Happening::NoGrip, time, state: held.saturating_sub(1) });
        }
        outcome
    }
}
