//! Laws of a local planner's answer.

use super::case::{Goal, cases};
use super::{Journey, Kind, build, journeys, on_journeys};
use crate::fixtures::Bench;
use crate::law::{Always, Subject, context, counted_once, pure, random};
use crate::report::{Fault, Finding, ensure};
use regrasp_api::{
    BodyPair, CallError, Clearance, Configuration, Context, FingerIndex, FingerJoints, FingerSet,
    LocalPlanner, PairDistance, Path, Pose, Reason, Slot, Task, TipRule,
};
use regrasp_audit::laws;

pub(super) fn ends<K: Kind>(subject: &Subject<'_>) -> Finding {
    on_journeys::<K>(subject, |journey| {
        let states = &journey.path.states;
        ensure(states.first() == Some(&journey.case.from), || {
            format!("the first of {} states is not where it began", states.len())
        })?;
        ensure(states.last() == Some(&journey.reached.end), || {
            format!("the last of {} states is not the end that it returns", states.len())
        })?;
        restarts(subject, journey)
    })
}

/// What a path held before is none of its states.
fn restarts(subject: &Subject<'_>, journey: &Journey) -> Finding {
    let (case, mut used) = (journey.case, Path { states: vec![journey.reached.end.clone(); 2] });
    let (task, target) = (case.bench.task(), case.goal.target());
    build(subject, case)?.connect(&task, &case.from, &target, Some(&mut used), &mut context(0))?;
    ensure(used.states.first() == Some(&case.from), || {
        "it goes on where the path that it is given ends, and does not restart it".into()
    })
}

pub(super) fn reached<K: Kind>(subject: &Subject<'_>) -> Finding {
    on_journeys::<K>(subject, |journey| {
        let (fraction, stop) = (journey.reached.fraction, journey.reached.stop);
        let fits = (0.0..=1.0).contains(&fraction) && (fraction == 1.0) == stop.is_none();
        ensure(fits, || format!("fraction {fraction} with {stop:?}"))?;
        Ok(())
    })
}

pub(super) fn target<K: Kind>(subject: &Subject<'_>) -> Finding {
    for journey in journeys::<K>(subject)?.iter().filter(|journey| journey.reached.stop.is_none()) {
        let end = &journey.reached.end;
        let there = match &journey.case.goal {
            Goal::Grasp(q) => *end == **q,
            Goal::Transfer(X_HO) => end.X_HO == *X_HO,
            Goal::Regrasp { finger, contact, joints } => {
                end.joints[*finger] == *joints && end.contacts[*finger] == *contact
            }
        };
        ensure(there, || format!("claims {:?}, ends at {end:?}", journey.case.goal))?;
    }
    Ok(())
}

pub(super) fn path_optional<K: Kind>(subject: &Subject<'_>) -> Finding {
    for (key, journey) in journeys::<K>(subject)?.iter().enumerate() {
        let case = journey.case;
        // The random stream is that of the journey: cases that the plugin refuses to be built for have none.
        let index = cases(K::SLOT).iter().position(|other| std::ptr::eq(other, case)).unwrap_or(key);
        let mut context = context(index as u64);
        let (task, target) = (case.bench.task(), case.goal.target());
        let bare = build(subject, case)?.connect(&task, &case.from, &target, None, &mut context)?;
        ensure(bare == journey.reached, || {
            format!("without a path {bare:?}, with one {:?}", journey.reached)
        })?;
    }
    Ok(())
}

pub(super) fn fraction<K: Kind>(subject: &Subject<'_>) -> Finding {
    on_journeys::<K>(subject, |journey| {
        let case = journey.case;
        // A fraction that is none is another law's.
        if laws::reached_kept(&journey.reached).is_err() {
            return Ok(());
        }
        let (task, target) = (case.bench.task(), case.goal.target());
        let kept = laws::fraction_kept(&task, &case.from, &target, &journey.reached);
        kept.map_err(|fault| Fault::Broken(fault.what))
    })
}

