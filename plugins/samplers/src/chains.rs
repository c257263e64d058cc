//! What all samplers share: a hand at rest, and the closure of given contacts.

use regrasp_api::{Configuration, Contact, Context, FingerIndex, PerFinger, Pose, Reason, Slot, Task};

/// Every finger at rest, none in contact.
pub(crate) fn at_rest(task: &Task<'_>, X_HO: Pose) -> Configuration {
    let count = task.hand.finger_count();
    Configuration {
        X_HO,
        joints: PerFinger::from_fn(count, |finger| task.hand.finger(finger).rest),
        contacts: PerFinger::filled(count, None),
    }
}

/// Closes the chains for given contacts by the hand's inverse kinematics; `None`, and a reason counted, if a
/// finger cannot reach.
pub(crate) fn close(
    task: &Task<'_>,
    X_HO: &Pose,
    contacts: &PerFinger<Option<Contact>>,
    near: &Configuration,
    context: &mut Context<'_>,
) -> Option<Configuration> {
    context.count_call(Slot::Sampler);
    let mut q = Configuration { X_HO: *X_HO, joints: near.joints, contacts: *contacts };
    for finger in q.joints.fingers() {
        let Some(p_HF) = q.contact_tip_center(finger, task.hand.fingertip_radius()) else { continue };
        let Some(joints) = task.hand.inverse(finger, &p_HF, &near.joints[finger]) else {
            context.reject(Slot::Sampler, Reason::Reach);
            return None;
        };
        q.joints[finger] = joints;
    }
    Some(q)
}

/// Whether an object of this radius (m, about its origin) at the pose comes near the finger: a look that
/// saves tries where none helps.
pub(crate) fn may_reach(task: &Task<'_>, X_HO: &Pose, finger: FingerIndex, radius: f64) -> bool {
    let model = task.hand.finger(finger);
    let most = model.reach + radius + task.hand.fingertip_radius();
    (X_HO.translation.vector - model.p_HReach).norm_squared() <= most * most
}
