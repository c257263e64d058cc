//! Which finger takes which contact of a grasp, the object resting at a pose.

use crate::chains;
use regrasp_api::{
    CallError, Configuration, Contact, Context, FingerIndex, FingerJoints, FingerSet, MAX_FINGERS, PerFinger,
    Pose, Reason, Task,
};

/// Draws of a redundant finger's spare joints for one contact.
const SPARE_DRAWS: usize = 4;

/// Depth-first search over the assignments of fingers to contacts.
pub(super) struct Assignment<'a> {
    task: &'a Task<'a>,
    q: Configuration,
    /// The contacts, named by the finger that each was drawn for.
    grasp: &'a PerFinger<Option<Contact>>,
    /// The contacts, as above, within each finger's ball of reach.
    within: [FingerSet; MAX_FINGERS],
    last: Reason,
}

impl<'a> Assignment<'a> {
    /// The object at `X_HO`, all fingers at rest.
    pub fn new(task: &'a Task<'a>, X_HO: Pose, grasp: &'a PerFinger<Option<Contact>>) -> Self {
        let mut all = Self {
            task,
            q: chains::at_rest(task, X_HO),
            grasp,
            within: [FingerSet::EMPTY; MAX_FINGERS],
            last: Reason::Reach,
        };
        for finger in all.holding().iter() {
            let model = task.hand.finger(finger);
            let near = |place: &FingerIndex| {
                (all.tip_center(*place) - model.p_HReach).norm_squared() <= model.reach * model.reach
            };
            all.within[finger.index()] = all.holding().iter().filter(near).collect();
        }
        all
    }

    /// The first assignment in which every finger may stay where it is; otherwise why the last one tried
    /// failed.
    pub fn find(mut self, context: &mut Context<'_>) -> Result<Result<Configuration, Reason>, CallError> {
        let found = self.search(FingerIndex(0), self.holding(), context)?;
        Ok(if found { Ok(self.q) } else { Err(self.last) })
    }

    fn holding(&self) -> FingerSet {
        self.grasp.iter().filter(|(_, contact)| contact.is_some()).map(|(finger, _)| finger).collect()
    }

    /// Where a fingertip at the contact of this place has its centre, in H (m).
    fn tip_center(&self, place: FingerIndex) -> regrasp_api::Vec3 {
        let contact = self.grasp[place].expect("places of the grasp have contacts");
        let p_OF = contact.tip_center(self.task.hand.fingertip_radius());
        self.q.X_HO.rotation * p_OF + self.q.X_HO.translation.vector
    }

    /// Gives `finger` and those after it the contacts `left`.
    fn search(
        &mut self,
        finger: FingerIndex,
        left: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        if finger.index() == self.q.joints.len() {
            return Ok(true);
        }
        let (next, placed) = (FingerIndex(finger.0 + 1), FingerSet::first(finger.index()));
        if !self.holding().contains(finger) {
            return Ok(self.admits(finger, placed, context)? && self.search(next, left, context)?);
        }
        for place in left.intersection(self.within[finger.index()]).iter() {
            if !self.is_hopeful(next, left.without(place)) {
                continue;
            }
            if self.puts(finger, place, placed, context)?
                && self.search(next, left.without(place), context)?
            {
                return Ok(true);
            }
        }
        self.q.contacts[finger] = None;
        Ok(false)
    }

    /// Whether each of the fingers from `first` on has a contact of `left` within its ball of reach.
    fn is_hopeful(&self, first: FingerIndex, left: FingerSet) -> bool {
        let rest = self.holding().iter().filter(|finger| *finger >= first);
        rest.into_iter().all(|finger| !self.within[finger.index()].intersection(left).is_empty())
    }

    /// Puts `finger` on the contact of this place, if it can reach it and stay there.
    fn puts(
        &mut self,
        finger: FingerIndex,
        place: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        let p_HF = self.tip_center(place);
        let spare = self.task.hand.finger(finger).spare.len();
        for _ in 0..if spare == 0 { 1 } else { SPARE_DRAWS } {
            let near = self.spare_drawn(finger, context);
            let Some(joints) = self.task.hand.inverse(finger, &p_HF, &near) else {
                self.last = Reason::Reach;
                continue;
            };
            (self.q.joints[finger], self.q.contacts[finger]) = (joints, self.grasp[place]);
            if self.admits(finger, placed, context)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn admits(
        &mut self,
        finger: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        let refused = self.task.admissible.admit_finger(self.task, &self.q, finger, placed, context)?;
        self.last = refused.unwrap_or(self.last);
        Ok(refused.is_none())
    }

    /// The finger's rest posture with its spare joints drawn within their limits.
    fn spare_drawn(&self, finger: FingerIndex, context: &mut Context<'_>) -> FingerJoints {
        let model = self.task.hand.finger(finger);
        let mut near = model.rest;
        for &joint in &model.spare {
            near[joint] = context.random.range(model.joints[joint].lower, model.joints[joint].upper);
        }
        near
    }
}
