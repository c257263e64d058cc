//! Closed form for three revolute joints of which two neighbours are parallel: abduction and two flexions, in either order.
//!
//! The pair keeps the tip's coordinate along its direction u, which gives the lone joint's angle; what remains is a planar
//! arm of two links. Both steps are the equation a cos q + b sin q = c (subproblems of Paden, "Kinematics and control of
//! robot manipulators", PhD thesis, Berkeley 1986, and Kahan), solved without trigonometric functions; the axes of the lone
//! joint and the pair may meet or not, at any angle.

use super::{Choice, JointRange, Triple};
use crate::hand::screw::{Screw, turn};
use regrasp_api::{JointKind, Vec3};

/// Sine of the angle up to which two axes count as parallel.
const PARALLEL: f64 = 1e-9;

/// Which joint is alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::hand) enum Lone {
    /// The first; the second and the third are parallel.
    First,
    /// The third; the first and the second are parallel.
    Third,
}

impl Lone {
    /// Which of the two patterns the chain has, if any.
    pub fn find(triple: &Triple) -> Option<Self> {
        if triple.screws.iter().any(|screw| screw.kind != JointKind::Revolute) {
            return None;
        }
        let [s1, s2, s3] = &triple.screws;
        let parallel = |a: &Screw, b: &Screw| a.axis.cross(&b.axis).norm() < PARALLEL;
        if parallel(s2, s3) {
            Some(Self::First)
        } else if parallel(s1, s2) {
            Some(Self::Third)
        } else {
            None
        }
    }
}

/// The chain, ready to be solved.
#[derive(Clone, Debug)]
pub(in crate::hand) struct Parallel {
    lone: Lone,
    /// Axis of the lone joint.
    w: Vec3,
    /// A point on it (m).
    r: Vec3,
    /// Direction of the pair: the axis of its first joint.
    u: Vec3,
    /// +1 or -1: the axis of its second joint is `sign · u`.
    sign: f64,
    /// Points on the pair's axes (m).
    a: Vec3,
    b: Vec3,
    /// b - a, across u.
    ab: Vec3,
    p0: Vec3,
}

impl Parallel {
    pub fn new(triple: &Triple, lone: Lone) -> Self {
        let [s1, s2, s3] = &triple.screws;
        let (alone, first, second) = match lone {
            Lone::First => (s1, s2, s3),
            Lone::Third => (s3, s1, s2),
        };
        let u = first.axis;
        let ab = second.point - first.point;
        Self {
            lone,
            w: alone.axis,
            r: alone.point,
            u,
            sign: u.dot(&second.axis).signum(),
            a: first.point,
            b: second.point,
            ab: ab - u * u.dot(&ab),
            p0: triple.p0,
        }
    }

    /// The solution within the limits closest to `near`, for the fingertip at `p` (m).
    #[inline]
    pub fn solve(&self, p: &Vec3, ranges: &[JointRange; 3], near: &[f64; 3]) -> Option<[f64; 3]> {
        let lone = if self.lone == Lone::First { 0 } else { 2 };
        let mut best = Choice::new(near);
        let (side, v) = match self.lone {
            // u · (r + Rot(w, -q)(p - r)) = u · p0, with the sine's sign turned.
            Lone::First => (-1.0, p - self.r),
            // u · (r + Rot(w, q)(p0 - r)) = u · p.
            Lone::Third => (1.0, self.p0 - self.r),
        };
        let (uw, wv) = (self.u.dot(&self.w), self.w.dot(&v));
        let goal = if self.lone == Lone::First { &self.p0 } else { p };
        let c = self.u.dot(&(goal - self.r)) - uw * wv;
        let (ca, sa) = (self.u.dot(&v) - uw * wv, side * self.u.dot(&self.w.cross(&v)));
        for (sin, cos) in circle(ca, sa, c, 1e-22, near[lone])? {
            if !ranges[lone].may_hold(sin, cos) {
                continue;
            }
            let Some(q) = ranges[lone].fit_angle(sin, cos, near[lone]) else { continue };
            let turned = self.r + turn(&self.w, &v, side * sin, cos);
            match self.lone {
                Lone::First => {
                    self.solve_pair(&self.p0, &turned, ranges, near, |qa, qb| best.offer([q, qa, qb]))
                }
                Lone::Third => self.solve_pair(&turned, p, ranges, near, |qa, qb| best.offer([qa, qb, q])),
            }
        }
        best.taken()
    }

    /// All angles of the pair within the limits that take the point `y` to `z` (m), which lie equally far along u.
    #[inline]
    fn solve_pair(
        &self,
        y: &Vec3,
        z: &Vec3,
        ranges: &[JointRange; 3],
        near: &[f64; 3],
        mut found: impl FnMut(f64, f64),
    ) {
        let (ia, ib) = if self.lone == Lone::First { (1, 2) } else { (0, 1) };
        let across = |v: Vec3| v - self.u * self.u.dot(&v);
        let (by, az) = (across(y - self.b), across(z - self.a));
        let by_turned = self.u.cross(&by);
        // |ab + Rot(β) by|² = |az|².
        let c = 0.5 * (az.norm_squared() - self.ab.norm_squared() - by.norm_squared());
        let (ca, sa) = (self.ab.dot(&by), self.ab.dot(&by_turned));
        let Some(elbows) = circle(ca, sa, c, 1e-28, self.sign * near[ib]) else { return };
        for (sin_b, cos_b) in elbows {
            if !ranges[ib].may_hold(self.sign * sin_b, cos_b) {
                continue;
            }
            let reach = self.ab + by * cos_b + by_turned * sin_b;
            let (sin_a, cos_a, length) = (self.u.dot(&reach.cross(&az)), reach.dot(&az), az.norm_squared());
            let shoulder = if length < 1e-24 {
                // The point lies on the first axis: any angle will do.
                Some(ranges[ia].clamp(near[ia]))
            } else if ranges[ia].may_hold(sin_a / length, cos_a / length) {
                ranges[ia].fit_angle(sin_a, cos_a, near[ia])
            } else {
                None
            };
            let elbow = shoulder.and_then(|_| ranges[ib].fit_angle(self.sign * sin_b, cos_b, near[ib]));
            if let (Some(qa), Some(qb)) = (shoulder, elbow) {
                found(qa, qb);
            }
        }
    }
}

/// Sine and cosine of both solutions of a cos q + b sin q = c; `None` if there is none.
///
/// A discriminant that misses zero by a relative 1e-10 or by `slack` counts as zero. Where a = b = c = 0 every angle is a solution and
/// `near` is taken.
#[inline]
fn circle(a: f64, b: f64, c: f64, slack: f64, near: f64) -> Option<[(f64, f64); 2]> {
    let square = a * a + b * b;
    if square <= slack {
        return (c * c <= slack).then(|| [near.sin_cos(); 2]);
    }
    let discriminant = square - c * c;
    if discriminant < -(1e-10 * square + slack) {
        return None;
    }
    let root = discriminant.max(0.0).sqrt();
    // Where the slack was used, the nearest point of the circle stands for the missed one.
    let c = c.clamp(-square.sqrt(), square.sqrt());
    let scale = 1.0 / square;
    let (ac, bc) = (a * c, b * c);
    Some([
        ((bc + a * root) * scale, (ac - b * root) * scale),
        ((bc - a * root) * scale, (ac + b * root) * scale),
    ])
}
