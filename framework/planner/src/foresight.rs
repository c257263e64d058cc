//! Checks before a roll: they cost a hundredth of it, and predict most of its failures.
//!
//! Heuristics: the contacts are taken to stay where they are, while in truth they drift as the fingertips
//! roll, mostly to the fingers' advantage. They decide what is tried first and what is not tried at all,
//! never what is valid.

use regrasp_api::{Configuration, FingerSet, Pose, Reason, Task, interpolate};

/// Into how many parts a motion is divided to be looked at.
const PARTS: u32 = 8;

/// How far along a roll one must be able to look for it to be tried as a whole.
///
/// Of the rolls that were barred half-way, smoothing the paper's problems, one in fifty went all the way; of
/// those barred a part farther on, one in eight.
const HALF_WAY: f64 = 0.62;

/// How far the fingers seem able to follow their contacts along the straight motion to a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outlook {
    /// The fraction of the motion, in [0, 1].
    pub fraction: f64,
    /// What seems to end it there; `None` exactly when it seems free as a whole.
    pub barred: Option<Reason>,
}

/// Looks along the straight motion of the object to `X_HO`.
///
/// On the paper's sphere, turned by half a turn, rolls go a quarter of a turn beyond where the look ends.
pub(crate) fn outlook(task: &Task<'_>, from: &Configuration, X_HO: &Pose) -> Outlook {
    let mut q = from.clone();
    for part in 1..=PARTS {
        q.X_HO = interpolate(&from.X_HO, X_HO, f64::from(part) / f64::from(PARTS));
        if let Some(reason) = barred(task, &mut q) {
            return Outlook { fraction: f64::from(part - 1) / f64::from(PARTS), barred: Some(reason) };
        }
    }
    Outlook { fraction: 1.0, barred: None }
}

/// What bars a roll to `X_HO` a little beyond half of the way.
pub(crate) fn barred_half_way(task: &Task<'_>, from: &Configuration, X_HO: &Pose) -> Option<Reason> {
    let mut q = from.clone();
    q.X_HO = interpolate(&from.X_HO, X_HO, HALF_WAY);
    barred(task, &mut q)
}

/// What bars the contacts of `q` at its pose; brings its joints there.
fn barred(task: &Task<'_>, q: &mut Configuration) -> Option<Reason> {
    for finger in q.joints.fingers() {
        if let Some(p_HF) = q.contact_tip_center(finger, task.hand.fingertip_radius()) {
            match task.hand.inverse(finger, &p_HF, &q.joints[finger]) {
                Some(joints) => q.joints[finger] = joints,
                None => return Some(Reason::Reach),
            }
        }
    }
    let all = FingerSet::first(q.joints.len());
    task.clearance.configuration_free(q, all, true).err().map(|_| Reason::Collision)
}
