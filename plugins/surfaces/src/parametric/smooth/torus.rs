//! The torus.

use super::{SIDES, Smooth};
use regrasp_api::Vec3;
use std::f64::consts::{PI, TAU};

/// A ring about z.
#[derive(Clone, Copy, Debug)]
pub(in crate::parametric) struct Torus {
    /// Distance of the tube's centre from z (m).
    pub ring: f64,
    /// Radius of the tube (m).
    pub tube: f64,
}

/// The unit vectors away from z, around z and around the tube, the distance from z, and the outward unit
/// normal.
struct Frame {
    around: Vec3,
    upward: Vec3,
    normal: Vec3,
    out: f64,
    /// The normal's part away from z.
    cos: f64,
}

impl Torus {
    fn frame(&self, p: &Vec3) -> Frame {
        let out = p.xy().norm();
        let radial = if out > 0.0 { Vec3::new(p.x / out, p.y / out, 0.0) } else { Vec3::x() };
        let normal = (p - radial * self.ring).try_normalize(0.0).unwrap_or(radial);
        let around = Vec3::new(-radial.y, radial.x, 0.0);
        Frame { around, upward: normal.cross(&around), normal, out, cos: normal.dot(&radial) }
    }

    /// The angles about z and about the tube (rad).
    fn angles(&self, p: &Vec3) -> [f64; 2] {
        [p.y.atan2(p.x), p.z.atan2(p.xy().norm() - self.ring)]
    }

    fn at(&self, [u, v]: [f64; 2]) -> Vec3 {
        let out = self.ring + self.tube * v.cos();
        Vec3::new(out * u.cos(), out * u.sin(), self.tube * v.sin())
    }
}

/// The difference of two angles, in -π..π.
fn turn(from: f64, to: f64) -> f64 {
    (to - from + PI).rem_euclid(TAU) - PI
}

impl Smooth for Torus {
    fn normal(&self, p: &Vec3) -> Vec3 {
        self.frame(p).normal
    }

    fn turning(&self, p: &Vec3, along: &Vec3) -> Vec3 {
        let frame = self.frame(p);
        let (around, upward) = (frame.around.dot(along), frame.upward.dot(along));
        frame.around * (around * frame.cos / frame.out) + frame.upward * (upward / self.tube)
    }

    fn curvature(&self, p: &Vec3) -> f64 {
        let frame = self.frame(p);
        frame.cos / (self.tube * frame.out)
    }

    fn pace(&self, p: &Vec3, along: &Vec3) -> f64 {
        let frame = self.frame(p);
        let (around, upward) = (frame.around.dot(along) / frame.out, frame.upward.dot(along) / self.tube);
        around.hypot(upward) + (frame.cos / (self.tube * frame.out)).abs().sqrt()
    }

    fn onto(&self, p: &Vec3) -> Vec3 {
        self.core(p) + self.frame(p).normal * self.tube
    }

    fn joins(&self, p: &Vec3, q: &Vec3) -> bool {
        let [a, b] = [p, q].map(|p| self.angles(p));
        (0..2).all(|k| turn(a[k], b[k]).abs() < PI / 2.5)
    }

    fn core(&self, p: &Vec3) -> Vec3 {
        let out = p.xy().norm();
        if out > 0.0 { Vec3::new(p.x, p.y, 0.0) * (self.ring / out) } else { Vec3::x() * self.ring }
    }

    fn size(&self) -> f64 {
        self.ring + self.tube
    }

    /// Straight in both angles to the meridian in the middle and on; the tube is passed on the side given.
    ///
    /// By mirror symmetry no shortest path turns about z by more than half a turn.
    fn via(&self, a: &Vec3, b: &Vec3, side: usize) -> impl Fn(f64) -> Vec3 {
        let ([u_a, v_a], [u_b, v_b]) = (self.angles(a), self.angles(b));
        let du = turn(u_a, u_b);
        let middle = TAU * side as f64 / SIDES as f64;
        let halves = [turn(v_a, middle), turn(middle, v_b)];
        let torus = *self;
        move |t| {
            let over = if t < 0.5 { halves[0] * 2.0 * t } else { halves[0] + halves[1] * (2.0 * t - 1.0) };
            torus.at([u_a + du * t, v_a + over])
        }
    }
}
