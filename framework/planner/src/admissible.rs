//! Which configurations may become nodes.

use regrasp_api::{
    Admissible, Admission, CallError, Configuration, Contact, Context, FingerIndex, FingerSet, Grasp,
    LoneFinger, Reason, Task, TipRule,
};

/// Admits configurations that can be left by transfers and regrasps.
///
/// The reduction property (Alami, Laumond, Siméon, "Two manipulation planning algorithms", WAFR 1994) needs
/// more than a stable grasp: of its n fingers at least n - 1 can be lifted with the rest stable, and every
/// finger can retreat from the object. Otherwise a node is a dead end.
#[derive(Clone, Copy, Debug, Default)]
pub struct Leavable;

/// Admits every configuration that is free of collisions and stable, as the paper has it (section IV.B).
#[derive(Clone, Copy, Debug, Default)]
pub struct Stable;

/// What admits the nodes of a search.
pub fn admission(admission: Admission) -> &'static dyn Admissible {
    match admission {
        Admission::Stable => &Stable,
        _ => &Leavable,
    }
}

impl Admissible for Leavable {
    fn admit_finger(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        _context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let lone = task.clearance.lone_finger(finger, q, placed);
        let Some(contact) = q.contacts[finger] else {
            let free = lone.free(&q.joints[finger], TipRule::Clear(task.resolution.clearance)).is_ok();
            return Ok((!free).then_some(Reason::Collision));
        };
        if let Some(reason) = touching(task, q, (finger, &contact), &*lone) {
            return Ok(Some(reason));
        }
        Ok(if retreats(task, q, finger, &*lone) { None } else { Some(Reason::Retreat) })
    }

    fn admit_grasp(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let grasp = task.grasp(q, FingerSet::first(q.contacts.len()));
        if grasp.contacts().len() <= task.contact_model.fewest_contacts() {
            // None of its fingers can ever be lifted: it is left by setting down another one.
            return Stable.admit_grasp(task, q, context);
        }
        let enough = grasp.contacts().len().saturating_sub(1);
        // More contacts never make a grasp unstable: what is not stable as a whole need not be taken apart.
        if !task.stability.test(&grasp, &mut Default::default(), context)?.is_stable() {
            return Ok(Some(Reason::Stability));
        }
        if task.stability.liftable(&grasp, enough, context)?.len() < enough.max(1) {
            return Ok(Some(Reason::Liftable));
        }
        // At rest; while the object moves, contacts may spin and their torsion is gone.
        Ok((!holds_in_transfers(task, q, &grasp, context)?).then_some(Reason::Stability))
    }
}

/// Admits configurations in which a motion may begin or end.
///
/// The reduction property asks for nodes that can be left in several ways; an end is left in one. So n - 1
/// fingers are enough, or n of which one can be lifted: the rest of the hand comes to the object, or goes
/// from it, by regrasps. What is lost is that the end lies in GS_n: paths in GS_n cannot begin there, and the
/// search joins it by transfers and regrasps alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Holdable;

impl Admissible for Holdable {
    fn admit_finger(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        Leavable.admit_finger(task, q, finger, placed, context)
    }

    fn admit_grasp(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let grasp = task.grasp(q, FingerSet::first(q.contacts.len()));
        if !task.stability.test(&grasp, &mut Default::default(), context)?.is_stable() {
            return Ok(Some(Reason::Stability));
        }
        let fewest = task.contact_model.fewest_contacts();
        if grasp.contacts().len() > fewest && task.stability.liftable(&grasp, 1, context)?.is_empty() {
            return Ok(Some(Reason::Liftable));
        }
        let holds = holds_in_transfers(task, q, &grasp, context)?;
        Ok(if holds { None } else { Some(Reason::Stability) })
    }
}

impl Admissible for Stable {
    fn admit_finger(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        _context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let lone = task.clearance.lone_finger(finger, q, placed);
        let Some(contact) = q.contacts[finger] else {
            let free = lone.free(&q.joints[finger], TipRule::Clear(task.resolution.clearance)).is_ok();
            return Ok((!free).then_some(Reason::Collision));
        };
        Ok(touching(task, q, (finger, &contact), &*lone))
    }

    fn admit_grasp(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let grasp = task.grasp(q, FingerSet::first(q.contacts.len()));
        let stable = task.stability.test(&grasp, &mut Default::default(), context)?.is_stable()
            && holds_in_transfers(task, q, &grasp, context)?;
        Ok((!stable).then_some(Reason::Stability))
    }
}

/// Why a finger may not touch the object at its contact: too near to an edge, or something in its way.
fn touching(
    task: &Task<'_>,
    q: &Configuration,
    (finger, contact): (FingerIndex, &Contact),
    lone: &dyn LoneFinger,
) -> Option<Reason> {
    if task.surface.edge_distance(contact) < task.resolution.edge_margin {
        return Some(Reason::Edge);
    }
    lone.free(&q.joints[finger], TipRule::Touches).is_err().then_some(Reason::Collision)
}

/// Whether the grasp that is stable at rest is still so while the object moves.
fn holds_in_transfers(
    task: &Task<'_>,
    q: &Configuration,
    resting: &Grasp<'_>,
    context: &mut Context<'_>,
) -> Result<bool, CallError> {
    if !resting.contacts().iter().any(|contact| contact.cone.carries_torsion()) {
        return Ok(true);
    }
    let moving = task.transfer_grasp(q, FingerSet::first(q.contacts.len()));
    Ok(task.stability.test(&moving, &mut Default::default(), context)?.is_stable())
}

/// Whether the finger can stand at every retreat height above its contact, along the normal.
fn retreats(task: &Task<'_>, q: &Configuration, finger: FingerIndex, lone: &dyn LoneFinger) -> bool {
    let radius = task.hand.fingertip_radius();
    let mut near = q.joints[finger];
    task.resolution.retreat.iter().all(|&height| {
        let Some(p_HF) = q.contact_tip_center(finger, radius + height) else { return true };
        let Some(joints) = task.hand.inverse(finger, &p_HF, &near) else { return false };
        near = joints;
        lone.free(&joints, TipRule::Clear(task.resolution.clearance.min(height))).is_ok()
    })
}
