//! The order in which fingers are regrasped one after the other, the object resting.

use crate::segments::{differing, end};
use crate::session::Work;
use regrasp_api::{CallError, Configuration, FingerIndex, FingerSet, MAX_FINGERS, Path, Target};
use regrasp_plan::{Segment, SegmentKind};

/// Moves the fingers one after the other from `from` to the contacts of `to`, the object resting; `None` if
/// no order works.
pub(crate) fn regrasp_all(
    work: &mut Work<'_>,
    from: &Configuration,
    to: &Configuration,
) -> Result<Option<Vec<Segment>>, CallError> {
    Order::new(from, to).find(work)
}

/// Whether some order of the fingers may work, as far as stability and the fingers' places tell.
pub(crate) fn has_order(
    work: &mut Work<'_>,
    from: &Configuration,
    to: &Configuration,
) -> Result<bool, CallError> {
    Order::new(from, to).some_order(work, differing(from, to))
}

/// One finger moves from `q` to its contact and joints of `to`; `None` if it cannot.
fn regrasp(
    work: &mut Work<'_>,
    q: &Configuration,
    (finger, to): (FingerIndex, &Configuration),
) -> Result<Option<Segment>, CallError> {
    let mut path = Path::default();
    let target =
        Target::Regrasp { finger, contact: to.contacts[finger].as_ref(), joints: &to.joints[finger] };
    let reached = work.plugins.regrasp.connect(work.task, q, &target, Some(&mut path), &mut work.context)?;
    let segment = || Segment::new(SegmentKind::Regrasp(finger), path.states);
    Ok(reached.is_complete().then(segment))
}

/// Depth-first search over the orders of the fingers.
///
/// What is left to move decides everything that comes, so sets of fingers are remembered: those from which no
/// order keeps the grasp stable and the fingers out of each other's places, found out first because it costs
/// a hundredth of a finger's path, and those from which the paths failed.
struct Order<'a> {
    from: &'a Configuration,
    to: &'a Configuration,
    /// Whether some order of the fingers in the set keeps the grasp stable, where it is known.
    hopeful: [Option<bool>; 256],
    /// For each finger those that it would touch where it goes, as long as they are where they were; where it
    /// is known.
    barring: [Option<FingerSet>; MAX_FINGERS],
    dead: [bool; 256],
    steps: Vec<Segment>,
}

impl<'a> Order<'a> {
    fn new(from: &'a Configuration, to: &'a Configuration) -> Self {
        Self {
            from,
            to,
            hopeful: [None; 256],
            barring: [None; MAX_FINGERS],
            dead: [false; 256],
            steps: Vec::new(),
        }
    }

    /// The regrasps in an order that works, if there is one.
    fn find(mut self, work: &mut Work<'_>) -> Result<Option<Vec<Segment>>, CallError> {
        let moved = differing(self.from, self.to);
        Ok(if self.search(work, self.from, moved)? { Some(self.steps) } else { None })
    }

    fn search(&mut self, work: &mut Work<'_>, q: &Configuration, left: FingerSet) -> Result<bool, CallError> {
        if left.is_empty() {
            return Ok(true);
        }
        if self.dead[usize::from(left.bits())] {
            return Ok(false);
        }
        for finger in left.iter() {
            work.context.proceed()?;
            if !self.is_hopeful(work, left, finger)? {
                continue;
            }
            let to = (finger, self.to);
            let Some(segment) = regrasp(work, q, to)? else { continue };
            let next = end(&segment).clone();
            self.steps.push(segment);
            if self.search(work, &next, left.without(finger))? {
                return Ok(true);
            }
            self.steps.pop();
        }
        self.dead[usize::from(left.bits())] = true;
        Ok(false)
    }

    /// Whether `finger` of the fingers `left` may be lifted and set down, and some order of the rest be kept
    /// stable.
    fn is_hopeful(
        &mut self,
        work: &mut Work<'_>,
        left: FingerSet,
        finger: FingerIndex,
    ) -> Result<bool, CallError> {
        let is_barred = !self.barring(work, finger).intersection(left).is_empty();
        Ok(!is_barred && self.may_lift(work, left, finger)? && self.some_order(work, left.without(finger))?)
    }

    /// The fingers that must go before `finger` can come to where it goes.
    fn barring(&mut self, work: &Work<'_>, finger: FingerIndex) -> FingerSet {
        if let Some(known) = self.barring[finger.index()] {
            return known;
        }
        let goes = (finger, &self.to.joints[finger]);
        let touches = |&other: &FingerIndex| {
            other != finger
                && work.task.clearance.fingers_free(goes, (other, &self.from.joints[other])).is_err()
        };
        let barring = self.from.joints.fingers().filter(touches).collect();
        self.barring[finger.index()] = Some(barring);
        barring
    }

    fn some_order(&mut self, work: &mut Work<'_>, left: FingerSet) -> Result<bool, CallError> {
        if left.is_empty() {
            return Ok(true);
        }
        if let Some(known) = self.hopeful[usize::from(left.bits())] {
            return Ok(known);
        }
        let mut hopeful = false;
        for finger in left.iter() {
            if self.is_hopeful(work, left, finger)? {
                hopeful = true;
                break;
            }
        }
        self.hopeful[usize::from(left.bits())] = Some(hopeful);
        Ok(hopeful)
    }

    /// Whether the other fingers hold the object while `finger` moves, those `left` where they were and the
    /// rest where they go.
    fn may_lift(&self, work: &mut Work<'_>, left: FingerSet, finger: FingerIndex) -> Result<bool, CallError> {
        let mut q = self.from.clone();
        for other in q.contacts.fingers().filter(|&other| !left.contains(other)) {
            (q.contacts[other], q.joints[other]) = (self.to.contacts[other], self.to.joints[other]);
        }
        let rest = FingerSet::first(q.contacts.len()).without(finger);
        let grasp = work.task.grasp(&q, rest);
        Ok(!grasp.contacts().is_empty()
            && work.task.stability.test(&grasp, &mut Default::default(), &mut work.context)?.is_stable())
    }
}
