//! What the reference's local planners share.

use regrasp_api::{
    CallError, Configuration, Context, FingerIndex, FingerJoints, Hint, Reached, Reason, Slot, Task,
};

/// The answer of a planner that stays where it is, counted.
pub(super) fn refuse(
    slot: Slot,
    reason: Reason,
    from: &Configuration,
    context: &mut Context<'_>,
) -> Result<Reached, CallError> {
    let stop = Some(context.reject(slot, reason));
    Ok(Reached { end: from.clone(), fraction: 0.0, stop })
}

/// The error for a target of another slot.
pub(super) fn wrong_target(slot: Slot) -> CallError {
    let reason = format!("it connects targets of the slot `{}` only", slot.name());
    CallError::Unsupported { plugin: "local-planner/reference".into(), reason }
}

/// Joints that bring the tip to its contact at `q`, near those of `q`.
pub(super) fn close(task: &Task<'_>, q: &Configuration, finger: FingerIndex) -> Result<FingerJoints, Reason> {
    let radius = task.hand.fingertip_radius();
    let p_HF = q.contact_tip_center(finger, radius).ok_or(Reason::Closure)?;
    task.hand.inverse(finger, &p_HF, &q.joints[finger]).ok_or(Reason::Reach)
}

/// What is wrong with a closed configuration of an object that moves.
pub(super) fn fault(
    task: &Task<'_>,
    q: &Configuration,
    context: &mut Context<'_>,
) -> Result<Option<Reason>, CallError> {
    let grasp = task.transfer_grasp(q, q.holding());
    if !task.stability.test(&grasp, &mut Hint::default(), context)?.is_stable() {
        return Ok(Some(Reason::Stability));
    }
    let radius = task.hand.fingertip_radius();
    for contact in q.contacts.iter().filter_map(|(_, contact)| contact.as_ref()) {
        // Where the object dents in, a ball at one place may reach into another.
        let projection = task.surface.project(&contact.tip_center(radius), Some(contact.facet));
        if projection.distance < radius - 1e-6 {
            return Ok(Some(Reason::Closure));
        }
    }
    let free = task.clearance.configuration_free(q, q.joints.fingers().collect(), true);
    Ok(free.is_err().then_some(Reason::Collision))
}
