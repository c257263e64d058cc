//! The forces of a whole motion.

use crate::drag::spins;
use crate::force::Friction;
use crate::hold::{Held, Holder};
use crate::settings::check;
use crate::{PhysicsError, SimulationSettings, Stage};
use regrasp_api::{Configuration, Hand, ObjectModel, PerFinger, Vec3};

/// The forces that hold the object in every state of a motion, stage by stage: those that a state brings, or
/// else those that need least of the friction within the joints' efforts.
///
/// `friction` is what there is: the object's, or what a plan claims. Of the settings only `grip` and
/// `effort_share` matter. `g_H` is the acceleration of gravity (m/s², in H). A state's entry is `None` where
/// no forces hold the object, whatever the friction. From one stage to the next the forces jump, though the
/// state is the same: other fingers hold; let them pass over while everything rests. Any blend of the two is
/// balanced, within the cones and the efforts, since all of these are convex.
pub fn grasp_forces(
    (hand, object, g_H): (&dyn Hand, &ObjectModel, Vec3),
    friction: Friction,
    stages: &[Stage<'_>],
    settings: &SimulationSettings,
) -> Result<Vec<Vec<Option<Held>>>, PhysicsError> {
    settings.validate()?;
    friction.validate()?;
    let one = |stage: &Stage<'_>| {
        let holder = Holder::new((hand, object, g_H), stage.friction(friction), settings);
        holder.stage(stage)
    };
    Ok(stages.iter().map(one).collect())
}

/// The same where contacts with torsional friction drag while they spin, as they do in every transfer: there
/// forces are chosen that balance the drag too, and none that a state brings is taken.
///
/// A spinning contact's torque ([`crate::ContactForce::spin`]) is its normal force times the torsional
/// radius, in the direction of its spin, built up over the first 0.02 rad of it.
pub fn dragged_forces(
    (hand, object, g_H): (&dyn Hand, &ObjectModel, Vec3),
    friction: Friction,
    stages: &[Stage<'_>],
    settings: &SimulationSettings,
) -> Result<Vec<Vec<Option<Held>>>, PhysicsError> {
    settings.validate()?;
    friction.validate()?;
    let one = |stage: &Stage<'_>| {
        let holder = Holder::new((hand, object, g_H), stage.friction(friction), settings);
        if stage.moving.is_some() || !friction.has_torsion() {
            return holder.stage(stage);
        }
        let part = |spins: &PerFinger<(f64, f64)>| {
            PerFinger::from_fn(spins.len(), |finger| spins[finger].0 * friction.gamma)
        };
        holder.choose(stage, &spins(hand, stage).iter().map(part).collect::<Vec<_>>())
    };
    Ok(stages.iter().map(one).collect())
}

/// The forces by which the fingers that touch hold the object in one grasp at rest.
///
/// The analytic centre of those that need at most `share` (0.01 to 1) of the friction, within the joints'
/// efforts; where there are none, of those that need little more than the least (which is known to a tenth);
/// `None` where that is more than `settings.relied`, or beyond the efforts. The arguments are those of
/// [`grasp_forces`], which is what to ask along a motion: there forces must be continuous.
pub fn grasp_forces_at(
    (hand, object, g_H): (&dyn Hand, &ObjectModel, Vec3),
    friction: Friction,
    q: &Configuration,
    share: f64,
    settings: &SimulationSettings,
) -> Result<Option<Held>, PhysicsError> {
    settings.validate()?;
    friction.validate()?;
    check("share", share, 0.01, 1.0)?;
    Ok(Holder::new((hand, object, g_H), friction, settings).one(q, share))
}
