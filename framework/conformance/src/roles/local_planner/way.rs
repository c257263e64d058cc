//! Laws of the way between the ends: limits, collision, stability, closed contacts.

use super::inspect::{Touch, instants};
use super::{Journey, Kind, on_journeys};
use crate::law::Subject;
use crate::reference::{Closure, closure};
use crate::report::{Fault, Finding, ensure};
use regrasp_api::{Body, BodyPair, Clearance, FingerIndex, Hand, Slot};
use regrasp_audit::laws;

use super::case::Goal;

/// Rounding, and what two ways of looking between states may differ by.
const SLACK: f64 = 1.05;

/// The finger that moves, in a regrasp.
fn moving(journey: &Journey) -> Option<FingerIndex> {
    match journey.case.goal {
        Goal::Regrasp { finger, .. } => Some(finger),
        _ => None,
    }
}

pub(super) fn steps<K: Kind>(subject: &Subject<'_>) -> Finding {
    on_journeys::<K>(subject, |journey| {
        let (task, target) = (journey.case.bench.task(), journey.case.goal.target());
        for (i, pair) in journey.path.states.windows(2).enumerate() {
            let kept = laws::step_kept(&task, &target, &pair[0], &pair[1]);
            kept.map_err(|fault| Fault::Broken(format!("after state {i}: {}", fault.what)))?;
        }
        Ok(())
    })
}

pub(super) fn limits<K: Kind>(subject: &Subject<'_>) -> Finding {
    on_journeys::<K>(subject, |journey| {
        let hand = &journey.case.bench.world.hand;
        for (i, q) in journey.path.states.iter().enumerate() {
            let out = q.joints.iter().find(|(finger, joints)| !hand.within_limits(*finger, joints));
            ensure(out.is_none(), || format!("state {i} leaves the limits: {out:?}"))?;
        }
        Ok(())
    })
}

pub(super) fn collision_free<K: Kind>(subject: &Subject<'_>) -> Finding {
    on_journeys::<K>(subject, |journey| {
        // Whether fingertips that hold, or did, touch the object as they should is another law.
        let may_touch =
            |finger| Some(finger) == moving(journey) || journey.case.from.holding().contains(finger);
        let touches = |pair: &BodyPair| match *pair {
            (Body::Object, Body::Fingertip(finger)) | (Body::Fingertip(finger), Body::Object) => {
                may_touch(finger)
            }
            _ => false,
        };
        let clearance = &journey.case.bench.world.clearance;
        for (at, q) in instants(&journey.path) {
            let close = clearance.distances(&q, 1e-4);
            let hit = close.iter().find(|found| found.distance <= 0.0 && !touches(&found.pair));
            ensure(hit.is_none(), || format!("{hit:?} at {at} of {} states", journey.path.states.len()))?;
        }
        Ok(())
    })
}

pub(super) fn stays_stable<K: Kind>(subject: &Subject<'_>) -> Finding {
    on_journeys::<K>(subject, |journey| {
        // A planner that stays where it is has made no claim about it.
        let states = if journey.path.states.len() > 1 { &journey.path.states[..] } else { &[] };
        for (i, q) in states.iter().enumerate() {
            let holding = moving(journey).map_or(q.holding(), |finger| q.holding().without(finger));
            let task = journey.case.bench.task();
            let grasp = match moving(journey) {
                Some(_) => task.grasp(q, holding),
                None => task.transfer_grasp(q, holding),
            };
            ensure(closure(&grasp) != Closure::Open, || {
                format!("the fingers {holding:?} do not hold the object in state {i} of {}", states.len())
            })?;
        }
        Ok(())
    })
}

/// The stored contacts are where the fingertips touch.
pub(super) fn contacts_true<K: Kind>(subject: &Subject<'_>) -> Finding {
    on_journeys::<K>(subject, |journey| {
        let tolerances = journey.case.bench.tolerances;
        for (i, q) in journey.path.states.iter().enumerate() {
            for finger in q.holding().iter() {
                let (Some(contact), touch) = (q.contacts[finger], Touch::new(journey.case.bench, q, finger))
                else {
                    continue;
                };
                let off = (contact.p_OC - touch.p_OC).norm();
                // Mirrored ones are not parallel.
                let turned = (contact.n_O - touch.n_O).norm();
                let fits =
                    off <= 0.5 * tolerances.closure * SLACK && turned <= 0.5 * tolerances.normal * SLACK;
                ensure(fits, || {
                    format!(
                        "the contact of finger {} in state {i} is {off:e} m and {turned:e} rad off",
                        finger.0
                    )
                })?;
            }
        }
        Ok(())
    })
}

/// Between the states of a path in GS_n a fingertip may leave the surface by this many tolerances: the path
/// is never executed, its states are what decomposition aims at. A jump to another branch of the inverse
/// kinematics leaves by far more.
const GUIDE: f64 = 5.0;

pub(super) fn stays_closed<K: Kind>(subject: &Subject<'_>) -> Finding {
    let guide = K::SLOT == Slot::GraspPlanner;
    on_journeys::<K>(subject, |journey| {
        let bench = journey.case.bench;
        for (at, q) in instants(&journey.path) {
            for finger in q.holding().iter() {
                let gap = Touch::new(bench, &q, finger).gap;
                let part = if guide && at.fract() != 0.0 { GUIDE } else { 0.5 * SLACK };
                ensure(gap.abs() <= part * bench.tolerances.closure, || {
                    let states = journey.path.states.len();
                    format!("fingertip {} is {gap:e} m off the object at {at} of {states} states", finger.0)
                })?;
            }
        }
        Ok(())
    })
}
