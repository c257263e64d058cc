//! Decomposition of a path in GS_n, along which contacts slide, into transfers and regrasps.
//!
//! Greedy: roll along the path as far as it goes, regrasp to the path's contacts there, go on; where the regrasps fail, back
//! off and try again. Nothing guarantees success: the caller deletes the edge then. Greedy needs fewer regrasps
//! than bisection at the same success rate.

use crate::session::Session;
use crate::steps;
use regrasp_api::{CallError, Configuration, Context, Path, Target, Task, angle_between};
use regrasp_plan::Segment;

/// What is kept of the rolled way where the regrasps at its end fail.
const BACK_OFF: f64 = 0.7;

/// Executable steps from `from` to `to`, which a path in GS_n joins; `None` if the decomposition fails.
pub(crate) fn decompose(
    session: &Session<'_>,
    task: &Task<'_>,
    from: &Configuration,
    to: &Configuration,
    context: &mut Context<'_>,
) -> Result<Option<Vec<Segment>>, CallError> {
    let mut path = Path::default();
    let reached = session.drivers.grasp.connect(task, from, &Target::Grasp(to), Some(&mut path), context)?;
    if !reached.is_complete() {
        return Ok(None);
    }
    let states = &path.states;
    let last = states.len() - 1;
    let (mut at, mut all) = (0, Vec::new());
    while at < last {
        match advance(session, task, states, at, context)? {
            Some((next, segments)) => {
                all.extend(segments);
                at = next;
            }
            None => return Ok(None),
        }
    }
    Ok(Some(all))
}

/// One transfer from state `at` and the regrasps after it: the index of the state reached, and the segments.
fn advance(
    session: &Session<'_>,
    task: &Task<'_>,
    states: &[Configuration],
    at: usize,
    context: &mut Context<'_>,
) -> Result<Option<(usize, Vec<Segment>)>, CallError> {
    let last = states.len() - 1;
    let (reached, rolled) = steps::transfer(session, task, &states[at], &states[last], context)?;
    let mut next = if reached.is_complete() { last } else { farthest(states, at, &reached.end) };
    while next > at {
        context.proceed()?;
        if let Some(segment) = rolled_to(session, task, &rolled, &states[next], context)? {
            let there = segment.states.last().expect("a rolled path has its start").clone();
            if let Some(regrasps) = steps::regrasp_all(session, task, &there, &states[next], context)? {
                let mut segments = vec![segment];
                segments.retain(|segment| segment.states.len() > 1);
                segments.extend(regrasps);
                return Ok(Some((next, segments)));
            }
        }
        next = at + ((next - at) as f64 * BACK_OFF) as usize;
    }
    Ok(None)
}

/// The rolled transfer cut short, so that it ends exactly at the pose of `to`; `None` if the last bit cannot be rolled.
fn rolled_to(
    session: &Session<'_>,
    task: &Task<'_>,
    rolled: &Segment,
    to: &Configuration,
    context: &mut Context<'_>,
) -> Result<Option<Segment>, CallError> {
    let mut segment = rolled.clone();
    if segment.states.last().is_some_and(|end| end.X_HO == to.X_HO) {
        return Ok(Some(segment));
    }
    segment.states.truncate(farthest(&rolled.states, 0, to) + 1);
    let from = segment.states.last().expect("a rolled path has its start").clone();
    let (reached, rest) = steps::transfer(session, task, &from, to, context)?;
    segment.states.extend(rest.states.into_iter().skip(1));
    Ok(reached.is_complete().then_some(segment))
}

/// The last of the states after `at`, which lie on one straight motion of the object, that is no farther along it than `end`.
fn farthest(states: &[Configuration], at: usize, end: &Configuration) -> usize {
    let progress = |q: &Configuration| {
        let start = &states[at].X_HO;
        let moved = (q.X_HO.translation.vector - start.translation.vector).norm();
        // Metres and radians grow in proportion along one path: any positive weights give the same order.
        moved + angle_between(&q.X_HO.rotation, &start.rotation)
    };
    let reached = progress(end);
    (at..states.len()).take_while(|&i| progress(&states[i]) <= reached).last().unwrap_or(at)
}
