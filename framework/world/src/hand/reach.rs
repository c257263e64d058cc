//! A ball that holds every place a fingertip can reach.

use super::{inverse::JointRange, screw::Screw};
use regrasp_api::{JointKind, MAX_FINGER_JOINTS, Random, Vec3};
use std::{cmp::Ordering, collections::BinaryHeap};

/// Fixed random postures from which the ball's centre is found.
const POSTURES: usize = 512;
/// Most boxes of joint positions that are looked at to bound the ball's radius.
const BOXES: usize = 4000;
/// The radius may exceed the smallest one about its centre by this share.
const EXCESS: f64 = 0.005;

/// A ball that holds the tips of all postures in a box, and which joint adds most to its radius.
struct Swept {
    center: Vec3,
    radius: f64,
    widest: usize,
}

/// Sweeps the tip by one joint after another, from the last to the first, and encloses each arc or segment in a ball.
fn sweep(screws: &[Screw], p_HF0: &Vec3, limits: &[(f64, f64)]) -> Swept {
    let mut swept = Swept { center: *p_HF0, radius: 0.0, widest: 0 };
    let mut largest = -1.0;
    for (index, (screw, (lower, upper))) in screws.iter().zip(limits).enumerate().rev() {
        let half = 0.5 * (upper - lower);
        let moved = screw.move_point(&swept.center, 0.5 * (lower + upper));
        let added = match screw.kind {
            JointKind::Prismatic => {
                swept.center = moved;
                half
            }
            JointKind::Revolute => {
                let along = screw.axis * screw.axis.dot(&(moved - screw.point));
                let foot = screw.point + along;
                let (sin, cos) = half.min(std::f64::consts::FRAC_PI_2).sin_cos();
                swept.center = foot + (moved - foot) * cos;
                (moved - foot).norm() * sin
            }
        };
        swept.radius += added;
        if added > largest {
            (largest, swept.widest) = (added, index);
        }
    }
    swept
}

/// A box of joint positions, ordered by how far from the ball's centre its tips may lie.
struct Cell {
    limits: [(f64, f64); MAX_FINGER_JOINTS],
    bound: f64,
    widest: usize,
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// Centre (m, in H) and radius (m) of a ball that surely holds every reachable fingertip centre.
///
/// The centre is nearly that of the smallest such ball; the radius is bounded by branch and bound over boxes of joint
/// positions, to half a percent above the smallest one unless the count of boxes runs out first.
pub(super) fn reach_ball(screws: &[Screw], p_HF0: &Vec3, ranges: &[JointRange]) -> (Vec3, f64) {
    let tips = tips(screws, p_HF0, ranges);
    let center = enclosing_center(&tips);
    let farthest = tips.iter().map(|tip| (tip - center).norm()).fold(0.0, f64::max);
    let cell = |limits: [(f64, f64); MAX_FINGER_JOINTS]| {
        let swept = sweep(screws, p_HF0, &limits[..screws.len()]);
        Cell { limits, bound: (swept.center - center).norm() + swept.radius, widest: swept.widest }
    };
    let whole = std::array::from_fn(|k| ranges.get(k).map_or((0.0, 0.0), |range| (range.lower, range.upper)));
    let mut open = BinaryHeap::from([cell(whole)]);
    for _ in 0..BOXES {
        let Some(worst) = open.pop() else { break };
        if worst.bound <= farthest * (1.0 + EXCESS) {
            open.push(worst);
            break;
        }
        let (lower, upper) = worst.limits[worst.widest];
        let middle = 0.5 * (lower + upper);
        for part in [(lower, middle), (middle, upper)] {
            let mut limits = worst.limits;
            limits[worst.widest] = part;
            open.push(cell(limits));
        }
    }
    let radius = open.peek().map_or(farthest, |worst| worst.bound);
    // Rounding of the forward kinematics.
    (center, radius * (1.0 + 1e-9) + 1e-9)
}

/// Tips of fixed random postures, half of whose joints stand at a limit.
fn tips(screws: &[Screw], p_HF0: &Vec3, ranges: &[JointRange]) -> Vec<Vec3> {
    let mut random = Random::from_key(0, 1, 0, 0);
    let mut tip = || {
        screws.iter().zip(ranges).rev().fold(*p_HF0, |p, (screw, range)| {
            let s = (2.0 * random.unit() - 0.5).clamp(0.0, 1.0);
            screw.move_point(&p, range.at(s))
        })
    };
    (0..POSTURES).map(|_| tip()).collect()
}

/// Nearly the centre of the smallest ball about the points (Bădoiu & Clarkson, "Smaller core-sets for balls", SODA 2003).
fn enclosing_center(points: &[Vec3]) -> Vec3 {
    let mut center = points.iter().sum::<Vec3>() / points.len() as f64;
    for round in 1..=200 {
        let distance = |p: &&Vec3| (*p - center).norm_squared();
        let farthest = points.iter().max_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(farthest) = farthest {
            center += (farthest - center) / f64::from(round + 1);
        }
    }
    center
}
