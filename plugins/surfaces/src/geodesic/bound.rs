//! Lower bounds of the way that is left to the target.
//!
//! A path on the surface stays outside of every ball inside the solid, so it is at least as long as the
//! shortest way around such a ball: straight to the ball, along a great circle, straight to the target. On
//! round objects this is almost exact, where the straight distance alone would let the search spread over
//! half of the surface.

use crate::closest::ClosestPoints;
use crate::polyhedron::{HalfEdge, Planar, Polyhedron, planar_norm};
use regrasp_api::Vec3;
use std::f64::consts::FRAC_PI_2;

/// How many facets are asked for the largest ball below them.
const TRIES: usize = 48;
/// Meshes with fewer facets are searched faster without balls.
const FEWEST_FACETS: usize = 100;
/// Balls are of use only where they lengthen the way by this factor.
const USEFUL: f64 = 1.02;
/// A ball that reaches a facet to this part of its radius, along the normal, is the one below it.
const TOUCHES: f64 = 0.005;
/// Angle (rad) of great circle beyond which a ball's bound is not used: paths from the far side meet there.
const FARTHEST: f64 = 3.0;

/// The most (rad) by which [`angle_below`] is too small.
const ANGLE_ERROR: f64 = 5e-5;

/// The angle in [0, π) of a point with y > 0 about the origin, rounded down (rad): a tenth of the cost of
/// `atan2`.
///
/// Twice the arc tangent of y / (1 + x), by the polynomial of Abramowitz & Stegun, "Handbook of Mathematical
/// Functions", 1964, 4.4.47, whose error is at most 1e-5.
fn angle_below(y: f64, x: f64) -> f64 {
    let whole = 1.0 + x;
    let (t, beyond) = if y <= whole { (y / whole, false) } else { (whole / y, true) };
    let s = t * t;
    let terms = 0.999_866_0 + s * (-0.330_299_5 + s * (0.180_141_0 + s * (-0.085_133_0 + s * 0.020_835_1)));
    let half = if beyond { FRAC_PI_2 - t * terms } else { t * terms };
    (2.0 * half - ANGLE_ERROR / 2.0).max(0.0)
}

/// A ball inside the solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    p_OB: Vec3,
    radius: f64,
}

impl Ball {
    /// Whether the ball touches the middle of a facet, as nearly as makes no difference.
    fn is_below(&self, polyhedron: &Polyhedron, facet: u32) -> bool {
        let middle = polyhedron.mesh.corners(facet).iter().sum::<Vec3>() / 3.0;
        let nearest = self.p_OB + polyhedron.mesh.normal(facet) * self.radius;
        (middle - nearest).norm() < TOUCHES * self.radius
    }
}

/// Large balls inside the solid, each touching the surface at least once.
pub(super) fn inscribed_balls(polyhedron: &Polyhedron, closest: &ClosestPoints) -> Vec<Ball> {
    let count = polyhedron.mesh.facets().len();
    let mut balls: Vec<Ball> = Vec::new();
    if count < FEWEST_FACETS {
        return balls;
    }
    for facet in (0..TRIES).map(|index| (index * count / TRIES) as u32) {
        if balls.iter().any(|ball| ball.is_below(polyhedron, facet)) {
            continue;
        }
        let ball = ball_below(polyhedron, closest, facet);
        let is_known = |other: &Ball| {
            (other.p_OB - ball.p_OB).norm() < 0.05 * ball.radius && other.radius > 0.98 * ball.radius
        };
        if ball.radius > 0.0 && !balls.iter().any(is_known) {
            balls.push(ball);
        }
    }
    balls
}

/// The largest ball that touches a facet's middle from inside (shrinking ball: Ma, Bae & Choi, "3D medial
/// axis point approximation using nearest neighbors and the normal field", The Visual Computer 2012).
fn ball_below(polyhedron: &Polyhedron, closest: &ClosestPoints, facet: u32) -> Ball {
    let n = polyhedron.mesh.normal(facet);
    let p = polyhedron.mesh.corners(facet).iter().sum::<Vec3>() / 3.0;
    let mut radius = polyhedron.mesh.radius();
    for _ in 0..30 {
        let center = p - n * radius;
        let touch = closest.project(polyhedron, &center, None);
        if touch.distance <= -radius * (1.0 - 1e-3) {
            break;
        }
        // The ball through p with normal n that touches the closest point too.
        let to = p - touch.contact.p_OC;
        let smaller = to.norm_squared() / (2.0 * n.dot(&to)).max(1e-12);
        radius = smaller.min(0.95 * radius);
    }
    let p_OB = p - n * radius;
    Ball { p_OB, radius: -closest.project(polyhedron, &p_OB, None).distance * (1.0 - 1e-9) }
}

/// Ways around one ball to the target.
#[derive(Clone, Copy, Debug)]
struct Detour {
    ball: Ball,
    /// Unit vector from the ball's centre to the target.
    u_BT: Vec3,
    /// Straight part next to the target (m), and cosine and sine of the angle that it spans at the centre.
    tangent: f64,
    spanned: [f64; 2],
}

