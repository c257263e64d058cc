//! What regrasp planners share: lift the fingertip off, follow the geodesic, touch down.

mod flight;
mod follow;
mod lift;

use crate::common::{Levers, Second, refuse, second_touch, wrong_target};
pub(crate) use flight::Flight;
use regrasp_api::{
    CallError, Configuration, Contact, Context, FingerIndex, FingerJoints, Hint, Path, Reached, Reason, Slot,
    SurfacePath, Target, Task, TipRule,
};
use std::cell::RefCell;

pub(crate) const SLOT: Slot = Slot::RegraspPlanner;

/// Another way between two lifted postures, where the direct one is barred.
pub(crate) trait Detour {
    /// Whether it is taken without a try of the direct way.
    fn comes_first(&self) -> bool {
        false
    }

    /// Appends a way from `ends.0`, without it, to `ends.1` to the postures; false if there is none to be
    /// found.
    fn search(
        &self,
        flight: &Flight<'_>,
        ends: (&FingerJoints, &FingerJoints),
        postures: &mut Vec<FingerJoints>,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError>;
}

/// No other way.
pub(crate) struct NoDetour;

impl Detour for NoDetour {
    fn search(
        &self,
        _: &Flight<'_>,
        _: (&FingerJoints, &FingerJoints),
        _: &mut Vec<FingerJoints>,
        _: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        Ok(false)
    }
}

/// How a plugin regrasps.
pub(crate) struct Regrasping<'a> {
    /// The plugin's id.
    pub id: &'static str,
    pub levers: &'a Levers,
    /// How many lift heights are tried at each end, at least 1.
    pub heights: usize,
    pub detour: &'a dyn Detour,
}

/// Memory that a call uses and leaves to the next one on the same thread.
#[derive(Default)]
struct Scratch {
    slide: SurfacePath,
    /// How far (m) the lifted fingertip has travelled at each of the slide's waypoints.
    lengths: Vec<f64>,
    /// The finger's postures after the start, in turn.
    postures: Vec<FingerJoints>,
    /// The finger's postures from the target's contact up.
    descent: Vec<FingerJoints>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// One end of the motion: a posture, and the contact if the finger touches there.
#[derive(Clone, Copy)]
struct End<'a> {
    joints: &'a FingerJoints,
    contact: Option<&'a Contact>,
}

impl Regrasping<'_> {
    /// The whole call of a regrasp planner.
    pub fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        mut path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        context.count_call(SLOT);
        let &Target::Regrasp { finger, contact, joints } = to else {
            return Err(wrong_target(self.id, SLOT));
        };
        if let Some(path) = path.as_deref_mut() {
            path.restart(from);
        }
        let start = End { joints: &from.joints[finger], contact: from.contacts[finger].as_ref() };
        let target = End { joints, contact };
        context.proceed()?;
        if !others_hold(task, from, finger, context)? {
            return Ok(refuse(SLOT, Reason::Stability, from, context));
        }
        let flight = Flight::new(task, self.levers, from, finger);
        if let Some(reason) = unfit(&flight, target) {
            return Ok(refuse(SLOT, reason, from, context));
        }
        let mut scratch = SCRATCH.take();
        let barred = self.fly(&flight, (start, target), &mut scratch, context)?;
        if let Some(reason) = barred {
            SCRATCH.replace(scratch);
            return Ok(refuse(SLOT, reason, from, context));
        }
        let mut end = from.clone();
        end.joints[finger] = *joints;
        end.contacts[finger] = contact.copied();
        if let Some(path) = path {
            store(path, &end, finger, &scratch.postures);
        }
        SCRATCH.replace(scratch);
        Ok(Reached { end, fraction: 1.0, stop: None })
    }

    /// Fills `scratch.postures` with the finger's motion, without its start; or says what bars it.
    fn fly(
        &self,
        flight: &Flight<'_>,
        ends: (End<'_>, End<'_>),
        scratch: &mut Scratch,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        scratch.postures.clear();
        scratch.descent.clear();
        let Some(low) = self.leave(flight, ends.0, &mut scratch.postures) else {
            return Ok(Some(Reason::Retreat));
        };
        let Some(high) = self.leave(flight, ends.1, &mut scratch.descent) else {
            return Ok(Some(Reason::Retreat));
        };
        let a = *scratch.postures.last().unwrap_or(ends.0.joints);
        let b = *scratch.descent.last().unwrap_or(ends.1.joints);
        let lifted = scratch.postures.len();
        let barred = if self.detour.comes_first() {
            Err(Reason::Budget)
        } else {
            direct(flight, ends, (low, high), (&a, &b), scratch, context)?
        };
        if let Err(reason) = barred {
            scratch.postures.truncate(lifted);
            if !self.detour.search(flight, (&a, &b), &mut scratch.postures, context)? {
                return Ok(Some(reason));
            }
        }
        // The way down is the way up backwards, and ends at the target's posture exactly.
        let Scratch { postures, descent, .. } = scratch;
        postures.extend(descent.iter().rev().skip(1));
        if !descent.is_empty() {
            postures.push(*ends.1.joints);
        }
        Ok(None)
    }

    /// Lifts the finger off the object where it touches: the greatest height tried that it reaches, 0 where
    /// it is free.
    fn leave(&self, flight: &Flight<'_>, end: End<'_>, postures: &mut Vec<FingerJoints>) -> Option<f64> {
        let Some(contact) = end.contact else { return Some(0.0) };
        let resolution = flight.task.resolution;
        let lowest = resolution.retreat.into_iter().fold(resolution.lift, f64::min);
        let last = (self.heights - 1).max(1) as f64;
        // A little higher, so that rounding leaves no finger short of the height at which it counts as
        // lifted.
        let height = |k: usize| 1.01 * (resolution.lift + (lowest - resolution.lift) * k as f64 / last);
        let mut heights = (0..self.heights).map(height);
        heights.find(|&height| flight.lift(contact, end.joints, (height, lowest), postures))
    }
}

