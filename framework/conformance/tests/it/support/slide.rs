//! A transfer that slips, for a liar.

use regrasp_api::*;

/// How far a target is (m; rad counted as 3 cm).
pub fn way(from: &Configuration, to: &Target<'_>) -> f64 {
    let X_HO = match to {
        Target::Grasp(q) => &q.X_HO,
        Target::Transfer(X_HO) => X_HO,
        Target::Regrasp { .. } => return 0.0,
    };
    let turn = angle_between(&from.X_HO.rotation, &X_HO.rotation);
    (X_HO.translation.vector - from.X_HO.translation.vector).norm() + 0.03 * turn
}

/// The object moves, contact points and normals stay: fingertips slip.
pub fn slide_along(
    task: &Task<'_>,
    from: &Configuration,
    to: &Pose,
    path: &mut Path,
    context: &mut Context<'_>,
) -> Result<Reached, CallError> {
    context.count_call(Slot::TransferPlanner);
    path.restart(from);
    let mut q = from.clone();
    let count = 20 + (2e3 * way(from, &Target::Transfer(to))) as u32;
    for step in 1..=count {
        context.proceed()?;
        let part = |step: u32| f64::from(step) / f64::from(count);
        let before = (q.clone(), part(step - 1));
        q.X_HO = if step == count { *to } else { interpolate(&from.X_HO, to, part(step)) };
        let mut closed = true;
        for finger in from.holding().iter() {
            let center = q.contact_tip_center(finger, task.hand.fingertip_radius()).unwrap();
            match task.hand.inverse(finger, &center, &q.joints[finger]) {
                Some(joints) => q.joints[finger] = joints,
                None => closed = false,
            }
        }
        let all = q.joints.fingers().collect();
        let grasp = task.transfer_grasp(&q, q.holding());
        let free = closed && task.clearance.configuration_free(&q, all, true).is_ok();
        if !free || !task.stability.test(&grasp, &mut Hint::default(), context)?.is_stable() {
            let stop = Some(context.reject(Slot::TransferPlanner, Reason::Collision));
            return Ok(Reached { end: before.0, fraction: before.1, stop });
        }
        path.states.push(q.clone());
    }
    Ok(Reached { end: q, fraction: 1.0, stop: None })
}
