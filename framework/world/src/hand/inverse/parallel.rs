//! Closed form for three revolute joints of which two neighbours are parallel: abduction and two flexions, in
//! either order.
//!
//! The pair keeps the tip's coordinate along its direction u, which gives the lone joint's angle; what
//! remains is a planar arm of two links. Both steps are the equation a cos q + b sin q = c (subproblems of
//! Paden, "Kinematics and control of robot manipulators", PhD thesis, Berkeley 1986, and Kahan), solved
//! without trigonometric functions; the axes of the lone joint and the pair may meet or not, at any angle.

use super::{Choice, JointRange, Triple};
use crate::hand::screw::{Screw, turn};
use nalgebra::Vector2;
use regrasp_api::{JointKind, Mat3, Vec3, any_orthogonal};

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

/// The chain, ready to be solved, in a frame P whose z axis is the pair's direction u and whose origin lies
/// on the lone axis.
#[derive(Clone, Debug)]
pub(in crate::hand) struct Parallel {
    lone: Lone,
    R_PH: Mat3,
    /// Origin of P in H (m).
    p_HP: Vec3,
    /// Axis of the lone joint.
    w_P: Vec3,
    /// +1 or -1: the axes of the pair's joints are u and `sign · u`.
    sign: f64,
    /// Where the pair's axes cross the plane across u, and the way from the first to the second (m).
    a: Vector2<f64>,
    b: Vector2<f64>,
    ab: Vector2<f64>,
    /// The fingertip's centre, the three joints at 0 (m).
    p0_P: Vec3,
}

impl Parallel {
    pub fn new(triple: &Triple, lone: Lone) -> Self {
        let [s1, s2, s3] = &triple.screws;
        let (alone, first, second) = match lone {
            Lone::First => (s1, s2, s3),
            Lone::Third => (s3, s1, s2),
        };
        let u = first.axis;
        let x = any_orthogonal(&u);
        let R_PH = Mat3::from_rows(&[x.transpose(), u.cross(&x).transpose(), u.transpose()]);
        let [a, b] = [first, second].map(|screw| (R_PH * (screw.point - alone.point)).xy());
        Self {
            lone,
            R_PH,
            p_HP: alone.point,
            w_P: R_PH * alone.axis,
            sign: u.dot(&second.axis).signum(),
            a,
            b,
            ab: b - a,
            p0_P: R_PH * (triple.p0 - alone.point),
        }
    }

    /// The solution within the limits closest to `near`, for the fingertip at `p_HF` (m).
    #[inline]
    pub fn solve(&self, p_HF: &Vec3, ranges: &[JointRange; 3], near: &[f64; 3]) -> Option<[f64; 3]> {
        let p = self.R_PH * (p_HF - self.p_HP);
        let mut best = Choice::new(near);
        match self.lone {
            // Rot(w, -q) p must lie as far along u as p0 does, since the pair cannot change that.
            Lone::First => self.level(&p, self.p0_P.z, -1.0, &ranges[0], near[0], |q, turned| {
                let pair = [&ranges[1], &ranges[2]];
                self.solve_pair(&self.p0_P.xy(), turned, pair, [near[1], near[2]], |a, b| {
                    best.offer([q, a, b])
                });
            }),
            // Rot(w, q) p0 must lie as far along u as p does.
            Lone::Third => self.level(&self.p0_P, p.z, 1.0, &ranges[2], near[2], |q, turned| {
                let pair = [&ranges[0], &ranges[1]];
                self.solve_pair(turned, &p.xy(), pair, [near[0], near[1]], |a, b| best.offer([a, b, q]));
            }),
        }
        best.taken()
    }

    /// The lone joint's angles q within its limits with u · Rot(w, `side` q) v = `height`; `found` is told q
    /// and the turned vector across u.
    #[inline]
    fn level(
        &self,
        v: &Vec3,
        height: f64,
        side: f64,
        range: &JointRange,
        near: f64,
        mut found: impl FnMut(f64, &Vector2<f64>),
    ) {
        let w = &self.w_P;
        let along = w.z * w.dot(v);
        let (a, b) = (v.z - along, side * (w.x * v.y - w.y * v.x));
        for (sin, cos) in circle(a, b, height - along, 1e-22, near).into_iter().flatten() {
            if range.may_hold(sin, cos)
                && let Some(q) = range.fit_angle(sin, cos, near)
            {
                found(q, &turn(w, v, side * sin, cos).xy());
            }
        }
    }

    /// All angles of the pair within the limits that take the point `y` to `z` (m), both seen along u: a
    /// planar arm.
    #[inline]
    fn solve_pair(
        &self,
        y: &Vector2<f64>,
        z: &Vector2<f64>,
        ranges: [&JointRange; 2],
        near: [f64; 2],
        mut found: impl FnMut(f64, f64),
    ) {
        let (by, az, ab) = (y - self.b, z - self.a, &self.ab);
        // |ab + Rot(β) by|² = |az|².
        let length = az.norm_squared();
        let c = 0.5 * (length - ab.norm_squared() - by.norm_squared());
        let (ca, sa) = (ab.dot(&by), ab.y * by.x - ab.x * by.y);
        for (sin, cos) in circle(ca, sa, c, 1e-28, self.sign * near[1]).into_iter().flatten() {
            if !ranges[1].may_hold(self.sign * sin, cos) {
                continue;
            }
            let reach = Vector2::new(ab.x + by.x * cos - by.y * sin, ab.y + by.x * sin + by.y * cos);
            let shoulder = if length < 1e-24 {
                // The point lies on the first axis: any angle will do.
                Some(ranges[0].clamp(near[0]))
            } else {
                ranges[0].fit_direction(reach.perp(&az), reach.dot(&az), length, near[0])
            };
            if let Some(qa) = shoulder
                && let Some(qb) = ranges[1].fit_angle(self.sign * sin, cos, near[1])
            {
                found(qa, qb);
            }
        }
    }
}

/// Sine and cosine of both solutions of a cos q + b sin q = c; `None` if there is none.
///
/// A discriminant that misses zero by a relative 1e-10 or by `slack` counts as zero. Where a = b = c = 0
/// every angle is a solution and `near` is taken.
#[inline]
fn circle(a: f64, b: f64, c: f64, slack: f64, near: f64) -> Option<[(f64, f64); 2]> {
    let square = a * a + b * b;
    if square <= slack {
        return any_angle(c * c <= slack, near);
    }
    let discriminant = square - c * c;
    if discriminant < -(1e-10 * square + slack) {
        return None;
    }
    // Where the slack is used, the nearest point of the circle stands for the missed one.
    let (root, c) =
        if discriminant > 0.0 { (discriminant.sqrt(), c) } else { (0.0, square.sqrt().copysign(c)) };
    let scale = 1.0 / square;
    let (ac, bc) = (a * c, b * c);
    Some([
        ((bc + a * root) * scale, (ac - b * root) * scale),
        ((bc - a * root) * scale, (ac + b * root) * scale),
    ])
}

/// The degenerate case: every angle is a solution, or none. Apart and cold, because inlined the compiler
/// computes the sine and cosine in every case.
#[cold]
#[inline(never)]
fn any_angle(solvable: bool, near: f64) -> Option<[(f64, f64); 2]> {
    solvable.then(|| [near.sin_cos(); 2])
}
