//! Ways of lifted fingertips without zigzags.
//!
//! A regrasp follows a geodesic over facets at lift height, or a tree's edges: its path has corners that a
//! controller must stop at. Where the fingertip is high enough above the object its way is free to change:
//! each posture moves to the mean of its neighbours, some rounds over, and where the way still bends it gets
//! more postures; all as long as everything stays clear.

use crate::session::Session;
use regrasp_api::{
    CallError, Configuration, FingerIndex, FingerJoints, FingerSet, LoneFinger, Task, TipRule,
};
use regrasp_plan::{Segment, SegmentKind};

/// Rounds of averaging that are tried in turn until one leaves the way free. Our choice: n rounds even out
/// what is shorter than some √n steps.
const ROUNDS: [usize; 3] = [64, 16, 4];
/// Within so many postures of an end, averaging is weaker and weaker: the way leaves the end as it did.
const CLAMPED: f64 = 6.0;
/// How much three tips in a row may bend, in units of the closure tolerance: what a controller can pass with
/// some room ([`regrasp_plan::assign_times`]).
const BEND: f64 = 2.4;
/// The most steps that one is cut into.
const CUTS: f64 = 6.0;

/// Evens out the ways of all regrasps in place.
pub(crate) fn glide(
    session: &Session<'_>,
    task: &Task<'_>,
    segments: &mut [Segment],
) -> Result<(), CallError> {
    session.each(segments, |segment| {
        if let SegmentKind::Regrasp(finger) = segment.kind {
            glide_one(task, finger, &mut segment.states);
        }
    })
}

fn glide_one(task: &Task<'_>, finger: FingerIndex, states: &mut Vec<Configuration>) {
    let Some((first, last)) = lifted(task, finger, states) else { return };
    if last < first + 2 {
        return;
    }
    let resting = states[first + 1].clone();
    let lone = task.clearance.lone_finger(finger, &resting, FingerSet::first(resting.joints.len()));
    let before: Vec<FingerJoints> = states[first..=last].iter().map(|q| q.joints[finger]).collect();
    for rounds in ROUNDS {
        let after = curve(task, finger, &evened(&before, rounds));
        let inner = &after[1..after.len() - 1];
        if inner.iter().all(|joints| is_free(task, &*lone, finger, joints)) {
            let state = |joints: &FingerJoints| {
                let mut q = resting.clone();
                q.joints[finger] = *joints;
                q
            };
            states.splice(first + 1..last, inner.iter().map(state));
            return;
        }
    }
}

/// The first and the last state in which the finger is lifted; from the one to the other it touches nothing
/// and need not rise any more.
fn lifted(task: &Task<'_>, finger: FingerIndex, states: &[Configuration]) -> Option<(usize, usize)> {
    let height = task.resolution.retreat.into_iter().fold(task.resolution.lift, f64::min);
    let touches = |q: Option<&Configuration>| q.is_some_and(|q| q.contacts[finger].is_some());
    let is_high = |q: &Configuration| q.contacts[finger].is_none() && gap(task, finger, q) >= height;
    let first = if touches(states.first()) { states.iter().position(is_high)? } else { 0 };
    let last = if touches(states.last()) { states.iter().rposition(is_high)? } else { states.len() - 1 };
    (first < last).then_some((first, last))
}

/// The fingertip's distance from the object's surface (m).
fn gap(task: &Task<'_>, finger: FingerIndex, q: &Configuration) -> f64 {
    let p_HF = task.hand.tip_center(finger, &q.joints[finger]);
    let p_OF = q.X_HO.rotation.inverse() * (p_HF - q.X_HO.translation.vector);
    task.surface.project(&p_OF, None).distance - task.hand.fingertip_radius()
}

fn is_free(task: &Task<'_>, lone: &dyn LoneFinger, finger: FingerIndex, joints: &FingerJoints) -> bool {
    let clear = task.tolerances.clearance + task.resolution.clearance;
    task.hand.within_limits(finger, joints) && lone.free(joints, TipRule::Clear(clear)).is_ok()
}

