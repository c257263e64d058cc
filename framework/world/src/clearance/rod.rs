//! Rods: segments with a thickness, the shape of nearly every link, and the bound of every other.

use crate::hand::LinkFrame;
use regrasp_api::Vec3;

/// All points within `radius` of the segment from `a` to `b` (m); a ball where `a = b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rod {
    pub a: Vec3,
    pub b: Vec3,
    pub radius: f64,
    /// Radius of the ball about the rod's middle that holds it (m).
    pub reach: f64,
}

impl Rod {
    pub fn new(a: Vec3, b: Vec3, radius: f64) -> Self {
        // A little more than half the length, so that rounding in a moved frame cannot shorten the reach.
        Self { a, b, radius, reach: (0.5 + 1e-12) * (b - a).norm() + radius }
    }

    pub fn ball(center: Vec3, radius: f64) -> Self {
        Self { a: center, b: center, radius, reach: radius }
    }

    /// The rod, given in the frame's L, in H.
    #[inline]
    pub fn moved(&self, X_HL: &LinkFrame) -> Self {
        let a = X_HL.point(&self.a);
        let b = if self.a == self.b { a } else { X_HL.point(&self.b) };
        Self { a, b, ..*self }
    }

    /// The rod, given in H, in the frame's L.
    #[inline]
    pub fn seen_from(&self, X_HL: &LinkFrame) -> Self {
        let a = X_HL.R_HL.tr_mul(&(self.a - X_HL.p_HL));
        let b = if self.a == self.b { a } else { X_HL.R_HL.tr_mul(&(self.b - X_HL.p_HL)) };
        Self { a, b, ..*self }
    }

    #[inline]
    pub fn middle(&self) -> Vec3 {
        (self.a + self.b) * 0.5
    }

    /// Lowest and highest coordinates.
    #[inline]
    pub fn bounds(&self) -> Bounds {
        let r = Vec3::repeat(self.radius);
        Bounds { lower: self.a.inf(&self.b) - r, upper: self.a.sup(&self.b) + r }
    }

    /// Whether two rods are farther apart than `clear` (m).
    #[inline]
    pub fn clear_of(&self, other: &Self, clear: f64) -> bool {
        let apart = self.reach + other.reach + clear;
        if (self.middle() - other.middle()).norm_squared() > apart * apart {
            return true;
        }
        let apart = self.radius + other.radius + clear;
        segments_distance_squared(&self.a, &self.b, &other.a, &other.b) > apart * apart
    }
}

/// A box along the axes of its frame (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub lower: Vec3,
    pub upper: Vec3,
}

impl Bounds {
    pub const EVERYTHING: Self = Self {
        lower: Vec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
        upper: Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
    };
    pub const NOTHING: Self = Self { lower: Self::EVERYTHING.upper, upper: Self::EVERYTHING.lower };

    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        points
            .into_iter()
            .fold(Self::NOTHING, |all, p| Self { lower: all.lower.inf(&p), upper: all.upper.sup(&p) })
    }

    #[inline]
    pub fn union(&self, other: &Self) -> Self {
        Self { lower: self.lower.inf(&other.lower), upper: self.upper.sup(&other.upper) }
    }

    /// Whether the boxes are farther apart than `clear` (m) along some axis: then so is what they hold.
    #[inline]
    pub fn clear_of(&self, other: &Self, clear: f64) -> bool {
        let gap = (self.lower - other.upper).sup(&(other.lower - self.upper));
        gap.x > clear || gap.y > clear || gap.z > clear
    }

    /// Distance of a point from the box (m); 0 inside.
    #[inline]
    pub fn distance(&self, p: &Vec3) -> f64 {
        (self.lower - p).sup(&(p - self.upper)).sup(&Vec3::zeros()).norm()
    }

    pub fn center(&self) -> Vec3 {
        (self.lower + self.upper) * 0.5
    }

    pub fn half_size(&self) -> Vec3 {
        (self.upper - self.lower) * 0.5
    }
}

/// The squared distance of two segments (m²), either of which may be a point.
///
/// C. Ericson, Real-Time Collision Detection (2005), section 5.1.9.
#[inline]
pub(crate) fn segments_distance_squared(a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3) -> f64 {
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, vv, uv, uw, vw) = (u.norm_squared(), v.norm_squared(), u.dot(&v), u.dot(&w), v.dot(&w));
    // Parallel segments have many closest pairs: any s will do, the clamping of t and then of s finds one.
    let det = uu * vv - uv * uv;
    let mut s = if det > 1e-12 * uu * vv { ((uv * vw - uw * vv) / det).clamp(0.0, 1.0) } else { 0.0 };
    let mut t = if vv > 0.0 { (uv * s + vw) / vv } else { 0.0 };
    if !(0.0..=1.0).contains(&t) || vv == 0.0 || det <= 1e-12 * uu * vv {
        t = t.clamp(0.0, 1.0);
        s = if uu > 0.0 { ((uv * t - uw) / uu).clamp(0.0, 1.0) } else { 0.0 };
    }
    (w + u * s - v * t).norm_squared()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Vec3> {
        // Coarse numbers, so that parallel, touching and degenerate segments come up.
        prop::array::uniform3(-3..=3_i32).prop_map(|p| Vec3::from(p.map(f64::from)))
    }

    /// The least distance over a fine grid of both segments, refined about its best cell.
    fn searched(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> f64 {
        let (mut s, mut t, mut span, mut best) = (0.5, 0.5, 0.5, f64::MAX);
        for _ in 0..60 {
            let (s0, t0) = (s, t);
            for (i, j) in (-4..=4).flat_map(|i| (-4..=4).map(move |j| (i, j))) {
                let (x, y) = (s0 + span * i as f64 / 4.0, t0 + span * j as f64 / 4.0);
                let (x, y): (f64, f64) = (x.clamp(0.0, 1.0), y.clamp(0.0, 1.0));
                let distance = (a.lerp(&b, x) - c.lerp(&d, y)).norm();
                if distance < best {
                    (best, s, t) = (distance, x, y);
                }
            }
            span *= 0.7;
        }
        best
    }

    proptest! {
        #[test]
        fn segments_are_as_far_apart_as_a_search_finds(a in point(), b in point(), c in point(), d in point()) {
            let distance = segments_distance_squared(&a, &b, &c, &d).sqrt();
            prop_assert!((distance - searched(a, b, c, d)).abs() < 1e-5);
        }
    }
}
