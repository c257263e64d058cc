//! Corners that a controller can pass: states beside them.
//!
//! How far a cubic leaves a corner grows with the steps beside it. A corner of a lifted finger's way gets a
//! state on each side, on the straight steps, so near that the cubic stays close enough: the motion means
//! what it meant, and need not stop. Contacts of other states belong to whoever rolls them: transfers keep
//! theirs.

use super::{JointBounds, Path};
use crate::{Motion, SegmentKind};
use regrasp_api::{Configuration, FingerIndex};

/// A corner is worth two states where it can be passed with this part of the squared speed that a step from
/// rest gives. Our choice.
const WORTH: f64 = 0.05;
/// The largest part of a step that a corner at one of its ends may take.
const PART: f64 = 0.45;

/// Puts states beside the corners of regrasps that are worth it; whether there are any.
pub(super) fn blend(motion: &mut Motion, path: &Path, bounds: &JointBounds) -> bool {
    let (mut state, mut blended) = (0, false);
    for segment in &mut motion.segments {
        let steps = segment.states.len().saturating_sub(1);
        if let SegmentKind::Regrasp(finger) = segment.kind {
            let spans = |k: usize| spans_beside(path, bounds, state + k);
            let beside: Vec<Option<[f64; 2]>> = (0..=steps).map(spans).collect();
            if beside.iter().any(Option::is_some) {
                segment.states = with_states(&segment.states, finger, &beside);
                blended = true;
            }
        }
        state += steps;
    }
    blended
}

/// What part of the steps before and after a corner its own steps take; `None` where it is no corner, or not
/// worth it. 1 leaves a step as it is.
fn spans_beside(path: &Path, bounds: &JointBounds, k: usize) -> Option<[f64; 2]> {
    let reach = Some(path.reaches[k]).filter(|reach| *reach > 0.0)?;
    let sides = [path.spans[k - 1], path.spans[k]];
    let mut span = reach.min(sides[0]).min(sides[1]);
    for side in sides {
        if span < side {
            span = span.min(PART * side);
        }
    }
    let squared = |of: &dyn Fn(usize) -> f64| {
        (0..bounds.count()).map(|j| bounds.acceleration[j] / of(j)).fold(f64::INFINITY, f64::min)
    };
    let (before, after) = (path.chord(k - 1), path.chord(k));
    // The cubic turns from chord to chord over one such step on each side.
    let passing = squared(&|j| 2.0 * (after[j] - before[j]).abs() / span);
    let from_rest = squared(&|j| before[j].abs().max(after[j].abs()) / (2.0 * sides[0].min(sides[1])));
    let worth = passing >= WORTH * from_rest.min(1.0);
    worth.then(|| sides.map(|side| if span < side { span / side } else { 1.0 }))
}

/// The states with those beside the corners.
fn with_states(
    states: &[Configuration],
    finger: FingerIndex,
    beside: &[Option<[f64; 2]>],
) -> Vec<Configuration> {
    let mut all = Vec::with_capacity(states.len() + 2 * beside.len());
    let between = |k: usize, to: usize, part: f64| {
        let mut q = states[k].clone();
        q.joints[finger] = q.joints[finger].interpolate(&states[to].joints[finger], part);
        q
    };
    for (k, q) in states.iter().enumerate() {
        // Only what moves through the air may be anywhere on its way.
        let parts = beside[k].filter(|_| q.contacts[finger].is_none()).unwrap_or([1.0; 2]);
        all.extend((parts[0] < 1.0).then(|| between(k, k - 1, parts[0])));
        all.push(q.clone());
        all.extend((parts[1] < 1.0).then(|| between(k, k + 1, parts[1])));
    }
    all
}