/// The way after `rounds` of averaging, its ends where they were.
fn evened(way: &[FingerJoints], rounds: usize) -> Vec<FingerJoints> {
    let (mut now, mut next) = (way.to_vec(), way.to_vec());
    let last = way.len() - 1;
    for _ in 0..rounds {
        for k in 1..last {
            let middle = now[k - 1].interpolate(&now[k + 1], 0.5);
            let strength = (k.min(last - k) as f64 / CLAMPED).min(1.0);
            next[k] = now[k].interpolate(&middle, 0.5 * strength);
        }
        std::mem::swap(&mut now, &mut next);
    }
    now
}

/// The way with more postures where the fingertip's path bends, on the curve through its postures.
fn curve(task: &Task<'_>, finger: FingerIndex, way: &[FingerJoints]) -> Vec<FingerJoints> {
    let tips: Vec<_> = way.iter().map(|joints| task.hand.tip_center(finger, joints)).collect();
    let bend = |k: usize| {
        if k == 0 || k + 1 == tips.len() { 0.0 } else { (tips[k - 1] - tips[k] * 2.0 + tips[k + 1]).norm() }
    };
    let most = BEND * task.tolerances.closure;
    let mut all = vec![way[0]];
    for k in 0..way.len() - 1 {
        // Steps cut in n bend n² times less.
        let cuts = (bend(k).max(bend(k + 1)) / most).sqrt().ceil().clamp(1.0, CUTS);
        let around = [way[k.saturating_sub(1)], way[k], way[k + 1], way[(k + 2).min(way.len() - 1)]];
        all.extend((1..cuts as usize).map(|i| between(&around, i as f64 / cuts)));
        all.push(way[k + 1]);
    }
    all
}

/// The posture between the middle two of four in a row, on the smooth curve through them all (E. Catmull,
/// R. Rom, "A class of local interpolating splines", Computer Aided Geometric Design 1974).
fn between([a, b, c, d]: &[FingerJoints; 4], t: f64) -> FingerJoints {
    let mut joints = *b;
    for (j, q) in joints.iter_mut().enumerate() {
        let (a, b, c, d) = (a[j], b[j], c[j], d[j]);
        let bends = [c - a, 2.0 * a - 5.0 * b + 4.0 * c - d, 3.0 * (b - c) + d - a];
        *q += 0.5 * t * (bends[0] + t * (bends[1] + t * bends[2]));
    }
    joints
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> FingerJoints {
        FingerJoints::from_slice(&[x, y])
    }

    #[test]
    fn zigzags_go_and_straight_lines_and_ends_stay() {
        let straight: Vec<_> = (0..20).map(|k| at(k as f64, 0.5 * k as f64)).collect();
        for (a, b) in evened(&straight, 16).iter().zip(&straight) {
            assert!(a.max_difference(b) < 1e-12);
        }
        let zigzag: Vec<_> = (0..=30).map(|k| at(k as f64, if k % 6 < 3 { 0.0 } else { 1.0 })).collect();
        let even = evened(&zigzag, 64);
        assert_eq!((even[0], even[30]), (zigzag[0], zigzag[30]));
        let turn = |way: &[FingerJoints], k: usize| (way[k + 1][1] - 2.0 * way[k][1] + way[k - 1][1]).abs();
        let sharpest = |way: &[FingerJoints]| (1..30).map(|k| turn(way, k)).fold(0.0, f64::max);
        assert_eq!(sharpest(&zigzag), 1.0);
        assert!(sharpest(&even) < 0.1, "{}", sharpest(&even));
    }

    #[test]
    fn a_curve_passes_its_postures_and_is_a_line_where_they_are() {
        let line = [0.0, 1.0, 2.0, 3.0].map(|x| at(x, 2.0 * x));
        assert!(between(&line, 0.25).max_difference(&at(1.25, 2.5)) < 1e-15);
        let bent = [at(0.0, 0.0), at(1.0, 0.0), at(2.0, 1.0), at(2.0, 2.0)];
        assert_eq!((between(&bent, 0.0), between(&bent, 1.0)), (bent[1], bent[2]));
        let (before, after) =
            (between(&bent, 1.0 - 1e-6), between(&[bent[1], bent[2], bent[3], bent[3]], 1e-6));
        let [left, right] = [[before, bent[2]], [bent[2], after]].map(|[a, b]| [b[0] - a[0], b[1] - a[1]]);
        assert!((0..2).all(|j| (left[j] - right[j]).abs() < 1e-10), "one direction from both sides");
    }
}
