//! Laws of one slot alone.

use super::case::Goal;
use super::inspect::{Touch, instants};
use super::{Journey, Kind, Regrasp, Transfer, on_journeys};
use crate::fixtures::to_object;
use crate::law::Subject;
use crate::report::{Fault, Finding, ensure};
use regrasp_api::{Fingertip, Hand, Vec3};
use regrasp_audit::laws::{self, Chain, Ground, Motion};

pub(super) fn same_fingers<K: Kind>(subject: &Subject<'_>) -> Finding {
    on_journeys::<K>(subject, |journey| {
        let holding = journey.case.from.holding();
        let other = journey.path.states.iter().position(|q| q.holding() != holding);
        ensure(other.is_none(), || format!("other fingers hold in state {other:?}"))?;
        Ok(())
    })
}

/// A point fingertip keeps its contact, and its ball the place over the object that it had at touch-down.
fn stays_put(journey: &Journey) -> Finding {
    let (bench, from) = (journey.case.bench, &journey.case.from);
    for (at, q) in instants(&journey.path) {
        ensure(q.contacts == from.contacts, || format!("a fingertip's contact changes at {at}"))?;
        for (finger, contact) in from.contacts.iter() {
            let Some(contact) = contact else { continue };
            let p_OF = to_object(&q.X_HO, &bench.world.hand.tip_center(finger, &q.joints[finger]));
            let off = (p_OF - contact.tip_center(bench.radius())).norm();
            ensure(off <= 0.5 * bench.tolerances.slip * 1.05, || {
                format!("fingertip {} is {off:e} m off its place at {at}", finger.0)
            })?;
        }
    }
    Ok(())
}

/// Slip adds up, as vectors in the object's frame, from the start to any instant.
pub(super) fn no_slip(subject: &Subject<'_>) -> Finding {
    on_journeys::<Transfer>(subject, |journey| {
        let bench = journey.case.bench;
        if bench.world.hand.fingertip() == Fingertip::Point {
            stays_put(journey)?;
            return Ok(());
        }
        for finger in journey.case.from.holding().iter() {
            let (mut before, mut net): (Option<Touch>, Vec3) = (None, Vec3::zeros());
            for (at, q) in instants(&journey.path) {
                let now = Touch::new(bench, &q, finger);
                if let Some(before) = &before {
                    // Half of each way of taking the contact: exact to second order.
                    net += 0.5 * (before.slip(&now) - now.slip(before));
                }
                let slip = net.norm();
                ensure(slip <= 0.5 * bench.tolerances.slip * 1.05, || {
                    let states = journey.path.states.len();
                    format!("fingertip {} has slipped {slip:e} m at {at} of {states} states", finger.0)
                })?;
                before = Some(now);
            }
        }
        Ok(())
    })
}

pub(super) fn others_rest(subject: &Subject<'_>) -> Finding {
    on_journeys::<Regrasp>(subject, |journey| {
        let (from, Goal::Regrasp { finger, .. }) = (&journey.case.from, &journey.case.goal) else {
            return Ok(());
        };
        for (i, q) in journey.path.states.iter().enumerate() {
            let mut rest = q.clone();
            rest.joints[*finger] = from.joints[*finger];
            rest.contacts[*finger] = from.contacts[*finger];
            ensure(rest == *from, || format!("more than finger {} moves in state {i}", finger.0))?;
        }
        Ok(())
    })
}

pub(super) fn touches_at_ends(subject: &Subject<'_>) -> Finding {
    on_journeys::<Regrasp>(subject, |journey| {
        let Goal::Regrasp { finger, .. } = &journey.case.goal else { return Ok(()) };
        let states = &journey.path.states;
        let last = states.len().saturating_sub(1) as f64;
        if states.len() < 2 {
            return Ok(());
        }
        for (at, q) in instants(&journey.path) {
            let gap = Touch::new(journey.case.bench, &q, *finger).gap;
            let end = at == 0.0 || at == last;
            ensure(end || gap > 0.0, || format!("the finger touches, gap {gap:e} m, at {at} of {last}"))?;
            let touching = end || q.contacts[*finger].is_none() || at < 1.0;
            ensure(touching, || format!("says that it touches at {at} of {last}"))?;
        }
        Ok(())
    })
}

/// The law that the verifier has.
pub(super) fn lifts(subject: &Subject<'_>) -> Finding {
    on_journeys::<Regrasp>(subject, |journey| {
        let (bench, case) = (journey.case.bench, journey.case);
        let (task, target) = (bench.task(), case.goal.target());
        let ground = Ground { mesh: &bench.world.object.mesh, radius: bench.radius() };
        let chain = Chain { task: &task, ground, closure: 0.5 * bench.tolerances.closure };
        let (from, reached, path) = (&case.from, &journey.reached, &journey.path);
        let kept = laws::lift_kept(&Motion { chain, from, to: &target, reached, path });
        kept.map_err(|fault| Fault::Broken(fault.what))
    })
}
