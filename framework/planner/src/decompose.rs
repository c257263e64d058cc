//! Decomposition of a path in GS_n, along which contacts slide, into transfers and regrasps.
//!
//! Greedy: roll along the path as far as it goes, regrasp to the path's contacts there, go on; where the regrasps fail, back
//! off and try again. Nothing guarantees success: the caller deletes the edge then. Greedy needs fewer regrasps
//! than bisection at the same success rate.

use crate::session::Session;
use crate::steps;
use regrasp_api::{CallError, Configuration, Context, Path, Target, Task};
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
    let (reached, mut rolled) = steps::transfer(session, task, &states[at], &states[last].X_HO, context)?;
    let mut next = if reached.is_complete() { last } else { steps::farthest(states, at, &reached.end.X_HO) };
    while next > at {
        context.proceed()?;
        if let Some(segment) = steps::rolled_to(session, task, &mut rolled, &states[next].X_HO, context)? {
            let there = steps::end(&segment);
            if let Some(regrasps) = steps::regrasp_all(session, task, there, &states[next], context)? {
                let mut segments = vec![segment];
                segments.extend(regrasps);
                return Ok(Some((next, segments)));
            }
        }
        next = at + ((next - at) as f64 * BACK_OFF) as usize;
    }
    Ok(None)
}
