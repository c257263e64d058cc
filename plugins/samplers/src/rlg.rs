//! `sampler/rlg`: the random loop generator.
//!
//! Each loop finger-object-palm is split in an *active* part, drawn at random, and a *passive* part, solved
//! by inverse kinematics: active are the object's pose, the contacts and the spare joints of redundant
//! fingers; passive are the three joints that bring each fingertip to its contact (J. Cortés, T. Siméon,
//! J.-P. Laumond, "A random loop generator for planning the motions of closed kinematic chains using PRM
//! methods", ICRA 2002).
//!
//! Contacts are drawn by rejection, the cheapest test first: a fingertip outside the ball that the finger can
//! reach costs a few nanoseconds, so that about thirty tries a finger are cheaper than listing the facets
//! within reach. Where the pose is given, contacts that were found for one finger are combined with those of
//! the others many times (`pools`).

use crate::chains;
use crate::pools::Pools;
use crate::pose::{self, PoseLaw};
use regrasp_api::{
    Build, CallError, ClosedChainSampler, Configuration, Contact, Context, Entry, FingerIndex, FingerSet,
    PerFinger, Pose, PoseRequest, Reason, Settings, SettingsError, Slot, Task, check_settings, inventory,
};
use serde::{Deserialize, Serialize};

/// Settings of [`Rlg`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RlgSettings {
    /// Poses of the object that one call tries.
    #[schemars(range(min = 1, max = 100_000))]
    pub poses: usize,
    /// Contacts that are tried for each finger at one pose.
    #[schemars(range(min = 1, max = 10_000))]
    pub contacts: usize,
    /// The fraction of poses drawn with any orientation; the others are drawn near the motion from start to
    /// goal.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub anywhere: f64,
    /// How far (degrees) the latter may turn away from that motion.
    #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "degrees"))]
    pub spread_deg: f64,
}

impl Default for RlgSettings {
    /// Our choices: the paper names no numbers.
    fn default() -> Self {
        Self { poses: 100, contacts: 30, anywhere: 0.1, spread_deg: 30.0 }
    }
}

impl Settings for RlgSettings {}

/// The random loop generator.
#[derive(Clone, Copy, Debug)]
pub struct Rlg {
    settings: RlgSettings,
}

impl Rlg {
    /// A sampler with the given settings.
    pub fn new(settings: RlgSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    /// One try at one pose of the object.
    fn try_pose(
        &self,
        task: &Task<'_>,
        X_HO: Pose,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Result<Configuration, Reason>, CallError> {
        if task.clearance.object_free(&X_HO).is_err() {
            return Ok(Err(Reason::Collision));
        }
        let mut q = chains::at_rest(task, X_HO);
        let mut placed = FingerSet::EMPTY;
        for finger in q.joints.fingers() {
            let reason = if holding.contains(finger) {
                self.place(task, &mut q, finger, placed, context)?
            } else {
                task.admissible.admit_finger(task, &q, finger, placed, context)?
            };
            if let Some(reason) = reason {
                return Ok(Err(reason));
            }
            placed = placed.with(finger);
        }
        Ok(match task.admissible.admit_grasp(task, &q, context)? {
            None => Ok(q),
            Some(reason) => Err(reason),
        })
    }

    /// A grasp at a given pose: `poses` rounds, each of which looks for one more contact of each finger and
    /// tries combinations.
    fn sample_at(
        &self,
        task: &Task<'_>,
        X_HO: Pose,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        if task.clearance.object_free(&X_HO).is_err() {
            context.reject(Slot::Sampler, Reason::Collision);
            return Ok(None);
        }
        let resting = chains::at_rest(task, X_HO);
        let mut pools = Pools::new(holding, resting.joints.len());
        for _ in 0..self.settings.poses {
            context.proceed()?;
            let mut missing = None;
            for finger in holding.iter() {
                let mut q = resting.clone();
                match (self.place(task, &mut q, finger, FingerSet::EMPTY, context)?, q.contacts[finger]) {
                    (None, Some(contact)) => pools.add(finger, contact, q.joints[finger]),
                    (reason, _) => missing = reason.or(missing),
                }
            }
            match pools.combine(task, &resting, context)? {
                Ok(q) => return Ok(Some(q)),
                Err(reason) => context.reject(Slot::Sampler, missing.unwrap_or(reason)),
            };
        }
        Ok(None)
    }

    /// Gives `finger` a contact beside the fingers already placed; the reason of the last failure if it finds
    /// none.
    fn place(
        &self,
        task: &Task<'_>,
        q: &mut Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let mut near = task.hand.finger(finger).rest;
        let mut last = Reason::Reach;
        for _ in 0..self.settings.contacts {
            let touch = task.draw_touch(finger, &q.X_HO, &mut near, &mut context.random);
            let Some((contact, joints)) = touch else { continue };
            (q.joints[finger], q.contacts[finger]) = (joints, Some(contact));
            match task.admissible.admit_finger(task, q, finger, placed, context)? {
                None => return Ok(None),
                Some(reason) => last = reason,
            }
        }
        Ok(Some(last))
    }
}

impl ClosedChainSampler for Rlg {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        context.count_call(Slot::Sampler);
        if let PoseRequest::At(X_HO) = pose {
            return self.sample_at(task, X_HO, holding, context);
        }
        let RlgSettings { anywhere, spread_deg, .. } = self.settings;
        let law = PoseLaw { anywhere, spread: spread_deg.to_radians() };
        for _ in 0..self.settings.poses {
            context.proceed()?;
            let X_HO = pose::draw(task, pose, &law, &mut context.random);
            match self.try_pose(task, X_HO, holding, context)? {
                Ok(q) => return Ok(Some(q)),
                Err(reason) => context.reject(Slot::Sampler, reason),
            };
        }
        Ok(None)
    }

    fn close(
        &self,
        task: &Task<'_>,
        X_HO: &Pose,
        contacts: &PerFinger<Option<Contact>>,
        near: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        Ok(chains::close(task, X_HO, contacts, near, context))
    }
}

inventory::submit! {
    Entry {
        id: "sampler/rlg",
        slots: &[Slot::Sampler],
        summary: "random loop generator: pose and contacts drawn, joints by inverse kinematics",
        references: &[
            "J. Cortés, T. Siméon, J.-P. Laumond, A random loop generator for planning the motions of \
             closed kinematic chains using PRM methods, ICRA 2002",
        ],
        schema: RlgSettings::schema,
        check: check_settings::<RlgSettings>,
        build: Build::Sampler(|json, _| Ok(Box::new(Rlg::new(RlgSettings::from_json(json)?)?))),
    }
}
