//! The reference for `local-planner.transfer`: rolling without slip in short steps of equal length.

use super::steps::{close, fault, wrong_target};
use crate::fixtures::{to_hand, to_object};
use regrasp_api::{
    CallError, Configuration, Context, FingerIndex, LocalPlanner, Mat3, Path, Pose, Reached, Reason, Slot,
    Target, Task, Vec3, angle_between, interpolate,
};

/// Steps are this part of the task's resolution.
const PART: f64 = 0.5;

/// Integrates the rolling constraint by the midpoint rule and closes every contact anew after each step.
#[derive(Clone, Copy, Debug, Default)]
pub struct FineRolling;

/// The configuration with the object at `X_HO`, `finger` having rolled along, its joint speeds taken at `at`.
fn roll(
    task: &Task<'_>,
    q: &Configuration,
    at: &Configuration,
    X_HO: &Pose,
    finger: FingerIndex,
) -> Result<Configuration, Reason> {
    let contact = at.contacts[finger].ok_or(Reason::Closure)?;
    // How the object's material point at the contact moves over the whole step.
    let wish = to_hand(X_HO, &contact.p_OC) - to_hand(&q.X_HO, &contact.p_OC);
    let tip = task.hand.tip_kinematics(finger, &at.joints[finger]);
    let n_H = at.X_HO.rotation * contact.n_O;
    let arm = n_H * task.hand.fingertip_radius();
    // The tip's material point at the contact lies at -r n from the centre.
    let column = |j: usize| -> Vec3 {
        let (v, w): (Vec3, Vec3) = (tip.J_v.column(j).into(), tip.J_w.column(j).into());
        v + arm.cross(&w)
    };
    let speeds = Mat3::from_columns(&[column(0), column(1), column(2)]);
    let moves = speeds.lu().solve(&wish).ok_or(Reason::Reach)?;
    let mut next = q.clone();
    next.X_HO = *X_HO;
    (0..3).for_each(|j| next.joints[finger][j] += moves[j]);
    let p_HF = task.hand.tip_center(finger, &next.joints[finger]);
    let projection = task.surface.project(&to_object(X_HO, &p_HF), Some(contact.facet));
    if (projection.distance - task.hand.fingertip_radius()).abs() > 1e-4 {
        return Err(Reason::Closure);
    }
    next.contacts[finger] = Some(projection.contact);
    next.joints[finger] = close(task, &next, finger)?;
    Ok(next)
}

/// All holding fingers rolled to the object's next pose, speeds taken half-way.
fn advance(task: &Task<'_>, q: &Configuration, X_HO: &Pose) -> Result<Configuration, Reason> {
    let middle = interpolate(&q.X_HO, X_HO, 0.5);
    let mut next = q.clone();
    next.X_HO = *X_HO;
    for finger in q.holding().iter() {
        let half = roll(task, q, q, &middle, finger)?;
        let rolled = roll(task, q, &half, X_HO, finger)?;
        next.joints[finger] = rolled.joints[finger];
        next.contacts[finger] = rolled.contacts[finger];
    }
    Ok(next)
}

impl LocalPlanner for FineRolling {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        mut path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let Target::Transfer(to) = to else { return Err(wrong_target(Slot::TransferPlanner)) };
        if let Some(path) = path.as_deref_mut() {
            path.restart(from);
        }
        let distance = (to.translation.vector - from.X_HO.translation.vector).norm();
        let angle = angle_between(&from.X_HO.rotation, &to.rotation);
        let resolution = task.resolution;
        let steps = (distance / resolution.transfer_step).max(angle / resolution.transfer_turn) / PART;
        let count = steps.ceil().max(1.0) as usize;
        let mut end = from.clone();
        for step in 1..=count {
            context.proceed()?;
            let s = step as f64 / count as f64;
            let X_HO = if step == count { **to } else { interpolate(&from.X_HO, to, s) };
            let tried = match advance(task, &end, &X_HO) {
                Err(reason) => Err(reason),
                Ok(q) => fault(task, &q, context)?.map_or(Ok(q), Err),
            };
            match tried {
                Ok(q) => end = q,
                Err(reason) => {
                    let stop = Some(context.reject(Slot::TransferPlanner, reason));
                    return Ok(Reached { end, fraction: (step - 1) as f64 / count as f64, stop });
                }
            }
            if let Some(path) = path.as_deref_mut() {
                path.states.push(end.clone());
            }
        }
        Ok(Reached { end, fraction: 1.0, stop: None })
    }
}