pub(super) fn succeeds<K: Kind>(subject: &Subject<'_>) -> Finding {
    let journeys = journeys::<K>(subject)?;
    // A simulation may see the object drop, or a fingertip slip, on motions of one kind that roll on paper;
    // not on most of all.
    let simulated = |stop: &Reason| matches!(stop, Reason::Stray | Reason::Slip);
    let all: Vec<_> = journeys.iter().filter(|journey| journey.case.clear.is_some()).collect();
    let lost = all.iter().filter(|journey| journey.reached.stop.is_some()).count();
    ensure(2 * lost <= all.len(), || {
        format!("of {} motions of all kinds with nothing in the way {lost} fail", all.len())
    })?;
    let mut kinds: Vec<&str> = journeys.iter().filter_map(|journey| journey.case.clear).collect();
    kinds.sort_unstable();
    kinds.dedup();
    for kind in kinds {
        let clear: Vec<_> = journeys.iter().filter(|journey| journey.case.clear == Some(kind)).collect();
        let stops = clear.iter().filter_map(|journey| journey.reached.stop);
        let stops: Vec<_> = stops.filter(|stop| !simulated(stop)).collect();
        ensure(2 * stops.len() <= clear.len(), || {
            format!(
                "of {} motions with nothing in the way ({kind}) {} fail: {stops:?}",
                clear.len(),
                stops.len()
            )
        })?;
    }
    Ok(())
}

/// Everything is in the way.
struct Crowded;

const PAIR: BodyPair = (regrasp_api::Body::Palm, regrasp_api::Body::Object);

impl Clearance for Crowded {
    fn object_free(&self, _: &Pose) -> Result<(), BodyPair> {
        Err(PAIR)
    }
    fn finger_free(&self, _: FingerIndex, _: &FingerJoints, _: &Pose, _: TipRule) -> Result<(), BodyPair> {
        Err(PAIR)
    }
    fn fingers_free(
        &self,
        _: (FingerIndex, &FingerJoints),
        _: (FingerIndex, &FingerJoints),
    ) -> Result<(), BodyPair> {
        Err(PAIR)
    }
    fn configuration_free(&self, _: &Configuration, _: FingerSet, _: bool) -> Result<(), BodyPair> {
        Err(PAIR)
    }
    fn distances(&self, _: &Configuration, _: f64) -> Vec<PairDistance> {
        vec![PairDistance { pair: PAIR, distance: 0.0 }]
    }
}

pub(super) fn reasons<K: Kind>(subject: &Subject<'_>) -> Finding {
    on_journeys::<K>(subject, |journey| {
        let kept = laws::refusal_counted(K::SLOT, &journey.reached, &journey.tally);
        kept.map_err(|fault| Fault::Broken(fault.what))
    })?;
    for case in journeys::<K>(subject)?.iter().map(|journey| journey.case).filter(|case| case.clear.is_none())
    {
        let planner = build(subject, case)?;
        let task = Task { clearance: &Crowded, ..case.bench.task() };
        for path in [None, Some(&mut Path::default())] {
            let mut context = context(0);
            let reached = planner.connect(&task, &case.from, &case.goal.target(), path, &mut context)?;
            let Some(reason) = reached.stop else { continue };
            let counted: u64 = Reason::ALL.iter().map(|&r| context.tally.rejections(K::SLOT, r)).sum();
            ensure(context.tally.rejections(K::SLOT, reason) == 1 && counted == 1, || {
                format!("one refusal for {reason:?}, {counted} counted in its slot")
            })?;
        }
    }
    Ok(())
}

