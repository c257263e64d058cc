//! The segments of a motion and the forces that hold the object in them.

use crate::force::Friction;
use crate::hold::{Held, Holder};
use crate::{PhysicsError, SimulationSettings};
use regrasp_api::{Configuration, FingerIndex, FingerSet, Hand, ObjectModel, Vec3};

/// One segment of a motion.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// The states; consecutive stages share their end states.
    pub states: &'a [Configuration],
    /// The time of each state (s), from whatever start.
    pub times: &'a [f64],
    /// The finger that moves in a regrasp; `None` in a transfer.
    pub moving: Option<FingerIndex>,
}

impl Stage<'_> {
    /// The fingers that hold the object in this stage's state `q`: in a regrasp all that touch but the one that moves.
    pub fn holding(&self, q: &Configuration) -> FingerSet {
        self.moving.map_or(q.holding(), |finger| q.holding().without(finger))
    }

    /// The friction that forces may rely on: contacts may spin in a transfer and then carry no torque about their normals.
    pub fn friction(&self, friction: Friction) -> Friction {
        if self.moving.is_some() { friction } else { Friction::point(friction.mu) }
    }
}

/// The forces that hold the object in every state of a motion, stage by stage: those farthest from slipping that the joints can exert.
///
/// `friction` is what there is: the object's, or what a plan claims; the forces rely on a little less where they can. Of the settings only `grip` and
/// `effort_share` matter. `g_H` is the acceleration of gravity (m/s², in H). A state's entry is `None` where the grasp cannot exert every wrench
/// even without regard to friction. From one stage to the next the forces jump, though the state is the same: other fingers hold; let them
/// pass over while everything rests. Cost: 0.1 ms for each program that is solved, one in some ten states.
pub fn grasp_forces(
    (hand, object, g_H): (&dyn Hand, &ObjectModel, Vec3),
    friction: Friction,
    stages: &[Stage<'_>],
    settings: &SimulationSettings,
) -> Result<Vec<Vec<Option<Held>>>, PhysicsError> {
    settings.validate()?;
    friction.validate()?;
    let one = |stage: &Stage<'_>| {
        let mut holder = Holder::new((hand, object, g_H), stage.friction(friction), settings);
        stage.states.iter().map(|q| holder.hold(q, stage.holding(q))).collect()
    };
    Ok(stages.iter().map(one).collect())
}
