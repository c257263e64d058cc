//! Which grasps a regrasp connects: those of one pose between which one finger alone moves.

use crate::grasp::BulkGrasp;
use regrasp_api::{CallError, Context, FingerIndex, LocalPlanner, Target, Task};

/// A regrasp between two grasps of one pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The number of the grasp that it was found from.
    pub from: u64,
    /// The number of the grasp that it leads to.
    pub to: u64,
    /// The finger that moves, comes or goes.
    pub finger: FingerIndex,
}

/// The regrasps between grasps, numbered by their places: pairs of one pose between which one finger differs,
/// the others holding, and for which the regrasp planner finds a way. What leads there leads back.
pub(crate) fn edges(
    task: &Task<'_>,
    planner: &dyn LocalPlanner,
    grasps: &[BulkGrasp],
    context: &mut Context<'_>,
) -> Result<Vec<Edge>, CallError> {
    let mut edges = Vec::new();
    for (from, a) in grasps.iter().enumerate() {
        let later = grasps.iter().enumerate().skip(from + 1).take_while(|(_, b)| b.pose == a.pose);
        for (to, b) in later {
            let Some(finger) = mover(a, b) else { continue };
            let joints = &b.q.joints[finger];
            let contact = b.q.contacts[finger].as_ref();
            let target = Target::Regrasp { finger, contact, joints };
            if planner.connect(task, &a.q, &target, None, context)?.is_complete() {
                edges.push(Edge { from: from as u64, to: to as u64, finger });
            }
        }
    }
    Ok(edges)
}

/// The one finger in which two grasps of a pose differ, if the others hold without it.
fn mover(a: &BulkGrasp, b: &BulkGrasp) -> Option<FingerIndex> {
    let differs = |finger: &FingerIndex| {
        a.q.contacts[*finger] != b.q.contacts[*finger] || a.q.joints[*finger] != b.q.joints[*finger]
    };
    let mut different = a.q.joints.fingers().filter(differs);
    let finger = different.next()?;
    let holds_without =
        |grasp: &BulkGrasp| grasp.q.contacts[finger].is_none() || grasp.liftable.contains(finger);
    (different.next().is_none() && holds_without(a) && holds_without(b)).then_some(finger)
}
