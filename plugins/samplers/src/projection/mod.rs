//! `sampler/projection`: random starts brought onto the closure manifold by Newton's method.
//!
//! A configuration with k fingers in contact satisfies k equations: the centre of each of these fingertips
//! lies on the offset surface, at the fingertip's radius from the object. A try draws pose and joints at
//! random, which satisfy none of them, and brings them onto that manifold by damped Gauss-Newton steps of
//! least norm, pose and joints together; joints are held within their limits and the pose within the request
//! by clamping. The contacts are where the fingertips come to touch. Fingers that cannot close, or whose
//! place is not admissible, are drawn anew and projected alone, the object at rest, before the try is given
//! up.
//!
//! It needs no inverse kinematics, and so serves any chain; spare joints are moved like all others. It
//! differs from the random loop generator in what it draws evenly: joints here, contacts there; parts of the
//! surface that a finger comes to from many postures are found more often. Where the pose is prescribed only
//! joints move.
//!
//! Sources: J. Yakey, S. LaValle, L. Kavraki, "Randomized path planning for linkages with closed kinematic
//! chains", IEEE T-RA 2001 (random starts brought to closure by descent); D. Berenson, S. Srinivasa, J.
//! Kuffner, "Task space regions: a framework for pose-constrained manipulation planning", IJRR 2011
//! (projection by the pseudo-inverse); Z. Kingston, M. Moll, L. Kavraki, "Sampling-based methods for motion
//! planning with constraints", Annual Review of Control, Robotics, and Autonomous Systems 2018, section 4.1
//! (survey). Departures: Levenberg and Marquardt's damping where a full step does not pay, and fingers
//! repaired one by one.

mod newton;

use crate::chains;
use crate::pose::{self, PoseLaw, Region};
use newton::{Newton, Unknowns};
use regrasp_api::{
    Build, CallError, ClosedChainSampler, Configuration, Contact, Context, Entry, FingerIndex, FingerJoints,
    FingerSet, PerFinger, Pose, PoseRequest, Random, Reason, Settings, SettingsError, Slot, Task,
    check_settings, inventory,
};
use serde::{Deserialize, Serialize};

/// Settings of [`ProjectionSampler`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ProjectionSettings {
    /// Random starts that one call tries.
    #[schemars(range(min = 1, max = 100_000))]
    pub starts: usize,
    /// Newton steps that bring one start onto the manifold.
    #[schemars(range(min = 1, max = 1000))]
    pub steps: usize,
    /// How often the joints of one finger are drawn at one pose before the start is given up.
    #[schemars(range(min = 1, max = 10_000))]
    pub draws: usize,
    /// How far (of the range of each joint) starts near a configuration may lie from its joints.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub near: f64,
    /// The fraction of starts with any orientation; the others start near the motion from start to goal.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub anywhere: f64,
    /// How far (degrees) the latter may turn away from that motion.
    #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "degrees"))]
    pub spread_deg: f64,
}

impl Default for ProjectionSettings {
    /// Our choices; poses are drawn as `sampler/rlg` does by default.
    fn default() -> Self {
        Self { starts: 100, steps: 12, draws: 30, near: 0.2, anywhere: 0.1, spread_deg: 30.0 }
    }
}

impl Settings for ProjectionSettings {}

/// Samples by projection onto the closure manifold.
#[derive(Clone, Copy, Debug)]
pub struct ProjectionSampler {
    settings: ProjectionSettings,
}

