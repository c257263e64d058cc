//! The limits of one joint, as inverse kinematics asks for them.

use std::f64::consts::{PI, TAU};

/// How far beyond a limit (rad; m) rounding may put a solution that is then moved onto the limit.
const SLACK: f64 = 1e-10;

/// The limits of one joint, with the means to refuse an angle by its sine and cosine alone.
#[derive(Clone, Copy, Debug)]
pub(in crate::hand) struct JointRange {
    pub lower: f64,
    pub upper: f64,
    mid_sin: f64,
    mid_cos: f64,
    /// Cosine of half the range's width; below -1 where the range holds a whole turn.
    half_cos: f64,
}

impl JointRange {
    pub fn new(lower: f64, upper: f64) -> Self {
        let (mid_sin, mid_cos) = (0.5 * (lower + upper)).sin_cos();
        let half = 0.5 * (upper - lower);
        let half_cos = if half < PI { half.cos() - 1e-9 } else { -2.0 };
        Self { lower, upper, mid_sin, mid_cos, half_cos }
    }

    /// The position a fraction `s` in [0, 1] of the way through the range.
    pub fn at(&self, s: f64) -> f64 {
        self.lower + (self.upper - self.lower) * s
    }

    pub fn clamp(&self, q: f64) -> f64 {
        q.clamp(self.lower, self.upper)
    }

    /// Whether some position with this sine and cosine may lie within the limits; never wrongly "no".
    #[inline]
    pub fn may_hold(&self, sin: f64, cos: f64) -> bool {
        cos * self.mid_cos + sin * self.mid_sin >= self.half_cos
    }

    /// As `fit_angle`, for a sine and cosine multiplied by `scale` > 0.
    #[inline]
    pub fn fit_direction(&self, sin: f64, cos: f64, scale: f64, near: f64) -> Option<f64> {
        let may_hold = cos * self.mid_cos + sin * self.mid_sin >= self.half_cos * scale;
        if may_hold { self.fit_angle(sin, cos, near) } else { None }
    }

    /// The position (m) itself, if it lies within the limits.
    #[inline]
    pub fn fit(&self, q: f64) -> Option<f64> {
        let within = q >= self.lower - SLACK && q <= self.upper + SLACK;
        within.then(|| self.clamp(q))
    }

    /// The position within the limits that has this sine and cosine (up to a common positive factor) and lies
    /// closest to `near` (rad).
    #[inline]
    pub fn fit_angle(&self, sin: f64, cos: f64, near: f64) -> Option<f64> {
        let angle = sin.atan2(cos);
        if self.upper - self.lower < TAU {
            // At most one turn of it fits.
            return [angle, angle - TAU, angle + TAU, angle - 2.0 * TAU, angle + 2.0 * TAU]
                .into_iter()
                .find_map(|q| self.fit(q));
        }
        let first = angle + ((self.lower - SLACK - angle) / TAU).ceil() * TAU;
        let last = angle + ((self.upper + SLACK - angle) / TAU).floor() * TAU;
        let wanted = angle + ((near - angle) / TAU).round() * TAU;
        self.fit(wanted.clamp(first, last))
    }
}
