//! The passes of reachability: how fast each state is passed, and how long each step takes.
//!
//! With the squares x0, x1 of the speeds at a step's ends, chord c, span S, and e0, e1 the tangents less the
//! chord, the cubic's accelerations at the step's ends are
//!
//! A0 = (c (x1 - x0)/2 - (2 e0 x0 + e1 x1) - (2 e0 + e1) √(x0 x1))/S,
//! A1 = (c (x1 - x0)/2 + (e0 x0 + 2 e1 x1) + (e0 + 2 e1) √(x0 x1))/S.
//!
//! The root lies between 0 and (x0 + x1)/2: demanding the limits for both makes them linear in x0 and x1, and
//! asks for a little more.

use super::{JointBounds, Path};
use std::cmp::Ordering;

/// What the passes find.
pub(super) struct Pace {
    /// The speed dσ/dt at each state.
    pub(super) speeds: Vec<f64>,
    /// How long each step takes (s).
    pub(super) durations: Vec<f64>,
}

/// One limit on a step: from · x0 + to · x1 ≤ most.
#[derive(Clone, Copy)]
struct Row {
    from: f64,
    to: f64,
    most: f64,
}

/// A step that takes so many times as long as from rest to rest is driven from rest to rest: at a sharp turn
/// the speed can be next to nothing, and the step beside it next to endless.
const CRAWL: f64 = 10.0;

/// The fastest speeds that keep every limit.
pub(super) fn pace(path: &Path, bounds: &JointBounds) -> Pace {
    let mut caps = path.caps.clone();
    loop {
        let pace = fastest_below(path, bounds, &caps);
        let crawls = |&step: &usize| pace.durations[step] > CRAWL * path.rest_to_rest[step];
        let crawling: Vec<usize> = (0..pace.durations.len()).filter(crawls).collect();
        if crawling.is_empty() {
            return within_limits(path, bounds, pace);
        }
        // Each round takes away the last speed of a state, so that the rounds end.
        for step in crawling {
            caps[step..=step + 1].fill(0.0);
        }
    }
}

/// The fastest speeds below these.
fn fastest_below(path: &Path, bounds: &JointBounds, caps: &[f64]) -> Pace {
    let states = path.stops.len();
    let mut highest: Vec<f64> = caps.iter().map(|cap| cap * cap).collect();
    let mut rows = Vec::new();
    for step in (0..states.saturating_sub(1)).rev() {
        if highest[step] > 0.0 {
            limits_of(path, bounds, step, &mut rows);
            highest[step] = most_before(&rows, highest[step], highest[step + 1]);
        }
    }
    let mut x = highest;
    for step in 0..states.saturating_sub(1) {
        if x[step + 1] > 0.0 {
            limits_of(path, bounds, step, &mut rows);
            x[step + 1] = most_after(&rows, x[step], x[step + 1]);
        }
    }
    let mut pace = Pace { speeds: x.iter().map(|x| x.max(0.0).sqrt()).collect(), durations: Vec::new() };
    pace.durations = (0..states.saturating_sub(1)).map(|step| duration(path, &pace.speeds, step)).collect();
    pace
}

/// Slower by what rounding may leave beyond the limits.
fn within_limits(path: &Path, bounds: &JointBounds, mut pace: Pace) -> Pace {
    let slower = worst_ratio(path, bounds, &pace).max(1.0);
    pace.durations.iter_mut().for_each(|h| *h *= slower);
    pace.speeds.iter_mut().for_each(|speed| *speed /= slower);
    pace
}

fn duration(path: &Path, speeds: &[f64], step: usize) -> f64 {
    let sum = speeds[step] + speeds[step + 1];
    if sum > 0.0 { 2.0 * path.spans[step] / sum } else { path.rest_to_rest[step] }
}

