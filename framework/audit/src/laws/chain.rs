//! Laws of closed chains: configurations of hand and object.

use super::contact::{Ground, contact_on_surface};
use super::{Kept, ensure, length};
use regrasp_api::{Configuration, FingerSet, PoseRequest, Task, angle_between};

/// What a configuration is held against.
#[derive(Clone, Copy)]
pub struct Chain<'a> {
    /// The task that it belongs to.
    pub task: &'a Task<'a>,
    /// The object's surface.
    pub ground: Ground<'a>,
    /// How far a fingertip may be off its contact (m).
    pub closure: f64,
}

/// Laws `finite`, `holding`, `limits`, `closed`, `contact-on-surface` of one configuration, whose fingers
/// `holding` touch.
pub fn chain_kept(chain: &Chain<'_>, q: &Configuration, holding: FingerSet) -> Kept {
    let p = q.X_HO.translation.vector;
    let orientation = q.X_HO.rotation.coords;
    let finite = p.iter().chain(orientation.iter()).all(|x| x.is_finite());
    let unit = (orientation.norm() - 1.0).abs() <= 1e-9;
    ensure("finite", finite && unit, || format!("the object's pose is {:?}", q.X_HO))?;
    let hand = chain.task.hand;
    ensure("holding", q.holding() == holding && q.joints.len() == hand.finger_count(), || {
        format!("{:?} were to hold, {:?} do", fingers(holding), fingers(q.holding()))
    })?;
    for (finger, joints) in q.joints.iter() {
        let fits = joints.len() == hand.finger(finger).joints.len() && hand.within_limits(finger, joints);
        ensure("limits", fits, || format!("the joints of `finger[{}]` are {:.4?}", finger.0, &joints[..]))?;
        let Some(contact) = &q.contacts[finger] else { continue };
        contact_on_surface(&chain.ground, contact)?;
        let center = q.contact_tip_center(finger, chain.ground.radius).unwrap_or(p);
        let gap = (hand.tip_center(finger, joints) - center).norm();
        ensure("closed", gap <= chain.closure, || {
            format!("the tip of `finger[{}]` is {} off its contact", finger.0, length(gap))
        })?;
    }
    Ok(())
}

fn fingers(set: FingerSet) -> Vec<u8> {
    set.iter().map(|finger| finger.0).collect()
}

/// Law `sample-pose`: the pose that was asked for.
pub fn pose_kept(task: &Task<'_>, request: &PoseRequest<'_>, q: &Configuration) -> Kept {
    let p = q.X_HO.translation.vector;
    let kept = match request {
        PoseRequest::Anywhere => (0..3).all(|i| (task.workspace.0[i]..=task.workspace.1[i]).contains(&p[i])),
        PoseRequest::At(X_HO) => q.X_HO == *X_HO,
        PoseRequest::Near { configuration, radius, angle } => {
            let moved = (p - configuration.X_HO.translation.vector).norm();
            let turned = angle_between(&q.X_HO.rotation, &configuration.X_HO.rotation);
            moved <= radius + 1e-9 && turned <= angle + 1e-9
        }
    };
    ensure("sample-pose", kept, || format!("{request:?} was asked for, {:?} given", q.X_HO))
}
