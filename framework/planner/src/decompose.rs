//! Decomposition of a path in GS_n, along which contacts slide, into transfers and regrasps.
//!
//! Greedy: roll along the path as far as it goes, regrasp to the path's contacts there, go on; where the
//! regrasps fail, back off and try again. By halving: roll from one end of a piece to the pose of the other
//! and regrasp there; where that fails, halve the piece. Nothing guarantees success: the caller deletes the
//! edge then. Greedy needs fewer regrasps than halving at the same success rate.

use crate::order::regrasp_all;
use crate::segments::{end, farthest};
use crate::session::Work;
use crate::steps::{rolled_to, transfer, transfer_then_regrasp};
use regrasp_api::{CallError, Configuration, Path, Target};
use regrasp_plan::Segment;

/// What is kept of the rolled way where the regrasps at its end fail.
const BACK_OFF: f64 = 0.7;

/// Executable steps from `from` to `to`, which a path in GS_n joins; `None` if the decomposition fails.
pub(crate) fn decompose(
    work: &mut Work<'_>,
    from: &Configuration,
    to: &Configuration,
) -> Result<Option<Vec<Segment>>, CallError> {
    let Some(states) = grasp_path(work, from, to)? else { return Ok(None) };
    let last = states.len() - 1;
    let (mut at, mut all) = (0, Vec::new());
    while at < last {
        match advance(work, &states, at)? {
            Some((next, segments)) => {
                all.extend(segments);
                at = next;
            }
            None => return Ok(None),
        }
    }
    Ok(Some(all))
}

/// The same by halving: a piece that cannot be rolled and regrasped as a whole is divided.
pub(crate) fn halve(
    work: &mut Work<'_>,
    from: &Configuration,
    to: &Configuration,
) -> Result<Option<Vec<Segment>>, CallError> {
    let Some(states) = grasp_path(work, from, to)? else { return Ok(None) };
    let mut all = Vec::new();
    // The pieces that are left, the next one last, as indices of their ends.
    let mut pieces = vec![(0, states.len() - 1)];
    while let Some((a, b)) = pieces.pop() {
        work.context.proceed()?;
        match transfer_then_regrasp(work, &states[a], &states[b])? {
            Some(segments) => all.extend(segments),
            None if b - a < 2 => return Ok(None),
            None => {
                let middle = a + (b - a) / 2;
                pieces.extend([(middle, b), (a, middle)]);
            }
        }
    }
    Ok(Some(all))
}

/// The states of the path in GS_n between two configurations; `None` if there is none.
fn grasp_path(
    work: &mut Work<'_>,
    from: &Configuration,
    to: &Configuration,
) -> Result<Option<Vec<Configuration>>, CallError> {
    let mut path = Path::default();
    let target = Target::Grasp(to);
    let reached = work.plugins.grasp.connect(work.task, from, &target, Some(&mut path), &mut work.context)?;
    Ok(reached.is_complete().then_some(path.states))
}

/// One transfer from state `at` and the regrasps after it: the index of the state reached, and the segments.
fn advance(
    work: &mut Work<'_>,
    states: &[Configuration],
    at: usize,
) -> Result<Option<(usize, Vec<Segment>)>, CallError> {
    let last = states.len() - 1;
    let (reached, mut rolled) = transfer(work, &states[at], &states[last].X_HO)?;
    let mut next = if reached.is_complete() { last } else { farthest(states, at, &reached.end.X_HO) };
    while next > at {
        work.context.proceed()?;
        if let Some(segment) = rolled_to(work, &mut rolled, &states[next].X_HO)? {
            let there = end(&segment);
            if let Some(regrasps) = regrasp_all(work, there, &states[next])? {
                let mut segments = vec![segment];
                segments.extend(regrasps);
                return Ok(Some((next, segments)));
            }
        }
        next = at + ((next - at) as f64 * BACK_OFF) as usize;
    }
    Ok(None)
}
