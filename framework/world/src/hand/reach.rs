//! A ball that holds every place a fingertip can reach.

use super::{inverse::JointRange, screw::Screw};
use regrasp_api::{JointKind, MAX_FINGER_JOINTS, Random, Vec3};
use std::{
    cmp::Ordering,
    collections::BinaryHeap,
    f64::consts::{FRAC_PI_2, PI},
};

/// Fixed random postures from which the ball's centre is found.
const POSTURES: usize = 512;
/// Most boxes of joint positions that are looked at to bound the ball's radius.
const BOXES: usize = 4000;
/// The radius may exceed the smallest one about its centre by this share.
const EXCESS: f64 = 0.005;

/// A ball that holds the tips of all postures in a box, the tip of its middle, and which joint adds most to
/// the ball's radius.
struct Swept {
    center: Vec3,
    radius: f64,
    middle: Vec3,
    widest: usize,
}

/// Sweeps the tip by the joints from the last to the second, and encloses each arc or segment in a ball.
fn sweep(screws: &[Screw], p_HF0: &Vec3, limits: &[(f64, f64)]) -> Swept {
    let mut swept = Swept { center: *p_HF0, radius: 0.0, middle: *p_HF0, widest: 0 };
    let mut largest = -1.0;
    for (index, (screw, (lower, upper))) in screws.iter().zip(limits).enumerate().skip(1).rev() {
        let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
        let [moved, tip] = screw.move_points([&swept.center, &swept.middle], middle);
        let added = match screw.kind {
            JointKind::Prismatic => {
                swept.center = moved;
                half
            }
            JointKind::Revolute => {
                let foot = screw.foot(&moved);
                let (sin, cos) = half.min(FRAC_PI_2).sin_cos();
                swept.center = foot + (moved - foot) * cos;
                (moved - foot).norm() * sin
            }
        };
        swept.middle = tip;
        swept.radius += added;
        if added > largest {
            (largest, swept.widest) = (added, index);
        }
    }
    swept
}

/// The largest distance (m) from `center` of the point `p` as the joint moves it between its limits; exact.
fn farthest(screw: &Screw, (lower, upper): (f64, f64), p: &Vec3, center: &Vec3) -> f64 {
    let distance = |q: f64| (screw.move_point(p, q) - center).norm();
    match screw.kind {
        JointKind::Prismatic => distance(lower).max(distance(upper)),
        JointKind::Revolute => {
            let middle = screw.move_point(p, 0.5 * (lower + upper));
            let (foot_p, foot_c) = (screw.foot(&middle), screw.foot(center));
            let (arm_p, arm_c) = (middle - foot_p, center - foot_c);
            let angle = screw.axis.dot(&arm_c.cross(&arm_p)).atan2(arm_c.dot(&arm_p)).abs();
            let widest = (angle + 0.5 * (upper - lower)).min(PI);
            let (a, b) = (arm_p.norm(), arm_c.norm());
            ((foot_p - foot_c).norm_squared() + a * a + b * b - 2.0 * a * b * widest.cos()).max(0.0).sqrt()
        }
    }
}

/// A box of joint positions, ordered by how far from the ball's centre its tips may lie.
struct Cell {
    limits: [(f64, f64); MAX_FINGER_JOINTS],
    /// No tip of the box lies farther from the ball's centre (m).
    bound: f64,
    /// Some tip of the box lies this far from it (m).
    reached: f64,
    widest: usize,
}

impl Cell {
    fn new(screws: &[Screw], p_HF0: &Vec3, limits: [(f64, f64); MAX_FINGER_JOINTS], center: &Vec3) -> Self {
        let swept = sweep(screws, p_HF0, &limits[..screws.len()]);
        let bound = farthest(&screws[0], limits[0], &swept.center, center) + swept.radius;
        let reached = farthest(&screws[0], limits[0], &swept.middle, center);
        Self { limits, bound, reached, widest: swept.widest }
    }

    /// The two halves of the box's limits, across the joint that adds most to the bound.
    fn halves(&self) -> [[(f64, f64); MAX_FINGER_JOINTS]; 2] {
        let (lower, upper) = self.limits[self.widest];
        let middle = 0.5 * (lower + upper);
        [(lower, middle), (middle, upper)].map(|part| {
            let mut limits = self.limits;
            limits[self.widest] = part;
            limits
        })
    }
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
/// The centre is nearly that of the smallest such ball. At least two joints.
pub(super) fn reach_ball(screws: &[Screw], p_HF0: &Vec3, ranges: &[JointRange]) -> (Vec3, f64) {
    let center = enclosing_center(&tips(screws, p_HF0, ranges));
    let radius = largest_distance(screws, p_HF0, ranges, &center);
    // Rounding of the forward kinematics.
    (center, radius * (1.0 + 1e-9) + 1e-9)
}

/// An upper bound of the tips' distances (m) from `center`.
///
/// Branch and bound over boxes of all joints but the first, whose arc is treated exactly: half a percent
/// above the largest distance, unless the count of boxes runs out first.
fn largest_distance(screws: &[Screw], p_HF0: &Vec3, ranges: &[JointRange], center: &Vec3) -> f64 {
    let whole = std::array::from_fn(|k| ranges.get(k).map_or((0.0, 0.0), |range| (range.lower, range.upper)));
    let mut worst = Cell::new(screws, p_HF0, whole, center);
    let mut reached = worst.reached;
    let mut others = BinaryHeap::new();
    for _ in 0..BOXES {
        if worst.bound <= reached * (1.0 + EXCESS) {
            break;
        }
        let [low, high] = worst.halves().map(|limits| Cell::new(screws, p_HF0, limits, center));
        reached = reached.max(low.reached).max(high.reached);
        others.push(low);
        others.push(high);
        worst = others.pop().expect("two were pushed");
    }
    worst.bound
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

/// Nearly the centre of the smallest ball about the points (Bădoiu & Clarkson, "Smaller core-sets for balls",
/// SODA 2003).
fn enclosing_center(points: &[Vec3]) -> Vec3 {
    let mut center = points.iter().sum::<Vec3>() / points.len() as f64;
    // Coordinate by coordinate, so that the compiler takes several points at a time.
    let [x, y, z] = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).collect::<Vec<_>>());
    let mut squares = vec![0.0; points.len()];
    for round in 1..=200 {
        let mut most = 0.0;
        for (((square, x), y), z) in squares.iter_mut().zip(&x).zip(&y).zip(&z) {
            let (x, y, z) = (x - center.x, y - center.y, z - center.z);
            *square = x * x + y * y + z * z;
        }
        for square in &squares {
            most = if *square > most { *square } else { most };
        }
        if let Some(farthest) = squares.iter().rposition(|square| *square == most) {
            center += (points[farthest] - center) / f64::from(round + 1);
        }
    }
    center
}