/// Appends the direct way from the lifted posture `a` to `b`: along the geodesic between two contacts,
/// otherwise straight; or says what bars it.
fn direct(
    flight: &Flight<'_>,
    ends: (End<'_>, End<'_>),
    heights: (f64, f64),
    (a, b): (&FingerJoints, &FingerJoints),
    scratch: &mut Scratch,
    context: &mut Context<'_>,
) -> Result<Result<(), Reason>, CallError> {
    let Scratch { slide, lengths, postures, .. } = scratch;
    let (Some(from), Some(to)) = (ends.0.contact, ends.1.contact) else {
        return Ok(flight.straight(a, b, postures));
    };
    if !flight.task.surface.geodesic(from, to, slide, context)? {
        return Ok(Err(Reason::Surface));
    }
    Ok(flight.follow(slide, lengths, heights, (a, b), postures))
}

/// Whether the other fingers hold the object; their grasp does not change, so one test holds for the whole
/// motion.
fn others_hold(
    task: &Task<'_>,
    from: &Configuration,
    finger: FingerIndex,
    context: &mut Context<'_>,
) -> Result<bool, CallError> {
    let others = from.holding().without(finger);
    let grasp = task.grasp(from, others);
    Ok(!others.is_empty() && task.stability.test(&grasp, &mut Hint::default(), context)?.is_stable())
}

/// Why the target is no place for the finger, if so.
fn unfit(flight: &Flight<'_>, target: End<'_>) -> Option<Reason> {
    let Flight { task, finger, .. } = flight;
    if !task.hand.within_limits(*finger, target.joints) {
        return Some(Reason::Limits);
    }
    let mut rule = TipRule::Clear(flight.clear());
    if let Some(contact) = target.contact {
        rule = TipRule::Touches;
        let gap = task.hand.tip_center(*finger, target.joints) - flight.center(contact, 0.0);
        let (radius, closure) = (task.hand.fingertip_radius(), task.tolerances.closure);
        if gap.norm() > 0.5 * closure || second_touch(task.surface, contact, radius, closure) != Second::None
        {
            return Some(Reason::Closure);
        }
    }
    (!flight.free(target.joints, rule)).then_some(Reason::Collision)
}

/// Appends the motion to the path; the finger touches nothing before `end`, to which the last posture
/// belongs.
fn store(path: &mut Path, end: &Configuration, finger: FingerIndex, postures: &[FingerJoints]) {
    let mut moving = end.clone();
    moving.contacts[finger] = None;
    for posture in &postures[..postures.len().saturating_sub(1)] {
        moving.joints[finger] = *posture;
        path.states.push(moving.clone());
    }
    if path.states.last() != Some(end) {
        path.states.push(end.clone());
    }
}
