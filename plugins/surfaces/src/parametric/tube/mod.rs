//! A cylinder about z with flat or with round caps: helices on the side, chords or great circles on the caps.
//!
//! A shortest path consists of at most one helix and one piece on each cap, or, with flat caps, of a chord
//! between two helices. Any other order can be cut and put together again, pieces turned about z or mirrored
//! at the middle, to one of these with a kink, which can be shortened. What remains is where the rims are
//! crossed: one or two angles, found by trying many and improving the best.

mod crossing;
mod least;
mod straight;

use super::curve::{Curve, Form};
use super::sphere::Sphere;
use crossing::Crossing;
use least::least;
use regrasp_api::Vec3;
use std::f64::consts::PI;

/// Points closer to a rim than this fraction of the radius lie on it.
const ON_RIM: f64 = 1e-12;

/// How the ends are closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cap {
    /// By discs: a cylinder.
    Flat,
    /// By half balls: a capsule.
    Round,
}

/// A cylinder or capsule about z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tube {
    /// Radius (m).
    pub radius: f64,
    /// Half the height of the cylindrical part (m).
    pub half_height: f64,
    /// How it is closed.
    pub cap: Cap,
}

/// A part of the surface; the caps by the sign of z.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Patch {
    Side,
    Cap(f64),
}

/// The difference of two angles, in -π..=π.
fn wrapped(angle: f64) -> f64 {
    let turned = angle.rem_euclid(2.0 * PI);
    if turned > PI { turned - 2.0 * PI } else { turned }
}

fn azimuth(p: &Vec3) -> f64 {
    p.y.atan2(p.x)
}

impl Tube {
    fn patch(&self, p: &Vec3) -> Patch {
        let beyond = p.z.abs() - self.half_height;
        let on_cap = match self.cap {
            Cap::Flat => beyond >= -ON_RIM * self.radius && p.xy().norm() < self.radius * (1.0 - ON_RIM),
            Cap::Round => beyond > ON_RIM * self.radius,
        };
        if on_cap { Patch::Cap(p.z.signum()) } else { Patch::Side }
    }

    /// The point of the side at an angle (rad) and height (m).
    fn side(&self, angle: f64, z: f64) -> Vec3 {
        Vec3::new(self.radius * angle.cos(), self.radius * angle.sin(), z)
    }

    /// The middle of a cap's rim.
    fn middle(&self, sign: f64) -> Vec3 {
        Vec3::z() * (sign * self.half_height)
    }

    /// The distance (m) over a cap from one of its points to its rim.
    fn crossing(&self, p: &Vec3, sign: f64) -> Crossing {
        let from = p - self.middle(sign);
        Crossing { cap: self.cap, radius: self.radius, out: from.xy().norm(), angle: azimuth(p) }
    }

    /// Appends the shortest way over one patch.
    fn piece(&self, patch: Patch, spacing: f64, to: &Vec3, curve: &mut Curve) {
        let from = curve.points[curve.points.len() - 1];
        match (patch, self.cap) {
            (Patch::Side, _) => {
                let (angle, z) = (azimuth(&from), from.z);
                let (turn, rise) = (wrapped(azimuth(to) - angle), to.z - z);
                let length = (self.radius * turn).hypot(rise);
                curve.arc(length, spacing, to, |t| self.side(angle + t * turn, z + t * rise));
            }
            (Patch::Cap(_), Cap::Flat) => curve.line(spacing, to),
            (Patch::Cap(sign), Cap::Round) => self.round(sign, spacing, to, curve),
        }
    }

    /// Appends the great circle's arc over a round cap.
    fn round(&self, sign: f64, spacing: f64, to: &Vec3, curve: &mut Curve) {
        let middle = self.middle(sign);
        let from = curve.points[curve.points.len() - 1];
        let mut arc = Curve::default();
        Sphere { radius: self.radius }.shortest(&(from - middle), &(to - middle), spacing, &mut arc);
        curve.points.extend(arc.points[1..arc.points.len() - 1].iter().map(|p| p + middle));
        curve.points.push(*to);
        curve.length += arc.length;
    }