impl ProjectionSampler {
    /// A sampler with the given settings.
    pub fn new(settings: ProjectionSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    /// One random start, projected and repaired.
    fn try_start(
        &self,
        newton: &Newton<'_>,
        request: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Result<Configuration, Reason>, CallError> {
        let task = newton.task;
        let ProjectionSettings { anywhere, spread_deg, .. } = self.settings;
        let law = PoseLaw { anywhere, spread: spread_deg.to_radians() };
        let mut q = chains::at_rest(task, pose::draw(task, request, &law, &mut context.random));
        for finger in holding.iter() {
            q.joints[finger] = self.draw(task, request, finger, &mut context.random);
        }
        if newton.region != Region::Point {
            newton.close(&mut q, Unknowns::PoseAndJoints(holding));
        }
        if task.clearance.object_free(&q.X_HO).is_err() {
            return Ok(Err(Reason::Collision));
        }
        let mut placed = FingerSet::EMPTY;
        for finger in q.joints.fingers() {
            let refused = if holding.contains(finger) {
                self.place(newton, request, (&mut q, finger, placed), context)?
            } else {
                task.admissible.admit_finger(task, &q, finger, placed, context)?
            };
            if let Some(reason) = refused {
                return Ok(Err(reason));
            }
            placed = placed.with(finger);
        }
        Ok(task.admissible.admit_grasp(task, &q, context)?.map_or(Ok(q), Err))
    }

    /// Lets `finger` touch the resting object beside the fingers in `placed`: from its joints as they are,
    /// then from others.
    fn place(
        &self,
        newton: &Newton<'_>,
        request: PoseRequest<'_>,
        (q, finger, placed): (&mut Configuration, FingerIndex, FingerSet),
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let task = newton.task;
        if !chains::may_reach(task, &q.X_HO, finger, newton.turn_length) {
            return Ok(Some(Reason::Reach));
        }
        let mut last = Reason::Closure;
        for draw in 0..self.settings.draws {
            if draw > 0 {
                q.joints[finger] = self.draw(task, request, finger, &mut context.random);
            }
            match newton.touch(q, finger) {
                Ok(contact) => q.contacts[finger] = Some(contact),
                Err(reason) => {
                    last = reason;
                    continue;
                }
            }
            match task.admissible.admit_finger(task, q, finger, placed, context)? {
                None => return Ok(None),
                Some(reason) => last = reason,
            }
        }
        Ok(Some(last))
    }

    /// Joints to start from: anywhere within the limits, or near those of the configuration that the request
    /// names.
    fn draw(
        &self,
        task: &Task<'_>,
        request: PoseRequest<'_>,
        finger: FingerIndex,
        random: &mut Random,
    ) -> FingerJoints {
        let model = task.hand.finger(finger);
        let near = match request {
            PoseRequest::Near { configuration, .. } if configuration.contacts[finger].is_some() => {
                Some(configuration.joints[finger])
            }
            _ => None,
        };
        let mut joints = FingerJoints::zeros(model.joints.len());
        for (i, joint) in model.joints.iter().enumerate() {
            let (mut lower, mut upper) = (joint.lower, joint.upper);
            if let Some(near) = near {
                let reach = self.settings.near * (upper - lower);
                (lower, upper) = (lower.max(near[i] - reach), upper.min(near[i] + reach));
            }
            joints[i] = random.range(lower, upper);
        }
        task.hand.settle(finger, &mut joints);
        joints
    }
}

impl ClosedChainSampler for ProjectionSampler {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        context.count_call(Slot::Sampler);
        let (steps, turn_length) = (self.settings.steps, task.object.mesh.radius());
        let newton = Newton { task, steps, region: Region::of(task, &pose), turn_length };
        for _ in 0..self.settings.starts {
            context.proceed()?;
            match self.try_start(&newton, pose, holding, context)? {
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
        id: "sampler/projection",
        slots: &[Slot::Sampler],
        summary: "random pose and joints, brought onto the closure manifold by Newton's method",
        references: &[
            "J. Yakey, S. LaValle, L. Kavraki, Randomized path planning for linkages with closed kinematic \
                chains, IEEE T-RA 2001",
            "D. Berenson, S. Srinivasa, J. Kuffner, Task space regions: a framework for pose-constrained \
                manipulation planning, IJRR 2011",
            "Z. Kingston, M. Moll, L. Kavraki, Sampling-based methods for motion planning with constraints, \
                Annual Review of Control, Robotics, and Autonomous Systems 2018",
        ],
        schema: ProjectionSettings::schema,
        check: check_settings::<ProjectionSettings>,
        build: Build::Sampler(|json, _| {
            Ok(Box::new(ProjectionSampler::new(ProjectionSettings::from_json(json)?)?))
        }),
    }
}
