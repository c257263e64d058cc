//! The reference sampler: draw everything, keep what fits.

use crate::fixtures::to_hand;
use regrasp_api::{
    CallError, ClosedChainSampler, Configuration, Contact, Context, FingerIndex, FingerSet, PerFinger, Pose,
    PoseRequest, Random, Reason, Rotation, Slot, Task, Vec3,
};

/// Poses that one call tries, and contacts for each finger at one pose.
const POSES: usize = 40;
const CONTACTS: usize = 40;

/// Draws pose and contacts at random and closes the chains by inverse kinematics.
#[derive(Clone, Copy, Debug, Default)]
pub struct RejectionSampler;

impl RejectionSampler {
    fn place(
        self,
        task: &Task<'_>,
        q: &mut Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let model = task.hand.finger(finger);
        let mut last = Reason::Reach;
        for _ in 0..CONTACTS {
            let contact = task.surface.sample(&mut context.random);
            let p_HF = to_hand(&q.X_HO, &contact.tip_center(task.hand.fingertip_radius()));
            let Some(joints) = task.hand.inverse(finger, &p_HF, &model.rest) else { continue };
            (q.joints[finger], q.contacts[finger]) = (joints, Some(contact));
            match task.admissible.admit_finger(task, q, finger, placed, context)? {
                None => return Ok(None),
                Some(reason) => last = reason,
            }
        }
        Ok(Some(last))
    }

    fn attempt(
        self,
        task: &Task<'_>,
        X_HO: Pose,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Result<Configuration, Reason>, CallError> {
        let mut q = at_rest(task, X_HO);
        if task.clearance.object_free(&X_HO).is_err() {
            return Ok(Err(Reason::Collision));
        }
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
        Ok(match task.admissible.admit_grasp(task, &q, context)? {
            None => Ok(q),
            Some(reason) => Err(reason),
        })
    }
}

/// All fingers at rest, none in contact.
fn at_rest(task: &Task<'_>, X_HO: Pose) -> Configuration {
    let count = task.hand.finger_count();
    let joints = PerFinger::from_fn(count, |finger| task.hand.finger(finger).rest);
    Configuration { X_HO, joints, contacts: PerFinger::filled(count, None) }
}

fn draw(task: &Task<'_>, request: PoseRequest<'_>, random: &mut Random) -> Pose {
    let turn = |random: &mut Random, most: f64| {
        Rotation::from_scaled_axis(random.direction() * (most * random.unit()))
    };
    match request {
        PoseRequest::At(X_HO) => X_HO,
        PoseRequest::Near { configuration: near, radius, angle } => {
            let p = near.X_HO.translation.vector + random.direction() * (radius * random.unit());
            Pose::from_parts(p.into(), turn(random, angle) * near.X_HO.rotation)
        }
        PoseRequest::Anywhere => {
            let (lower, upper) = task.workspace;
            let p = Vec3::from_fn(|i, _| random.range(lower[i], upper[i]));
            Pose::from_parts(p.into(), random.rotation())
        }
    }
}

impl ClosedChainSampler for RejectionSampler {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        context.count_call(Slot::Sampler);
        for _ in 0..POSES {
            context.proceed()?;
            let X_HO = draw(task, pose, &mut context.random);
            match self.attempt(task, X_HO, holding, context)? {
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