    /// From one point of the side to another: a helix, or two with a chord of a flat cap in between.
    fn side_to_side(&self, a: &Vec3, b: &Vec3) -> Vec<(Patch, Vec3)> {
        let (start, turn) = (azimuth(a), wrapped(azimuth(b) - azimuth(a)));
        let mut best = ((self.radius * turn).hypot(b.z - a.z), vec![(Patch::Side, *b)]);
        // On a round cap the rim itself is a shortest path.
        let signs: &[f64] = if self.cap == Cap::Flat { &[1.0, -1.0] } else { &[] };
        for &sign in signs {
            let rise = [a, b].map(|p| self.half_height - sign * p.z);
            let height = rise[0] + rise[1];
            if height >= best.0 {
                continue;
            }
            // Mirrored at the rim, the two helices are one straight line.
            let length = |over: f64| {
                2.0 * self.radius * (over / 2.0).sin().abs() + (self.radius * (turn - over)).hypot(height)
            };
            let (over, length) = least((turn - PI, turn + PI), &[0.0, turn], length);
            if length < best.0 {
                let share = if height > 0.0 { rise[0] / height } else { 0.5 };
                let enter = start + (turn - over) * share;
                let rim = |angle: f64| self.side(angle, sign * self.half_height);
                let route =
                    vec![(Patch::Side, rim(enter)), (Patch::Cap(sign), rim(enter + over)), (Patch::Side, *b)];
                best = (length, route);
            }
        }
        best.1
    }

    /// From a point of the side to one of a cap.
    fn side_to_cap(&self, a: &Vec3, b: &Vec3, sign: f64) -> Vec3 {
        let (start, height) = (azimuth(a), self.half_height - sign * a.z);
        let over = self.crossing(b, sign);
        let length = |angle: f64| (self.radius * (angle - start)).hypot(height) + over.length(angle);
        let nearest = start + wrapped(over.angle - start);
        let (angle, _) = least((start - PI, start + PI), &[start, nearest], length);
        self.side(angle, sign * self.half_height)
    }

    /// The patches of the shortest path, each with the point in which it ends.
    fn route(&self, a: &Vec3, b: &Vec3) -> Vec<(Patch, Vec3)> {
        match (self.patch(a), self.patch(b)) {
            (Patch::Side, Patch::Side) => self.side_to_side(a, b),
            (Patch::Cap(s), Patch::Cap(t)) if s == t => vec![(Patch::Cap(s), *b)],
            (Patch::Side, Patch::Cap(s)) => {
                vec![(Patch::Side, self.side_to_cap(a, b, s)), (Patch::Cap(s), *b)]
            }
            (Patch::Cap(s), Patch::Side) => {
                vec![(Patch::Cap(s), self.side_to_cap(b, a, s)), (Patch::Side, *b)]
            }
            (Patch::Cap(s), Patch::Cap(t)) => {
                let ends = (self.crossing(a, s), self.crossing(b, t));
                let [leave, enter] = crossing::between(ends, self.radius, 2.0 * self.half_height);
                let rim = |angle: f64, sign: f64| self.side(angle, sign * self.half_height);
                vec![(Patch::Cap(s), rim(leave, s)), (Patch::Side, rim(enter, t)), (Patch::Cap(t), *b)]
            }
        }
    }
}

impl Form for Tube {
    fn outward(&self, p: &Vec3) -> Vec3 {
        let core = self.core(p);
        let out = (p - core).try_normalize(0.0).unwrap_or(Vec3::x());
        if self.cap == Cap::Round {
            return core + out * self.radius;
        }
        let (to_side, to_cap) = (self.radius - p.xy().norm(), self.half_height - p.z.abs());
        if to_cap < to_side {
            let inside = (self.radius / p.xy().norm()).min(1.0);
            return Vec3::new(p.x * inside, p.y * inside, self.half_height.copysign(p.z));
        }
        core + out * self.radius
    }

    fn core(&self, p: &Vec3) -> Vec3 {
        Vec3::z() * p.z.clamp(-self.half_height, self.half_height)
    }

    fn normal(&self, p: &Vec3) -> Vec3 {
        match (self.patch(p), self.cap) {
            (Patch::Cap(sign), Cap::Flat) => Vec3::z() * sign,
            _ => (p - self.core(p)).try_normalize(0.0).unwrap_or(Vec3::x()),
        }
    }

    fn shortest(&self, a: &Vec3, b: &Vec3, spacing: f64, curve: &mut Curve) {
        curve.restart(a);
        for (patch, to) in self.route(a, b) {
            self.piece(patch, spacing, &to, curve);
        }
    }

    fn walk(&self, from: &Vec3, along: &Vec3, distance: f64, spacing: f64, curve: &mut Curve) {
        straight::walk(self, from, along, distance, spacing, curve);
    }
}
