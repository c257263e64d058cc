//! Laws of the way between the ends: limits, collision, stability, closed contacts.

use super::inspect::{Touch, instants};
use super::{Journey, Kind, journeys};
use crate::law::Subject;
use crate::reference::{Closure, closure};
use crate::report::{Finding, ensure};
use regrasp_api::{Body, BodyPair, Clearance, FingerIndex, Hand, Slot};

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

pub(super) fn limits<K: Kind>(subject: &Subject<'_>) -> Finding {
    for journey in journeys::<K>(subject)?.iter() {
        let hand = &journey.case.bench.world.hand;
        for (i, q) in journey.path.states.iter().enumerate() {
            let out = q.joints.iter().find(|(finger, joints)| !hand.within_limits(*finger, joints));
            ensure(out.is_none(), || format!("state {i} leaves the limits: {out:?}"))?;
        }
    }
    Ok(())
}

pub(super) fn collision_free<K: Kind>(subject: &Subject<'_>) -> Finding {
    for journey in journeys::<K>(subject)?.iter() {
        let allowed = moving(journey).map(Body::Fingertip);
        let touches = |pair: &BodyPair| {
            let tip = |a: Body, b: Body| a == Body::Object && Some(b) == allowed;
            tip(pair.0, pair.1) || tip(pair.1, pair.0)
        };
        let clearance = &journey.case.bench.world.clearance;
        for (at, q) in instants(&journey.path) {
            let close = clearance.distances(&q, 1e-4);
            let hit = close.iter().find(|found| found.distance <= 0.0 && !touches(&found.pair));
            ensure(hit.is_none(), || format!("{hit:?} at {at} of {} states", journey.path.states.len()))?;
        }
    }
    Ok(())
}

pub(super) fn stays_stable<K: Kind>(subject: &Subject<'_>) -> Finding {
    for journey in journeys::<K>(subject)?.iter() {
        // A planner that stays where it is has made no claim about it.
        let states = if journey.path.states.len() > 1 { &journey.path.states[..] } else { &[] };
        for (i, q) in states.iter().enumerate() {
            let holding = moving(journey).map_or(q.holding(), |finger| q.holding().without(finger));
            let grasp = journey.case.bench.task().grasp(q, holding);
            ensure(closure(&grasp) != Closure::Open, || {
                format!("the fingers {holding:?} do not hold the object in state {i} of {}", states.len())
            })?;
        }
    }
    Ok(())
}

/// The stored contacts are where the fingertips touch.
pub(super) fn contacts_true<K: Kind>(subject: &Subject<'_>) -> Finding {
    for journey in journeys::<K>(subject)?.iter() {
        let tolerances = journey.case.bench.tolerances;
        for (i, q) in journey.path.states.iter().enumerate() {
            for finger in q.holding().iter() {
                let (Some(contact), touch) = (q.contacts[finger], Touch::new(journey.case.bench, q, finger))
                else {
                    continue;
                };
                let off = (contact.p_OC - touch.p_OC).norm();
                let turned = contact.n_O.cross(&touch.n_O).norm();
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
    }
    Ok(())
}

pub(super) fn stays_closed<K: Kind>(subject: &Subject<'_>) -> Finding {
    debug_assert!(K::SLOT != Slot::RegraspPlanner, "there one finger lets go");
    for journey in journeys::<K>(subject)?.iter() {
        let bench = journey.case.bench;
        for (at, q) in instants(&journey.path) {
            for finger in q.holding().iter() {
                let gap = Touch::new(bench, &q, finger).gap;
                ensure(gap.abs() <= 0.5 * bench.tolerances.closure * SLACK, || {
                    let states = journey.path.states.len();
                    format!("fingertip {} is {gap:e} m off the object at {at} of {states} states", finger.0)
                })?;
            }
        }
    }
    Ok(())
}
