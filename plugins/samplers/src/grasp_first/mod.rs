//! `sampler/grasp-first`: a stable grasp of the object first, then a pose at which the hand reaches it.
//!
//! 1. Contacts are drawn on the object's surface, away from sharp edges, until the grasp that they make is
//!    stable and can be left (as the planner's predicate for grasps says): nothing of hand or pose matters
//!    yet, and a stability test costs about a microsecond.
//! 2. Poses are drawn as the request wants them. At each, fingers are assigned to contacts by depth-first
//!    search: which of them a finger can reach, by its ball of reach first, then by inverse kinematics, with
//!    all checks that admit a finger.
//! 3. The grasp is checked once more, since tests that know gravity depend on the pose.
//!
//! It turns the order of the random loop generator round, in the manner of grasp planning before motion
//! planning. It pays where few contacts make a stable grasp (little friction, thin or faceted objects) and
//! the hand reaches most of the object; where the hand reaches little of it, most grasps are drawn in vain.
//! Where the pose is prescribed, each grasp has only one chance.
//!
//! Sources: R. Diankov, "Automated construction of robotic manipulation programs", PhD thesis, CMU 2010,
//! chapter 4 (stable grasps kept apart from the arm, then filtered by reach); J.-P. Saut, D. Sidobre,
//! "Efficient models for grasp planning with a multi-fingered hand", Robotics and Autonomous Systems 2012
//! (contacts, stability, then inverse kinematics of the fingers). Departure: nothing is stored between calls,
//! so that each sample depends on its random stream alone.

mod assign;

use crate::chains;
use crate::pose::{self, PoseLaw};
use assign::Assignment;
use regrasp_api::{
    Build, CallError, ClosedChainSampler, Configuration, Contact, Context, Entry, FingerSet, PerFinger, Pose,
    PoseRequest, Reason, Settings, SettingsError, Slot, Task, check_settings, inventory,
};
use serde::{Deserialize, Serialize};

/// Contacts drawn for one place of a grasp before a smooth part of the surface is given up.
const EDGE_DRAWS: usize = 100;

/// Settings of [`GraspFirst`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GraspFirstSettings {
    /// Grasps of the object that one call draws, stable or not.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub grasps: usize,
    /// Poses that are tried for each stable grasp; one where the request prescribes it.
    #[schemars(range(min = 1, max = 10_000))]
    pub poses: usize,
    /// The fraction of poses drawn with any orientation; the others are drawn near the motion from start to
    /// goal.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub anywhere: f64,
    /// How far (degrees) the latter may turn away from that motion.
    #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "degrees"))]
    pub spread_deg: f64,
}

impl Default for GraspFirstSettings {
    /// Our choices; poses are drawn as `sampler/rlg` does by default.
    fn default() -> Self {
        Self { grasps: 2000, poses: 10, anywhere: 0.1, spread_deg: 30.0 }
    }
}

impl Settings for GraspFirstSettings {}

/// Samples a stable grasp first, then the pose.
#[derive(Clone, Copy, Debug)]
pub struct GraspFirst {
    settings: GraspFirstSettings,
}

impl GraspFirst {
    /// A sampler with the given settings.
    pub fn new(settings: GraspFirstSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    fn draw_pose(&self, task: &Task<'_>, request: PoseRequest<'_>, context: &mut Context<'_>) -> Pose {
        let GraspFirstSettings { anywhere, spread_deg, .. } = self.settings;
        let law = PoseLaw { anywhere, spread: spread_deg.to_radians() };
        pose::draw(task, request, &law, &mut context.random)
    }

    /// Contacts, one for each finger of `holding`, that make an admissible grasp wherever the hand is; or why
    /// not.
    fn draw_grasp(
        &self,
        task: &Task<'_>,
        X_HO: Pose,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Result<PerFinger<Option<Contact>>, Reason>, CallError> {
        let mut q = chains::at_rest(task, X_HO);
        for finger in holding.iter() {
            let smooth =
                |contact: &Contact| task.surface.edge_distance(contact) >= task.resolution.edge_margin;
            let mut draws = (0..EDGE_DRAWS).map(|_| task.surface.sample(&mut context.random));
            let Some(contact) = draws.find(smooth) else { return Ok(Err(Reason::Edge)) };
            q.contacts[finger] = Some(contact);
        }
        Ok(task.admissible.admit_grasp(task, &q, context)?.map_or(Ok(q.contacts), Err))
    }

    /// The grasp in the hand, the object at the pose; or why not.
    fn take(
        &self,
        task: &Task<'_>,
        X_HO: Pose,
        grasp: &PerFinger<Option<Contact>>,
        context: &mut Context<'_>,
    ) -> Result<Result<Configuration, Reason>, CallError> {
        if task.clearance.object_free(&X_HO).is_err() {
            return Ok(Err(Reason::Collision));
        }
        let q = match Assignment::new(task, X_HO, grasp).find(context)? {
            Ok(q) => q,
            Err(reason) => return Ok(Err(reason)),
        };
        Ok(task.admissible.admit_grasp(task, &q, context)?.map_or(Ok(q), Err))
    }
}

impl ClosedChainSampler for GraspFirst {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        context.count_call(Slot::Sampler);
        let radius = task.object.mesh.radius();
        let poses = if matches!(pose, PoseRequest::At(_)) { 1 } else { self.settings.poses };
        for _ in 0..self.settings.grasps {
            context.proceed()?;
            let mut X_HO = self.draw_pose(task, pose, context);
            if !holding.iter().all(|finger| chains::may_reach(task, &X_HO, finger, radius)) {
                context.reject(Slot::Sampler, Reason::Reach);
                continue;
            }
            let grasp = match self.draw_grasp(task, X_HO, holding, context)? {
                Ok(grasp) => grasp,
                Err(reason) => {
                    context.reject(Slot::Sampler, reason);
                    continue;
                }
            };
            for tried in 0..poses {
                if tried > 0 {
                    X_HO = self.draw_pose(task, pose, context);
                }
                match self.take(task, X_HO, &grasp, context)? {
                    Ok(q) => return Ok(Some(q)),
                    Err(reason) => context.reject(Slot::Sampler, reason),
                };
            }
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
        id: "sampler/grasp-first",
        slots: &[Slot::Sampler],
        summary: "a stable grasp of the object first, then a pose at which the hand reaches it",
        references: &[
            "R. Diankov, Automated construction of robotic manipulation programs, PhD thesis, CMU 2010, \
                chapter 4",
            "J.-P. Saut, D. Sidobre, Efficient models for grasp planning with a multi-fingered hand, \
                Robotics and Autonomous Systems 2012",
        ],
        schema: GraspFirstSettings::schema,
        check: check_settings::<GraspFirstSettings>,
        build: Build::Sampler(|json, _| Ok(Box::new(GraspFirst::new(GraspFirstSettings::from_json(json)?)?))),
    }
}
