//! `local-planner/rapier-checked`: the transfer that rolling finds, simulated, and refused if the object
//! strays or a finger slips.
//!
//! Rolling is kinematics: it knows where the fingertips must be, and that a force exists that holds the
//! object there. Whether fingers with motors of a finite stiffness, joints of a limited effort and contacts
//! that only friction holds really carry the object through is asked here: see `regrasp_physics` for what is
//! simulated and what is left out.
//!
//! Rapier's contacts transmit no torque about their normal. A contact model that counts on one
//! (`soft-finger`) is refused with that reason.
//!
//! ```toml
//! [plugins."local-planner.transfer"]
//! use = "local-planner/rapier-checked"
//! settings = { max_distance = 0.002, mass = 0.2 }
//! ```

mod settings;

use crate::rolling::Rolling;
use crate::transfer::demand_fingertip;
use regrasp_api::{
    Build, BuildError, CallError, Cone, Configuration, Context, Entry, Fingertip, LocalPlanner, Parts, Path,
    Pose, Reached, Reason, Settings, Slot, Target, Task, angle_between, check_settings,
};
use regrasp_physics::{Happening, Outcome, TransferSimulator};
pub use settings::RapierCheckedSettings;

const ID: &str = "local-planner/rapier-checked";
const SLOT: Slot = Slot::TransferPlanner;

/// Rolls as [`Rolling`] does, then simulates the motion with the hand as jointed bodies driven by motors and
/// the object free under gravity.
///
/// Refused with `stray` where the object leaves its planned pose by more than the bounds, with `slip` where a
/// fingertip slips or loses the object, with `stability` where no forces within cones and joint efforts hold
/// the object. What was refused is cut to half of what went well and simulated again a few times: every
/// motion that is returned was itself simulated to its end and held there for a moment. What stops
/// [`Rolling`] stops this planner too.
///
/// Cost: about a millisecond for each degree that the object turns, a thousand times that of rolling alone.
pub struct RapierChecked {
    settings: RapierCheckedSettings,
    rolling: Rolling,
    simulator: TransferSimulator,
}

impl RapierChecked {
    /// A planner with these settings for this hand and object, or why they are refused.
    pub fn new(settings: RapierCheckedSettings, parts: &Parts<'_>) -> Result<Self, BuildError> {
        settings.validate()?;
        demand_fingertip(Fingertip::Ball, parts.hand)?;
        let rolling = Rolling::new(settings.rolling, parts.hand)?;
        let simulator = TransferSimulator::new(settings.simulation(), parts.object)
            .map_err(|error| BuildError::Unsupported(error.to_string()))?;
        Ok(Self { settings, rolling, simulator })
    }

    fn simulate(&self, task: &Task<'_>, states: &[Configuration], mu: f64) -> Outcome {
        let Task { hand, object, g_H, .. } = *task;
        let (pace, bounds) = (self.settings.pace(), self.settings.bounds());
        self.simulator.simulate((hand, object, g_H), states, &pace, mu, &bounds)
    }

    /// How many of the states pass the simulation, and why not all; `None` where all do.
    fn cut(
        &self,
        task: &Task<'_>,
        states: &[Configuration],
        mu: f64,
        context: &Context<'_>,
    ) -> Result<Option<(usize, Reason)>, CallError> {
        let Some(failure) = self.simulate(task, states, mu).failure else { return Ok(None) };
        let reason = reason(failure.what);
        let mut last = failure.state / 2;
        for _ in 0..self.settings.retries {
            context.proceed()?;
            if last == 0 {
                break;
            }
            match self.simulate(task, &states[..=last], mu).failure {
                None => return Ok(Some((last + 1, reason))),
                Some(failure) => last = failure.state / 2,
            }
        }
        Ok(Some((1, reason)))
    }
}

impl LocalPlanner for RapierChecked {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        context.count_call(SLOT);
        let mu = friction(task, from)?;
        let mut own = Path::default();
        let path = path.unwrap_or(&mut own);
        let mut reached = self.rolling.roll(task, from, to, Some(path), context)?;
        let cut = if path.states.len() < 2 { None } else { self.cut(task, &path.states, mu, context)? };
        let (Some((count, reason)), Target::Transfer(to)) = (cut, to) else {
            reached.stop = reached.stop.map(|reason| context.reject(SLOT, reason));
            return Ok(reached);
        };
        path.states.truncate(count);
        let end = path.states.last().expect("at least the start is kept").clone();
        let fraction = if count == 1 { 0.0 } else { fraction(&from.X_HO, &end.X_HO, to) };
        Ok(Reached { end, fraction, stop: Some(context.reject(SLOT, reason)) })
    }
}

/// The friction coefficient to plan forces with: the smallest of the contacts' cones.
///
/// Polyhedral cones stand for the round one inside which forces are sought.
fn friction(task: &Task<'_>, q: &Configuration) -> Result<f64, CallError> {
    let mut least = task.planning_friction();
    for (finger, contact) in q.contacts.iter() {
        let Some(contact) = contact else { continue };
        let cone = task.contact_model.cone(finger, contact, task.planning_friction());
        if cone.carries_torsion() {
            let reason = regrasp_physics::PhysicsError::Torsion.to_string();
            return Err(CallError::Unsupported { plugin: ID.into(), reason });
        }
        match cone {
            Cone::Elliptic { mu, .. } => least = least.min(mu),
            Cone::Grained(grain) => least = least.min(grain.mu[0]).min(grain.mu[1]),
            Cone::Polyhedral(_) => {}
        }
    }
    Ok(least)
}

fn reason(what: Happening) -> Reason {
    match what {
        Happening::NoGrip => Reason::Stability,
        Happening::Slip(_) | Happening::Lift(_) => Reason::Slip,
        _ => Reason::Stray,
    }
}

/// How far `at` is on the straight motion, in [0, 1): metres and radians grow in proportion.
fn fraction(from: &Pose, at: &Pose, to: &Pose) -> f64 {
    let way = |a: &Pose, b: &Pose| {
        (b.translation.vector - a.translation.vector).norm() + angle_between(&a.rotation, &b.rotation)
    };
    (way(from, at) / way(from, to)).clamp(0.0, 1.0 - f64::EPSILON)
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[SLOT],
        summary: "rolling, then simulated in rapier3d: refused if the object strays or a fingertip slips",
        references: &[
            "A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation \
                planning, SSD 2007",
            "S. Boyd, B. Wegbreit, Fast computation of optimal contact forces, IEEE T-RO 2007",
            "J. K. Salisbury, Active stiffness control of a manipulator in Cartesian coordinates, CDC 1980",
            "Dimforge, Rapier, a physics engine in Rust, version 0.36",
        ],
        schema: RapierCheckedSettings::schema,
        check: check_settings::<RapierCheckedSettings>,
        build: Build::LocalPlanner(|json, parts| {
            Ok(Box::new(RapierChecked::new(RapierCheckedSettings::from_json(json)?, parts)?))
        }),
    }
}
