//! Executable steps between two configurations: transfers and regrasps (Algorithm 3 and the decomposition).

use crate::order::Order;
use crate::session::Session;
use regrasp_api::{
    CallError, Configuration, Context, FingerIndex, FingerSet, Path, Pose, Reached, Target, Task,
    angle_between,
};
use regrasp_plan::{Segment, SegmentKind};

/// Rolls the object towards a pose. The segment has one state where it did not move: a motion leaves such rests out ([`moves`]).
pub(crate) fn transfer(
    session: &Session<'_>,
    task: &Task<'_>,
    from: &Configuration,
    to: &Pose,
    context: &mut Context<'_>,
) -> Result<(Reached, Segment), CallError> {
    let mut path = Path::default();
    let reached =
        session.drivers.transfer.connect(task, from, &Target::Transfer(to), Some(&mut path), context)?;
    Ok((reached, Segment { kind: SegmentKind::Transfer, states: path.states, times: Vec::new() }))
}

/// Transfer from `from` to the pose of `to`, then regrasps to its contacts; `None` if that fails.
pub(crate) fn transfer_then_regrasp(
    session: &Session<'_>,
    task: &Task<'_>,
    from: &Configuration,
    to: &Configuration,
    context: &mut Context<'_>,
) -> Result<Option<Vec<Segment>>, CallError> {
    let mut steps = Vec::new();
    let mut there = from.clone();
    if from.X_HO != to.X_HO {
        let (reached, segment) = transfer(session, task, from, &to.X_HO, context)?;
        if !reached.is_complete() {
            return Ok(None);
        }
        steps.push(segment);
        there = reached.end;
    }
    let Some(regrasps) = regrasp_all(session, task, &there, to, context)? else { return Ok(None) };
    steps.extend(regrasps);
    Ok(Some(steps))
}

/// Whether anything moves in a segment.
pub(crate) fn moves(segment: &Segment) -> bool {
    segment.states.len() > 1
}

/// The configuration in which a segment ends.
pub(crate) fn end(segment: &Segment) -> &Configuration {
    segment.states.last().expect("a segment has its start")
}

/// A roll cut short, or rolled on, so that it ends exactly at a pose on its way; `None` if it cannot be rolled that far.
///
/// What is rolled on stays with `rolled`.
pub(crate) fn rolled_to(
    session: &Session<'_>,
    task: &Task<'_>,
    rolled: &mut Segment,
    X_HO: &Pose,
    context: &mut Context<'_>,
) -> Result<Option<Segment>, CallError> {
    let last = farthest(&rolled.states, 0, X_HO);
    let mut states = rolled.states[..=last].to_vec();
    let from = states[last].clone();
    let mut complete = from.X_HO == *X_HO;
    if !complete {
        let (reached, rest) = transfer(session, task, &from, X_HO, context)?;
        states.extend(rest.states.into_iter().skip(1));
        complete = reached.is_complete();
        if last + 1 == rolled.states.len() {
            rolled.states.clone_from(&states);
        }
    }
    Ok(complete.then(|| Segment { kind: SegmentKind::Transfer, states, times: Vec::new() }))
}

/// The last of the states after `at`, which lie on one straight motion of the object, that is no farther along it than `end`.
pub(crate) fn farthest(states: &[Configuration], at: usize, end: &Pose) -> usize {
    let progress = |X_HO: &Pose| {
        let start = &states[at].X_HO;
        let moved = (X_HO.translation.vector - start.translation.vector).norm();
        // Metres and radians grow in proportion along one path: any positive weights give the same order.
        moved + angle_between(&X_HO.rotation, &start.rotation)
    };
    let reached = progress(end);
    (at..states.len()).take_while(|&i| progress(&states[i].X_HO) <= reached).last().unwrap_or(at)
}

/// The steps backwards: stored states reversed, nothing integrated again.
pub(crate) fn reversed(mut steps: Vec<Segment>) -> Vec<Segment> {
    steps.reverse();
    steps.iter_mut().for_each(|segment| segment.states.reverse());
    steps
}

/// The fingers whose contact or joints differ between two configurations.
pub(crate) fn differing(a: &Configuration, b: &Configuration) -> FingerSet {
    let differs = |&finger: &FingerIndex| {
        a.contacts[finger] != b.contacts[finger] || a.joints[finger] != b.joints[finger]
    };
    a.contacts.fingers().filter(differs).collect()
}

/// Moves the fingers one after the other from `from` to the contacts of `to`, the object resting; `None` if no order works.
pub(crate) fn regrasp_all(
    session: &Session<'_>,
    task: &Task<'_>,
    from: &Configuration,
    to: &Configuration,
    context: &mut Context<'_>,
) -> Result<Option<Vec<Segment>>, CallError> {
    Order::new(session, task, from, to).find(context)
}

/// One finger moves from `q` to its contact and joints of `to`; `None` if it cannot.
pub(crate) fn regrasp(
    session: &Session<'_>,
    task: &Task<'_>,
    q: &Configuration,
    (finger, to): (FingerIndex, &Configuration),
    context: &mut Context<'_>,
) -> Result<Option<Segment>, CallError> {
    let mut path = Path::default();
    let target =
        Target::Regrasp { finger, contact: to.contacts[finger].as_ref(), joints: &to.joints[finger] };
    let reached = session.drivers.regrasp.connect(task, q, &target, Some(&mut path), context)?;
    let segment = || Segment { kind: SegmentKind::Regrasp(finger), states: path.states, times: Vec::new() };
    Ok(reached.is_complete().then(segment))
}
