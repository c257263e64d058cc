//! Which configurations may become nodes.

use regrasp_api::{
    Admissible, CallError, Configuration, Context, FingerIndex, FingerSet, Reason, Slot, Task, TipRule,
};

/// Admits configurations that can be left by transfers and regrasps.
///
/// The reduction property (Alami, Laumond, Siméon, "Two manipulation planning algorithms", WAFR 1994) needs more than a
/// stable grasp: of its n fingers at least n - 1 can be lifted with the rest stable, and every finger can retreat
/// from the object. Otherwise a node is a dead end.
#[derive(Clone, Copy, Debug, Default)]
pub struct Leavable;

impl Admissible for Leavable {
    fn admit_finger(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        _context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let Some(contact) = q.contacts[finger] else {
            let clear = TipRule::Clear(task.resolution.clearance);
            return Ok(if stands_free(task, q, finger, placed, clear) {
                None
            } else {
                Some(Reason::Collision)
            });
        };
        if task.surface.edge_distance(&contact) < task.resolution.edge_margin {
            return Ok(Some(Reason::Edge));
        }
        if !stands_free(task, q, finger, placed, TipRule::Touches) {
            return Ok(Some(Reason::Collision));
        }
        Ok(if retreats(task, q, finger, placed) { None } else { Some(Reason::Retreat) })
    }

    fn admit_grasp(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let grasp = task.grasp(q, FingerSet::first(q.contacts.len()));
        let enough = grasp.contacts().len().saturating_sub(1);
        context.count_call(Slot::StabilityTest);
        // More contacts never make a grasp unstable: where n - 1 subsets are stable the whole is.
        if task.stability.liftable(&grasp, enough, context)?.len() >= enough.max(1) {
            return Ok(None);
        }
        let whole = task.stability.test(&grasp, &mut Default::default(), context)?;
        Ok(Some(if whole.is_stable() { Reason::Liftable } else { Reason::Stability }))
    }
}

/// Whether `finger` at `q` is free of everything fixed, of the object (by `tip`) and of the fingers in `placed`.
fn stands_free(
    task: &Task<'_>,
    q: &Configuration,
    finger: FingerIndex,
    placed: FingerSet,
    tip: TipRule,
) -> bool {
    let joints = &q.joints[finger];
    task.clearance.finger_free(finger, joints, &q.X_HO, tip).is_ok()
        && placed
            .iter()
            .all(|other| task.clearance.fingers_free((finger, joints), (other, &q.joints[other])).is_ok())
}

/// Whether the finger can stand at every retreat height above its contact, along the normal.
fn retreats(task: &Task<'_>, q: &Configuration, finger: FingerIndex, placed: FingerSet) -> bool {
    let radius = task.hand.fingertip_radius();
    let mut there = q.clone();
    task.resolution.retreat.iter().all(|&height| {
        let Some(p_HF) = q.contact_tip_center(finger, radius + height) else { return true };
        let Some(joints) = task.hand.inverse(finger, &p_HF, &there.joints[finger]) else { return false };
        there.joints[finger] = joints;
        let clear = TipRule::Clear(task.resolution.clearance.min(height));
        stands_free(task, &there, finger, placed, clear)
    })
}
