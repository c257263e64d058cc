//! A sampler: draws the posture of each finger, and lets it touch the object where its tip is nearest.

// ANCHOR: uses
use regrasp_api::{
    Build, CallError, ClosedChainSampler, Configuration, Contact, Context, Entry, FingerIndex, FingerJoints,
    FingerSet, PerFinger, Pose, PoseRequest, Random, Reason, Rotation, Settings, SettingsError, Slot, Task,
    Vec3, check_settings, slerp,
};
use serde::{Deserialize, Serialize};
// ANCHOR_END: uses

// ANCHOR: settings
/// Settings of [`FingersFirst`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FingersFirstSettings {
    /// Poses of the object that one call tries.
    #[schemars(range(min = 1, max = 100_000))]
    pub poses: usize,
    /// Postures that are tried for each finger at one pose.
    #[schemars(range(min = 1, max = 10_000))]
    pub postures: usize,
}

impl Default for FingersFirstSettings {
    fn default() -> Self {
        Self { poses: 100, postures: 10 }
    }
}

impl Settings for FingersFirstSettings {}

/// Fingers first, contacts after them.
#[derive(Clone, Copy, Debug)]
pub struct FingersFirst {
    settings: FingersFirstSettings,
}

impl FingersFirst {
    /// A sampler with checked settings.
    pub fn new(settings: FingersFirstSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }
}
// ANCHOR_END: settings

// ANCHOR: touch
/// A random posture of the finger, bent so that its tip touches the object where it is nearest; `None` if it
/// cannot be.
fn touch(
    task: &Task<'_>,
    X_HO: &Pose,
    finger: FingerIndex,
    random: &mut Random,
) -> Option<(FingerJoints, Contact)> {
    let drawn = posture(task, finger, random);
    let p_HF = task.hand.tip_center(finger, &drawn);
    let p_OF = X_HO.rotation.inverse() * (p_HF - X_HO.translation.vector);
    let contact = task.surface.project(&p_OF, None).contact;
    let p_HF = X_HO.rotation * contact.tip_center(task.hand.fingertip_radius()) + X_HO.translation.vector;
    let joints = task.hand.inverse(finger, &p_HF, &drawn)?;
    Some((joints, contact))
}

/// Every joint anywhere between its limits.
fn posture(task: &Task<'_>, finger: FingerIndex, random: &mut Random) -> FingerJoints {
    let models = &task.hand.finger(finger).joints;
    let mut joints = FingerJoints::zeros(models.len());
    for (joint, model) in joints.iter_mut().zip(models) {
        *joint = random.range(model.lower, model.upper);
    }
    task.hand.settle(finger, &mut joints);
    joints
}
// ANCHOR_END: touch

// ANCHOR: place
impl FingersFirst {
    /// Gives one finger a contact, beside the fingers already placed; the reason of the last failure if it
    /// finds none.
    fn place(
        &self,
        task: &Task<'_>,
        q: &mut Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let mut last = Reason::Reach;
        for _ in 0..self.settings.postures {
            let Some((joints, contact)) = touch(task, &q.X_HO, finger, &mut context.random) else { continue };
            (q.joints[finger], q.contacts[finger]) = (joints, Some(contact));
            match task.admissible.admit_finger(task, q, finger, placed, context)? {
                None => return Ok(None),
                Some(reason) => last = reason,
            }
        }
        Ok(Some(last))
    }
}
// ANCHOR_END: place

// ANCHOR: at
impl FingersFirst {
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
}
// ANCHOR_END: at

// ANCHOR: pose
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
            Pose::from_parts(p.into(), orientation(task, random))
        }
    }
}

/// Mostly near the motion between start and goal, where most of what a plan needs lies; now and then any.
fn orientation(task: &Task<'_>, random: &mut Random) -> Rotation {
    match task.landmarks {
        [from, to, ..] if random.unit() < 0.9 => {
            let between = slerp(&from.rotation, &to.rotation, random.unit());
            Rotation::from_scaled_axis(random.direction() * random.range(0.0, 0.5)) * between
        }
        _ => random.rotation(),
    }
}
// ANCHOR_END: pose

// ANCHOR: role
impl ClosedChainSampler for FingersFirst {
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
// ANCHOR_END: role

// ANCHOR: entry
/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "sampler/fingers-first",
    slots: &[Slot::Sampler],
    summary: "draws each finger's posture, and touches the object where its tip is nearest",
    references: &[
        "Cortés, Siméon, Laumond, A random loop generator for planning the motions of closed kinematic \
            chains using PRM methods, ICRA 2002",
    ],
    schema: FingersFirstSettings::schema,
    check: check_settings::<FingersFirstSettings>,
    build: Build::Sampler(|json, _parts| {
        Ok(Box::new(FingersFirst::new(FingersFirstSettings::from_json(json)?)?))
    }),
};
regrasp_api::inventory::submit! { ENTRY }
// ANCHOR_END: entry
