//! The order in which fingers are regrasped one after the other, the object resting.

use crate::session::Session;
use crate::steps;
use regrasp_api::{CallError, Configuration, Context, FingerIndex, FingerSet, MAX_FINGERS, Task};
use regrasp_plan::Segment;

/// Depth-first search over the orders of the fingers.
///
/// What is left to move decides everything that comes, so sets of fingers are remembered: those from which no order
/// keeps the grasp stable and the fingers out of each other's places, found out first because it costs a hundredth of a finger's path, and
/// those from which the paths failed.
pub(crate) struct Order<'a> {
    session: &'a Session<'a>,
    task: &'a Task<'a>,
    from: &'a Configuration,
    to: &'a Configuration,
    /// Whether some order of the fingers in the set keeps the grasp stable, where it is known.
    hopeful: [Option<bool>; 256],
    /// For each finger those that it would touch where it goes, as long as they are where they were; where it is known.
    barring: [Option<FingerSet>; MAX_FINGERS],
    dead: [bool; 256],
    steps: Vec<Segment>,
}

impl<'a> Order<'a> {
    pub fn new(
        session: &'a Session<'a>,
        task: &'a Task<'a>,
        from: &'a Configuration,
        to: &'a Configuration,
    ) -> Self {
        Self {
            session,
            task,
            from,
            to,
            hopeful: [None; 256],
            barring: [None; MAX_FINGERS],
            dead: [false; 256],
            steps: Vec::new(),
        }
    }

    /// The regrasps in an order that works, if there is one.
    pub fn find(mut self, context: &mut Context<'_>) -> Result<Option<Vec<Segment>>, CallError> {
        let moved = steps::differing(self.from, self.to);
        Ok(if self.search(self.from, moved, context)? { Some(self.steps) } else { None })
    }

    fn search(
        &mut self,
        q: &Configuration,
        left: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        if left.is_empty() {
            return Ok(true);
        }
        if self.dead[usize::from(left.bits())] {
            return Ok(false);
        }
        for finger in left.iter() {
            context.proceed()?;
            if !self.is_hopeful(left, finger, context)? {
                continue;
            }
            let to = (finger, self.to);
            let Some(segment) = steps::regrasp(self.session, self.task, q, to, context)? else { continue };
            let next = segment.states.last().expect("a regrasp has two ends").clone();
            self.steps.push(segment);
            if self.search(&next, left.without(finger), context)? {
                return Ok(true);
            }
            self.steps.pop();
        }
        self.dead[usize::from(left.bits())] = true;
        Ok(false)
    }

    /// Whether `finger` of the fingers `left` may be lifted and set down, and some order of the rest be kept stable.
    fn is_hopeful(
        &mut self,
        left: FingerSet,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        let is_barred = !self.barring(finger).intersection(left).is_empty();
        Ok(!is_barred
            && self.may_lift(left, finger, context)?
            && self.some_order(left.without(finger), context)?)
    }

    /// The fingers that must go before `finger` can come to where it goes.
    fn barring(&mut self, finger: FingerIndex) -> FingerSet {
        if let Some(known) = self.barring[finger.index()] {
            return known;
        }
        let goes = (finger, &self.to.joints[finger]);
        let touches = |&other: &FingerIndex| {
            other != finger
                && self.task.clearance.fingers_free(goes, (other, &self.from.joints[other])).is_err()
        };
        let barring = self.from.joints.fingers().filter(touches).collect();
        self.barring[finger.index()] = Some(barring);
        barring
    }

    fn some_order(&mut self, left: FingerSet, context: &mut Context<'_>) -> Result<bool, CallError> {
        if left.is_empty() {
            return Ok(true);
        }
        if let Some(known) = self.hopeful[usize::from(left.bits())] {
            return Ok(known);
        }
        let mut hopeful = false;
        for finger in left.iter() {
            if self.is_hopeful(left, finger, context)? {
                hopeful = true;
                break;
            }
        }
        self.hopeful[usize::from(left.bits())] = Some(hopeful);
        Ok(hopeful)
    }

    /// Whether the other fingers hold the object while `finger` moves, those `left` where they were and the rest where they go.
    fn may_lift(
        &self,
        left: FingerSet,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        let mut q = self.from.clone();
        for other in q.contacts.fingers().filter(|&other| !left.contains(other)) {
            q.contacts[other] = self.to.contacts[other];
        }
        let rest = FingerSet::first(q.contacts.len()).without(finger);
        let grasp = self.task.grasp(&q, rest);
        let stability = self.task.stability;
        Ok(!grasp.contacts().is_empty()
            && stability.test(&grasp, &mut Default::default(), context)?.is_stable())
    }
}
