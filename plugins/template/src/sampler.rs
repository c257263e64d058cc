//! A sampler: draws a pose and contacts until inverse kinematics and the planner's predicate accept them.

use regrasp_api::{
    Build, CallError, ClosedChainSampler, Configuration, Contact, Context, Entry, FingerIndex, FingerSet,
    PerFinger, Pose, PoseRequest, Random, Reason, Rotation, Settings, SettingsError, Slot, Task, Vec3,
    check_settings, slerp,
};
use serde::{Deserialize, Serialize};

/// Settings of [`Rejection`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RejectionSettings {
    /// Poses of the object that one call tries.
    #[schemars(range(min = 1, max = 100_000))]
    pub poses: usize,
    /// Contacts that are tried for each finger at one pose.
    #[schemars(range(min = 1, max = 10_000))]
    pub contacts: usize,
}

impl Default for RejectionSettings {
    fn default() -> Self {
        Self { poses: 100, contacts: 50 }
    }
}

impl Settings for RejectionSettings {}

/// Draws until it fits.
#[derive(Clone, Copy, Debug)]
pub struct Rejection {
    settings: RejectionSettings,
}

impl Rejection {
    /// A sampler with checked settings.
    pub fn new(settings: RejectionSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    /// One try at one pose: the configuration, or why there is none.
    fn at(
        &self,
        task: &Task<'_>,
        X_HO: Pose,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Result<Configuration, Reason>, CallError> {
        if task.clearance.object_free(&X_HO).is_err() {
            return Ok(Err(Reason::Collision));
        }
        let count = task.hand.finger_count();
        let mut q = Configuration {
            X_HO,
            joints: PerFinger::from_fn(count, |finger| task.hand.finger(finger).rest),
            contacts: PerFinger::filled(count, None),
        };
        let mut placed = FingerSet::EMPTY;
        for finger in q.joints.fingers() {
            let refused = if holding.contains(finger) {
                self.place(task, &mut q, finger, placed, context)?
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

    /// Gives one finger a contact, beside the fingers already placed.
    fn place(
        &self,
        task: &Task<'_>,
        q: &mut Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let mut last = Reason::Reach;
        for _ in 0..self.settings.contacts {
            let contact = task.surface.sample(&mut context.random);
            q.contacts[finger] = Some(contact);
            let Some(joints) = reach(task, q, finger, &mut context.random) else { continue };
            q.joints[finger] = joints;
            match task.admissible.admit_finger(task, q, finger, placed, context)? {
                None => return Ok(None),
                Some(reason) => last = reason,
            }
        }
        Ok(Some(last))
    }
}

/// Joints that bring the finger to its contact, spare joints drawn at random.
fn reach(
    task: &Task<'_>,
    q: &Configuration,
    finger: FingerIndex,
    random: &mut Random,
) -> Option<regrasp_api::FingerJoints> {
    let model = task.hand.finger(finger);
    let mut near = model.rest;
    for &joint in &model.spare {
        near[joint] = random.range(model.joints[joint].lower, model.joints[joint].upper);
    }
    let p_HF = q.contact_tip_center(finger, task.hand.fingertip_radius())?;
    task.hand.inverse(finger, &p_HF, &near)
}

/// A pose of the object as it is asked for.
fn draw(task: &Task<'_>, request: PoseRequest<'_>, random: &mut Random) -> Pose {
    match request {
        PoseRequest::At(X_HO) => X_HO,
        PoseRequest::Near { configuration, radius, angle } => {
            let X_HO = &configuration.X_HO;
            let p = X_HO.translation.vector + random.direction() * (radius * random.unit());
            let turn = Rotation::from_scaled_axis(random.direction() * (angle * random.unit()));
            Pose::from_parts(p.into(), turn * X_HO.rotation)
        }
        PoseRequest::Anywhere => {
            let (lower, upper) = task.workspace;
            let p = Vec3::from_fn(|i, _| random.range(lower[i], upper[i]));
            let [from, to] = [0, 1].map(|i| task.landmarks.get(i));
            let R_HO = match (from, to) {
                // Most poses that a plan needs lie near the motion from start to goal.
                (Some(from), Some(to)) if random.unit() < 0.8 => {
                    let between = slerp(&from.rotation, &to.rotation, random.unit());
                    Rotation::from_scaled_axis(random.direction() * random.range(0.0, 0.5)) * between
                }
                _ => random.rotation(),
            };
            Pose::from_parts(p.into(), R_HO)
        }
    }
}

impl ClosedChainSampler for Rejection {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        context.count_call(Slot::Sampler);
        for _ in 0..self.settings.poses {
            context.proceed()?;
            let X_HO = draw(task, pose, &mut context.random);
            match self.at(task, X_HO, holding, context)? {
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
        let mut q = Configuration { X_HO: *X_HO, joints: near.joints, contacts: *contacts };
        for finger in q.joints.fingers() {
            let Some(p_HF) = q.contact_tip_center(finger, task.hand.fingertip_radius()) else { continue };
            let Some(joints) = task.hand.inverse(finger, &p_HF, &near.joints[finger]) else {
                context.reject(Slot::Sampler, Reason::Reach);
                return Ok(None);
            };
            q.joints[finger] = joints;
        }
        Ok(Some(q))
    }
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "sampler/template",
    slots: &[Slot::Sampler],
    summary: "draws a pose and contacts until they fit",
    references: &[
        "Han, Amato, A kinematics-based probabilistic roadmap method for closed chain systems, WAFR 2000",
    ],
    schema: RejectionSettings::schema,
    check: check_settings::<RejectionSettings>,
    build: Build::Sampler(|json, _parts| Ok(Box::new(Rejection::new(RejectionSettings::from_json(json)?)?))),
};