/// The acceleration limits of a step.
fn limits_of(path: &Path, bounds: &JointBounds, step: usize, rows: &mut Vec<Row>) {
    rows.clear();
    for (j, (&c, &most)) in path.chord(step).iter().zip(&bounds.acceleration).enumerate() {
        let (e0, e1) = (path.excess(step, 0, j), path.excess(step, 1, j));
        if c == 0.0 && e0 == 0.0 && e1 == 0.0 {
            continue;
        }
        let most = most * path.spans[step];
        for root in [0.0, 0.5] {
            let at_start = (2.0 * e0 + e1) * root;
            let at_end = (e0 + 2.0 * e1) * root;
            let ends = [
                (-c / 2.0 - 2.0 * e0 - at_start, c / 2.0 - e1 - at_start),
                (-c / 2.0 + e0 + at_end, c / 2.0 + 2.0 * e1 + at_end),
            ];
            for (from, to) in ends {
                rows.push(Row { from, to, most });
                rows.push(Row { from: -from, to: -to, most });
            }
        }
    }
}

/// The largest x0 up to `cap` for which some x1 between 0 and `next` keeps every limit.
///
/// The room that is left for x1 is a concave function of x0, not negative at 0: Newton's method from above
/// finds where it becomes zero.
fn most_before(rows: &[Row], cap: f64, next: f64) -> f64 {
    let mut x = cap;
    for _ in 0..64 {
        let (mut upper, mut lower) = ((next, 0.0), (0.0, 0.0));
        let at = |line: (f64, f64)| line.0 + line.1 * x;
        let mut alone = x;
        for row in rows {
            if row.to == 0.0 {
                alone = if row.from > 0.0 { alone.min(row.most / row.from) } else { alone };
                continue;
            }
            let line = (row.most / row.to, -row.from / row.to);
            if row.to > 0.0 && at(line) < at(upper) {
                upper = line;
            } else if row.to < 0.0 && at(line) > at(lower) {
                lower = line;
            }
        }
        let (room, slope) = (at(upper) - at(lower), upper.1 - lower.1);
        let crossing = if room < 0.0 { x - room / slope } else { x };
        let better = crossing.min(alone);
        // What is not a number is no better either.
        if better.partial_cmp(&(x * (1.0 - 1e-12))) != Some(Ordering::Less) {
            return x;
        }
        x = better.max(0.0);
    }
    0.0
}

/// The largest x1 up to `cap` that the limits allow after x0.
fn most_after(rows: &[Row], x0: f64, cap: f64) -> f64 {
    let rising = rows.iter().filter(|row| row.to > 0.0);
    rising.map(|row| (row.most - row.from * x0) / row.to).fold(cap, f64::min).max(0.0)
}

/// By how much all steps must last longer for every limit to hold; at most 1 where all hold. What rounding
/// may leave, no more.
fn worst_ratio(path: &Path, bounds: &JointBounds, pace: &Pace) -> f64 {
    let mut worst = 0.0_f64;
    for (step, &h) in pace.durations.iter().enumerate() {
        let (s0, s1) = (pace.speeds[step], pace.speeds[step + 1]);
        for (j, &c) in path.chord(step).iter().enumerate() {
            let m = c * path.spans[step] / h;
            let (v0, v1) = (path.tangent(step)[j] * s0, path.tangent(step + 1)[j] * s1);
            let fastest = fastest(v0, v1, m);
            let ends = [6.0 * m - 4.0 * v0 - 2.0 * v1, 2.0 * v0 + 4.0 * v1 - 6.0 * m];
            let steepest = ends[0].abs().max(ends[1].abs()) / h;
            worst = worst.max((steepest / bounds.acceleration[j]).sqrt());
            worst = worst.max(fastest / bounds.velocity[j]);
        }
    }
    worst
}

/// The largest velocity of a cubic with these velocities at its ends and this mean: a parabola with the
/// Bézier points v0, b, v1.
fn fastest(v0: f64, v1: f64, mean: f64) -> f64 {
    let b = 3.0 * mean - v0 - v1;
    let ends = v0.abs().max(v1.abs());
    if (v0 - b) * (v1 - b) <= 0.0 {
        return ends; // No extremum inside.
    }
    ends.max((v0 - (v0 - b) * (v0 - b) / (v0 - 2.0 * b + v1)).abs())
}
