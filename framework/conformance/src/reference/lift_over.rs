//! The reference for `local-planner.regrasp`: up, along the geodesic at lift height, down.

use super::steps::{refuse, wrong_target};
use crate::fixtures::to_hand;
use regrasp_api::{
    CallError, Configuration, Contact, Context, FingerIndex, FingerJoints, Hint, LocalPlanner, Path, Reached,
    Reason, Slot, SurfacePath, Target, Task, TipRule,
};

/// Lifts the fingertip, follows the geodesic at the task's lift height, touches down; all or nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct LiftOver;

/// One regrasp: the object rests in the grasp of the other fingers.
struct Regrasp<'a> {
    task: &'a Task<'a>,
    from: &'a Configuration,
    finger: FingerIndex,
}

impl Regrasp<'_> {
    /// The posture near `near` with the fingertip `height` m above the contact, if nothing is in its way.
    fn above(&self, contact: &Contact, height: f64, near: &FingerJoints) -> Result<FingerJoints, Reason> {
        let center = contact.tip_center(self.task.hand.fingertip_radius() + height);
        let p_HF = to_hand(&self.from.X_HO, &center);
        let joints = self.task.hand.inverse(self.finger, &p_HF, near).ok_or(Reason::Reach)?;
        self.free(joints, TipRule::Clear((0.5 * height).min(self.task.resolution.clearance)))
    }

    fn free(&self, joints: FingerJoints, tip: TipRule) -> Result<FingerJoints, Reason> {
        let clearance = self.task.clearance;
        let beside = |other: FingerIndex| {
            other == self.finger
                || clearance.fingers_free((self.finger, &joints), (other, &self.from.joints[other])).is_ok()
        };
        let free = clearance.finger_free(self.finger, &joints, &self.from.X_HO, tip).is_ok()
            && self.from.joints.fingers().all(beside);
        if free { Ok(joints) } else { Err(Reason::Collision) }
    }

    /// Postures on the way up from a contact, without the start.
    fn lift(&self, contact: &Contact, joints: &FingerJoints) -> Result<Vec<FingerJoints>, Reason> {
        let lift = self.task.resolution.lift;
        let count = (3.0 * lift / self.task.resolution.regrasp_step).ceil() as usize;
        let mut way = vec![*joints];
        for step in 1..=count {
            let posture = self.above(contact, lift * step as f64 / count as f64, &way[step - 1])?;
            way.push(posture);
        }
        way.remove(0);
        Ok(way)
    }

    /// Postures that lead away from the object, none where the finger is free.
    fn leave(&self, contact: Option<&Contact>, joints: &FingerJoints) -> Result<Vec<FingerJoints>, Reason> {
        contact.map_or(Ok(Vec::new()), |contact| self.lift(contact, joints))
    }

    /// Postures between the two lifted ones: over the surface from contact to contact, otherwise straight.
    fn cross(
        &self,
        contact: Option<&Contact>,
        high: (FingerJoints, FingerJoints),
        context: &mut Context<'_>,
    ) -> Result<Result<Vec<FingerJoints>, Reason>, CallError> {
        let (Some(a), Some(b)) = (&self.from.contacts[self.finger], contact) else {
            return Ok(self.straight(&high.0, &high.1));
        };
        let mut slide = SurfacePath::default();
        let found = self.task.surface.geodesic(a, b, &mut slide, context)?;
        Ok(if found { self.follow(&slide, &high.0) } else { Err(Reason::Surface) })
    }

    /// Postures along the geodesic at lift height.
    fn follow(&self, slide: &SurfacePath, near: &FingerJoints) -> Result<Vec<FingerJoints>, Reason> {
        let count = (4.0 * slide.lift_length() / self.task.resolution.regrasp_step).ceil() as usize;
        let mut way = vec![*near];
        for step in 1..=count {
            let contact = slide.at(step as f64 / count as f64);
            let posture = self.above(&contact, self.task.resolution.lift, &way[step - 1])?;
            way.push(posture);
        }
        way.remove(0);
        Ok(way)
    }

    /// Postures straight between two free ones, without the first.
    fn straight(&self, a: &FingerJoints, b: &FingerJoints) -> Result<Vec<FingerJoints>, Reason> {
        let count = 400;
        let rule = TipRule::Clear(self.task.resolution.clearance);
        (1..=count).map(|i| self.free(a.interpolate(b, i as f64 / count as f64), rule)).collect()
    }
}

/// The finger's postures after the start, or what is in the way.
fn postures(
    task: &Task<'_>,
    from: &Configuration,
    (finger, contact, joints): (FingerIndex, Option<&Contact>, &FingerJoints),
    context: &mut Context<'_>,
) -> Result<Result<Vec<FingerJoints>, Reason>, CallError> {
    let rest = task.grasp(from, from.holding().without(finger));
    let held =
        !rest.contacts().is_empty() && task.stability.test(&rest, &mut Hint::default(), context)?.is_stable();
    if !held {
        return Ok(Err(Reason::Stability));
    }
    let regrasp = Regrasp { task, from, finger };
    let up = regrasp.leave(from.contacts[finger].as_ref(), &from.joints[finger]);
    let (mut way, mut down) = match up.and_then(|up| Ok((up, regrasp.leave(contact, joints)?))) {
        Ok(ends) => ends,
        Err(reason) => return Ok(Err(reason)),
    };
    let high = (*way.last().unwrap_or(&from.joints[finger]), *down.last().unwrap_or(joints));
    let between = regrasp.cross(contact, high, context)?;
    Ok(between.map(|between| {
        down.reverse();
        way.extend(between.into_iter().chain(down));
        if way.last() != Some(joints) {
            way.push(*joints);
        }
        way
    }))
}

impl LocalPlanner for LiftOver {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        mut path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        context.count_call(Slot::RegraspPlanner);
        let &Target::Regrasp { finger, contact, joints } = to else {
            return Err(wrong_target(Slot::RegraspPlanner));
        };
        context.proceed()?;
        if let Some(path) = path.as_deref_mut() {
            path.restart(from);
        }
        let way = match postures(task, from, (finger, contact, joints), context)? {
            Ok(way) => way,
            Err(reason) => return refuse(Slot::RegraspPlanner, reason, from, context),
        };
        let mut moving = from.clone();
        moving.contacts[finger] = None;
        if let Some(path) = path.as_deref_mut() {
            for posture in &way[..way.len() - 1] {
                moving.joints[finger] = *posture;
                path.states.push(moving.clone());
            }
        }
        moving.joints[finger] = *joints;
        moving.contacts[finger] = contact.copied();
        if let Some(path) = path {
            path.states.push(moving.clone());
        }
        Ok(Reached { end: moving, fraction: 1.0, stop: None })
    }
}
