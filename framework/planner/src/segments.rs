//! Segments of a motion as plain data: where they end, whether they move, and the same backwards.

use regrasp_api::{Configuration, FingerIndex, FingerSet, Pose, angle_between};
use regrasp_plan::Segment;

/// Whether anything moves in a segment.
pub(crate) fn moves(segment: &Segment) -> bool {
    segment.states.len() > 1
}

/// The configuration in which a segment ends.
pub(crate) fn end(segment: &Segment) -> &Configuration {
    segment.states.last().expect("a segment has its start")
}

/// The segments backwards: stored states reversed, nothing integrated again.
pub(crate) fn reversed(mut segments: Vec<Segment>) -> Vec<Segment> {
    segments.reverse();
    segments.iter_mut().for_each(|segment| segment.states.reverse());
    segments
}

/// The last of the states after `at`, which lie on one straight motion of the object, that is no farther
/// along it than `end`.
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

/// The fingers whose contact or joints differ between two configurations.
pub(crate) fn differing(a: &Configuration, b: &Configuration) -> FingerSet {
    let differs = |&finger: &FingerIndex| {
        a.contacts[finger] != b.contacts[finger] || a.joints[finger] != b.joints[finger]
    };
    a.contacts.fingers().filter(differs).collect()
}
