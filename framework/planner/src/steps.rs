//! Executable steps between two configurations: the object rolls, then fingers are regrasped.

use crate::order::regrasp_all;
use crate::segments::farthest;
use crate::session::Work;
use regrasp_api::{CallError, Configuration, Path, Pose, Reached, Target};
use regrasp_plan::{Segment, SegmentKind};

/// Rolls the object towards a pose.
///
/// The segment has one state where it did not move: a motion leaves such rests out
/// ([`crate::segments::moves`]).
pub(crate) fn transfer(
    work: &mut Work<'_>,
    from: &Configuration,
    to: &Pose,
) -> Result<(Reached, Segment), CallError> {
    let mut path = Path::default();
    let target = Target::Transfer(to);
    let reached =
        work.plugins.transfer.connect(work.task, from, &target, Some(&mut path), &mut work.context)?;
    Ok((reached, Segment::new(SegmentKind::Transfer, path.states)))
}

/// Transfer from `from` to the pose of `to`, then regrasps to its contacts; `None` if that fails.
pub(crate) fn transfer_then_regrasp(
    work: &mut Work<'_>,
    from: &Configuration,
    to: &Configuration,
) -> Result<Option<Vec<Segment>>, CallError> {
    let mut steps = Vec::new();
    let mut there = from.clone();
    if from.X_HO != to.X_HO {
        let (reached, segment) = transfer(work, from, &to.X_HO)?;
        if !reached.is_complete() {
            return Ok(None);
        }
        steps.push(segment);
        there = reached.end;
    }
    let Some(regrasps) = regrasp_all(work, &there, to)? else { return Ok(None) };
    steps.extend(regrasps);
    Ok(Some(steps))
}

/// A roll cut short, or rolled on, so that it ends exactly at a pose on its way; `None` if it cannot be
/// rolled that far.
///
/// What is rolled on stays with `rolled`.
pub(crate) fn rolled_to(
    work: &mut Work<'_>,
    rolled: &mut Segment,
    X_HO: &Pose,
) -> Result<Option<Segment>, CallError> {
    let last = farthest(&rolled.states, 0, X_HO);
    let mut states = rolled.states[..=last].to_vec();
    let from = states[last].clone();
    let mut complete = from.X_HO == *X_HO;
    if !complete {
        let (reached, rest) = transfer(work, &from, X_HO)?;
        states.extend(rest.states.into_iter().skip(1));
        complete = reached.is_complete();
        if last + 1 == rolled.states.len() {
            rolled.states.clone_from(&states);
        }
    }
    Ok(complete.then(|| Segment::new(SegmentKind::Transfer, states)))
}
