//! Algorithm 3's connection outside GS_n: rolls and regrasps between two nodes.

use crate::foresight::outlook;
use crate::order::regrasp_all;
use crate::segments::{end, reversed};
use crate::session::Work;
use crate::steps::{rolled_to, transfer};
use regrasp_api::{CallError, Configuration, Pose, Reason, Slot, interpolate};
use regrasp_plan::Segment;

/// How much of the way both ends together must be able to look along, for rolls go farther than looks. Our
/// choice: with 1 the paper's sphere needs twice the instructions, with 0.3 a tenth more.
const HOPE: f64 = 0.6;

/// Where the fingers are regrasped if they cannot be where the rolls first met: this far on towards either
/// end.
const ASIDE: f64 = 0.3;

/// Transfers and regrasps from one configuration to another; `None` if they fail.
///
/// The paper rolls from one end to the pose of the other and regrasps there. Here both ends roll towards each
/// other, and the fingers are regrasped where they meet: a motion reversed is a motion, and two rolls reach
/// twice as far as one.
pub(crate) fn connect(
    work: &mut Work<'_>,
    from: &Configuration,
    to: &Configuration,
) -> Result<Option<Vec<Segment>>, CallError> {
    let looks = [outlook(work.task, from, &to.X_HO), outlook(work.task, to, &from.X_HO)];
    if looks[0].fraction + looks[1].fraction < HOPE {
        work.context.reject(Slot::TransferPlanner, looks[0].barred.unwrap_or(Reason::Reach));
        return Ok(None);
    }
    let meeting = on_the_way(from, to, share(looks.map(|look| look.fraction)));
    let Some((mut rolls, X_HO)) = approach(work, [from, to], &meeting)? else {
        return Ok(None);
    };
    let asides = [&from.X_HO, &to.X_HO].map(|end| interpolate(&X_HO, end, ASIDE));
    for place in [X_HO].into_iter().chain(asides.into_iter().filter(|aside| *aside != X_HO)) {
        if let Some(steps) = regrasp_at(work, &mut rolls, &place)? {
            return Ok(Some(steps));
        }
    }
    Ok(None)
}

/// Where on the way (a fraction) two ends meet that can look this far: at an end if the other sees all the
/// way.
fn share([ahead, behind]: [f64; 2]) -> f64 {
    if ahead >= 1.0 {
        1.0
    } else if behind >= 1.0 {
        0.0
    } else {
        0.5 * (1.0 - behind + ahead)
    }
}

/// The pose a fraction `s` of the way; exact at both ends.
fn on_the_way(from: &Configuration, to: &Configuration, s: f64) -> Pose {
    match s {
        ..=0.0 => from.X_HO,
        1.0.. => to.X_HO,
        _ => interpolate(&from.X_HO, &to.X_HO, s),
    }
}

/// Rolls from both ends to one pose, `meeting` or where the rolls do meet; `None` if they do not.
fn approach(
    work: &mut Work<'_>,
    [from, to]: [&Configuration; 2],
    meeting: &Pose,
) -> Result<Option<([Segment; 2], Pose)>, CallError> {
    let (ahead, mut first) = transfer(work, from, meeting)?;
    let (behind, last) = transfer(work, to, &ahead.end.X_HO)?;
    if behind.is_complete() {
        return Ok(Some(([first, last], ahead.end.X_HO)));
    }
    // What stopped one of the rolls before they met will stop it again.
    if !ahead.is_complete() || rolled_to(work, &mut first, &behind.end.X_HO)?.is_none() {
        return Ok(None);
    }
    Ok(Some(([first, last], behind.end.X_HO)))
}

/// Both rolls made to end at a pose on their way, and the regrasps between them; the second roll is walked
/// backwards.
fn regrasp_at(
    work: &mut Work<'_>,
    [ahead, behind]: &mut [Segment; 2],
    X_HO: &Pose,
) -> Result<Option<Vec<Segment>>, CallError> {
    let Some(first) = rolled_to(work, ahead, X_HO)? else { return Ok(None) };
    let Some(last) = rolled_to(work, behind, X_HO)? else { return Ok(None) };
    let (from, to) = (end(&first), end(&last));
    let Some(regrasps) = regrasp_all(work, from, to)? else { return Ok(None) };
    let back = reversed(vec![last]);
    Ok(Some([first].into_iter().chain(regrasps).chain(back).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_meet_in_the_middle_of_what_both_see_or_at_the_end_that_is_seen() {
        // Seen by both from 0.25 to 0.75; then by none from 0.25 to 0.5.
        assert_eq!(share([0.75, 0.75]), 0.5);
        assert_eq!(share([0.25, 0.5]), 0.375);
        assert_eq!(share([1.0, 0.5]), 1.0);
        assert_eq!(share([0.5, 1.0]), 0.0);
        assert_eq!(share([1.0, 1.0]), 1.0);
    }
}
