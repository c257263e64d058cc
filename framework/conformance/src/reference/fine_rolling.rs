//! The reference for `local-planner.transfer`: rolling without slip in short steps of equal length.

use super::steps::{close, fault, wrong_target};
use crate::fixtures::{to_hand, to_object};
use regrasp_api::{
    CallError, Configuration, Context, FingerIndex, Fingertip, LocalPlanner, Mat3, Path, Pose, Reached,
    Reason, Slot, Target, Task, Vec3, angle_between, interpolate,
};

/// Steps are this part of the task's resolution.
const PART: f64 = 0.5;

/// Integrates the rolling constraint by the midpoint rule and closes every contact anew after each step.
#[derive(Clone, Copy, Debug, Default)]
pub struct FineRolling;

/// Velocity, in H, of the tip's material point at the contact, per speed of the first three joints.
fn contact_speeds(task: &Task<'_>, q: &Configuration, finger: FingerIndex, n_O: &Vec3) -> Mat3 {
    let tip = task.hand.tip_kinematics(finger, &q.joints[finger]);
    // The material point lies at -r n from the centre.
    let arm = q.X_HO.rotation * n_O * task.hand.fingertip_radius();
    let column = |j: usize| -> Vec3 {
        let (v, w): (Vec3, Vec3) = (tip.J_v.column(j).into(), tip.J_w.column(j).into());
        v + arm.cross(&w)
    };
    Mat3::from_columns(&[column(0), column(1), column(2)])
}

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
    let speeds = contact_speeds(task, at, finger, &contact.n_O);
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

/// How many steps the motion between two poses takes.
fn step_count(task: &Task<'_>, from: &Pose, to: &Pose) -> usize {
    let distance = (to.translation.vector - from.translation.vector).norm();
    let angle = angle_between(&from.rotation, &to.rotation);
    let steps = (distance / task.resolution.transfer_step).max(angle / task.resolution.transfer_turn);
    (steps / PART).ceil().max(1.0) as usize
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
        context.count_call(Slot::TransferPlanner);
        if task.hand.fingertip() != Fingertip::Ball {
            let reason = "point fingertips do not roll".into();
            return Err(CallError::Unsupported { plugin: "local-planner/reference".into(), reason });
        }
        let Target::Transfer(to) = to else { return Err(wrong_target(Slot::TransferPlanner)) };
        if let Some(path) = path.as_deref_mut() {
            path.restart(from);
        }
        let count = step_count(task, &from.X_HO, to);
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