pub(super) fn counted<K: Kind>(subject: &Subject<'_>) -> Finding {
    for case in journeys::<K>(subject)?.iter().map(|journey| journey.case) {
        let mut context = context(0);
        let (task, target) = (case.bench.task(), case.goal.target());
        build(subject, case)?.connect(&task, &case.from, &target, None, &mut context)?;
        counted_once(&context, K::SLOT)?;
        let others = [Slot::GraspPlanner, Slot::TransferPlanner, Slot::RegraspPlanner].into_iter();
        let other = others.filter(|slot| *slot != K::SLOT).find(|slot| context.tally.calls(*slot) > 0);
        ensure(other.is_none(), || format!("it counts calls in another slot: {other:?}"))?;
    }
    Ok(())
}

pub(super) fn wrong_target<K: Kind>(subject: &Subject<'_>) -> Finding {
    for slot in [Slot::GraspPlanner, Slot::TransferPlanner, Slot::RegraspPlanner] {
        if subject.entry.slots.contains(&slot) {
            continue;
        }
        let built = cases(slot).iter().find_map(|case| Some((case, build(subject, case).ok()?)));
        let Some((case, planner)) = built else { continue };
        let task = case.bench.task();
        let found = planner.connect(&task, &case.from, &case.goal.target(), None, &mut context(0));
        let refused = matches!(found, Err(CallError::Unsupported { .. }));
        ensure(refused, || format!("a target of `{}` is answered with {found:?}", slot.name()))?;
    }
    Ok(())
}

pub(super) fn interrupt<K: Kind>(subject: &Subject<'_>) -> Finding {
    for journey in journeys::<K>(subject)?.iter().filter(|journey| journey.path.states.len() > 40) {
        let case = journey.case;
        let mut context = Context::new(random(0), &Always);
        let (task, target) = (case.bench.task(), case.goal.target());
        let found = build(subject, case)?.connect(&task, &case.from, &target, None, &mut context);
        ensure(matches!(found, Err(CallError::Interrupted)), || {
            format!("goes on, over {} states: {found:?}", journey.path.states.len())
        })?;
    }
    Ok(())
}

/// One plugin asked for everything with one hand and object, last things first, answers as a fresh one does:
/// what it remembers belongs to what it was asked.
fn in_another_order<K: Kind>(subject: &Subject<'_>) -> Finding {
    let journeys = journeys::<K>(subject)?;
    let mut planners: Vec<(&'static Bench, Box<dyn LocalPlanner>)> = Vec::new();
    for journey in journeys.iter().rev() {
        let case = journey.case;
        if !planners.iter().any(|(bench, _)| std::ptr::eq(*bench, case.bench)) {
            planners.push((case.bench, build(subject, case)?));
        }
        let planner = planners.iter().find(|(bench, _)| std::ptr::eq(*bench, case.bench));
        let Some((_, planner)) = planner else { continue };
        let index = cases(K::SLOT).iter().position(|other| std::ptr::eq(other, case)).unwrap_or(0);
        let (task, target, mut context) = (case.bench.task(), case.goal.target(), context(index as u64));
        let again = planner.connect(&task, &case.from, &target, Some(&mut Path::default()), &mut context)?;
        ensure(again == journey.reached, || {
            format!("`{}`, case {index}: answers otherwise after other calls", case.bench.name)
        })?;
    }
    Ok(())
}

pub(super) fn planner_pure<K: Kind>(subject: &Subject<'_>) -> Finding {
    in_another_order::<K>(subject)?;
    let journeys = journeys::<K>(subject)?;
    let cases: Vec<_> = journeys.iter().map(|journey| journey.case).take(6).collect();
    let planners: Vec<_> = cases.iter().map(|case| build(subject, case)).collect::<Finding<_>>()?;
    pure(cases.len(), |i| {
        let (mut path, mut context) = (Path::default(), context(i as u64));
        let (task, target) = (cases[i].bench.task(), cases[i].goal.target());
        let reached = planners[i].connect(&task, &cases[i].from, &target, Some(&mut path), &mut context)?;
        Ok((reached, path, context.tally))
    })
}