/// What a detour says about one point.
struct Way {
    /// Length (m) of the way to the target.
    length: f64,
    /// Unit vector in which the way sets out.
    out_O: Vec3,
    /// Angle (rad) of great circle.
    arc: f64,
}

impl Detour {
    fn new(ball: Ball, p_OT: &Vec3) -> Self {
        let to = p_OT - ball.p_OB;
        let distance = to.norm().max(ball.radius);
        let tangent = (distance * distance - ball.radius * ball.radius).sqrt();
        Self { ball, u_BT: to / to.norm(), tangent, spanned: [ball.radius / distance, tangent / distance] }
    }

    /// The way around the ball; `None` where the straight way misses the ball, or the ball's far side is
    /// reached.
    fn way(&self, p_OP: &Vec3) -> Option<Way> {
        let from = p_OP - self.ball.p_OB;
        let radius = self.ball.radius;
        let squared = from.norm_squared();
        let distance = squared.sqrt();
        let tangent = (squared - radius * radius).max(0.0).sqrt();
        // Angles at the centre: θ from the point to the target, γ spanned by the two straight parts.
        let cos = (from.dot(&self.u_BT) / distance).clamp(-1.0, 1.0);
        let sin = (1.0 - cos * cos).sqrt();
        let ([ca, sa], [cb, sb]) = ([(radius / distance).min(1.0), tangent / distance], self.spanned);
        let (cos_sum, sin_sum) = (ca * cb - sa * sb, sa * cb + ca * sb);
        let (sin_arc, cos_arc) = (sin * cos_sum - cos * sin_sum, cos * cos_sum + sin * sin_sum);
        if sin_arc <= 0.0 {
            return None;
        }
        let arc = angle_below(sin_arc, cos_arc);
        if arc >= FARTHEST {
            return None;
        }
        let up = from / distance;
        let out_O = (self.u_BT - up * cos) * (ca / sin) - up * sa;
        Some(Way { length: tangent + self.tangent + radius * arc, out_O, arc })
    }
}

/// Lower bounds (m) of surface paths to one target.
#[derive(Clone, Copy, Debug)]
pub(super) struct LowerBound {
    p_OT: Vec3,
    detour: Option<Detour>,
}

impl LowerBound {
    /// Takes the ball that lengthens the way between the two points most, if any does.
    pub fn new(balls: &[Ball], p_OS: &Vec3, p_OT: &Vec3) -> Self {
        let mut best = ((p_OS - p_OT).norm() * USEFUL, None);
        for &ball in balls {
            let detour = Detour::new(ball, p_OT);
            match detour.way(p_OS) {
                Some(way) if way.length > best.0 => best = (way.length, Some(detour)),
                _ => {}
            }
        }
        Self { p_OT: *p_OT, detour: best.1 }
    }

    /// Of paths that leave a point.
    pub fn of_point(&self, p_OP: &Vec3) -> f64 {
        let straight = (p_OP - self.p_OT).norm();
        self.detour.and_then(|detour| detour.way(p_OP)).map_or(straight, |way| way.length.max(straight))
    }

    /// Of paths of length `so_far` (m) to an unfolded source, from there straight through the part of an edge
    /// between `ends`, and on to the target; `guess` (m along the edge) is a point of that part.
    ///
    /// The sum of the ways from the source and to the target is convex along the edge, so its tangent at one
    /// point bounds it: across the way the fronts of both bend by 1/d and, behind an arc φ of radius ρ, by at
    /// least cot(φ)/ρ.
    pub fn through(&self, frame: &HalfEdge, source: &Planar, ends: [f64; 2], so_far: f64, guess: f64) -> f64 {
        let Some(detour) = &self.detour else { return 0.0 };
        let Some(way) = detour.way(&frame.at(guess)) else { return 0.0 };
        let here = planar_norm(guess - source[0], source[1]);
        let slope = (guess - source[0]) / here - frame.along_O.dot(&way.out_O);
        let descent = if slope > 0.0 { slope * (guess - ends[0]) } else { -slope * (ends[1] - guess) };
        let width = ends[1] - ends[0];
        // Behind more than a quarter turn the front closes again: bounded over the width, where 1/d does not
        // outweigh it.
        let arc = way.arc + ANGLE_ERROR + width / detour.ball.radius;
        let closing = if arc > 1.5 {
            let bend = -1.0 / (arc.min(3.1).tan() * detour.ball.radius);
            (bend - 1.0 / (here + width)).max(0.0) * width * width / 2.0
        } else {
            0.0
        };
        so_far + here + way.length - descent - closing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_rounded_down_by_little() {
        for k in 1..=30_000 {
            let angle = 1e-4 * f64::from(k);
            let below = angle_below(angle.sin(), angle.cos());
            assert!(below <= angle && below >= angle - ANGLE_ERROR, "{below} {angle}");
        }
    }
}
