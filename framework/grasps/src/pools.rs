//! At one pose of the object: the contacts that each finger can have, found once and combined many times.

use regrasp_api::{
    CallError, Configuration, Contact, Context, FingerIndex, FingerJoints, FingerSet, MAX_FINGERS, PerFinger,
    Pose, Reason, Task,
};

/// Contacts of one finger that are drawn at a pose.
const DRAWS: usize = 40;
/// Contacts of one finger that are enough.
const ENOUGH: usize = 6;

/// What a finger does: touches, or rests.
pub(crate) type Posture = (Option<Contact>, FingerJoints);

/// The postures that each finger may take at one pose, it alone beside object, palm and obstacles.
pub(crate) struct Pools {
    /// The hand at rest.
    pub resting: Configuration,
    /// For each finger the postures that touch.
    touching: [Vec<Posture>; MAX_FINGERS],
    /// The fingers that may rest.
    pub restful: FingerSet,
}

impl Pools {
    /// Looks for contacts of the fingers in `near`; `Err` says why there are none of `fewest` fingers.
    pub fn find(
        task: &Task<'_>,
        X_HO: Pose,
        near: FingerSet,
        fewest: usize,
        context: &mut Context<'_>,
    ) -> Result<Result<Self, Reason>, CallError> {
        let count = task.hand.finger_count();
        let resting = Configuration {
            X_HO,
            joints: PerFinger::from_fn(count, |finger| task.hand.finger(finger).rest),
            contacts: PerFinger::filled(count, None),
        };
        let mut pools = Self { resting, touching: Default::default(), restful: FingerSet::EMPTY };
        let (mut missing, mut able) = (Reason::Reach, near.len());
        for finger in near.iter() {
            if able < fewest {
                return Ok(Err(missing));
            }
            let last = pools.fill(task, finger, context)?;
            if pools.touching[finger.index()].is_empty() {
                (missing, able) = (last, able - 1);
            }
        }
        if able < fewest {
            return Ok(Err(missing));
        }
        for finger in FingerSet::first(count).iter() {
            let resting = &pools.resting;
            if task.admissible.admit_finger(task, resting, finger, FingerSet::EMPTY, context)?.is_none() {
                pools.restful = pools.restful.with(finger);
            }
        }
        Ok(Ok(pools))
    }

    /// Draws contacts of one finger; why the last that was refused was.
    fn fill(
        &mut self,
        task: &Task<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<Reason, CallError> {
        let near = task.hand.finger(finger).rest;
        let (mut q, mut near, mut last) = (self.resting.clone(), near, Reason::Reach);
        for _ in 0..DRAWS {
            let touch = task.draw_touch(finger, &q.X_HO, &mut near, &mut context.random);
            let Some((contact, joints)) = touch else { continue };
            (q.joints[finger], q.contacts[finger]) = (joints, Some(contact));
            match task.admissible.admit_finger(task, &q, finger, FingerSet::EMPTY, context)? {
                Some(reason) => last = reason,
                None => {
                    let found = &mut self.touching[finger.index()];
                    found.push((Some(contact), joints));
                    if found.len() == ENOUGH {
                        break;
                    }
                }
            }
        }
        Ok(last)
    }

    /// The postures in which the finger touches.
    pub fn touching(&self, finger: FingerIndex) -> &[Posture] {
        &self.touching[finger.index()]
    }

    /// The fingers that have any.
    pub fn able(&self) -> FingerSet {
        FingerSet::first(self.resting.joints.len()).iter().filter(|f| !self.touching(*f).is_empty()).collect()
    }
}
