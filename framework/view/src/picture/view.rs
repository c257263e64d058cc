//! From the room to the paper.

use regrasp_api::Vec3;

/// A point on the paper (mm, y downwards) with its depth (mm; larger is nearer).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    pub depth: f64,
}

/// How far above the horizon the eye is.
const ELEVATION_DEG: f64 = 35.0;

/// Where a point of the hand's frame (m) is seen.
pub fn see(p_HP: &Vec3) -> Point {
    let (sin, cos) = ELEVATION_DEG.to_radians().sin_cos();
    let up = p_HP.y * sin + p_HP.z * cos;
    let near = -p_HP.y * cos + p_HP.z * sin;
    Point { x: 1e3 * p_HP.x, y: -1e3 * up, depth: 1e3 * near }
}

/// Whether a surface with this outward normal (hand's frame) is seen from its outer side.
pub fn faces_the_eye(n_H: &Vec3) -> bool {
    see(n_H).depth > 0.0
}

/// The part of the paper that something covers (mm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Left and upper end.
    pub low: [f64; 2],
    /// Right and lower end.
    pub high: [f64; 2],
}

impl Bounds {
    /// What nothing covers; the neutral element of [`Bounds::union`].
    pub const NOTHING: Self = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    /// What both cover together, as a rectangle.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            low: [self.low[0].min(other.low[0]), self.low[1].min(other.low[1])],
            high: [self.high[0].max(other.high[0]), self.high[1].max(other.high[1])],
        }
    }

    /// Width and height (mm).
    pub fn size(self) -> [f64; 2] {
        [self.high[0] - self.low[0], self.high[1] - self.low[1]]
    }

    pub(super) fn include(&mut self, point: &Point, radius: f64) {
        let around =
            Self { low: [point.x - radius, point.y - radius], high: [point.x + radius, point.y + radius] };
        *self = self.union(around);
    }
}

/// Twice the signed area of a triangle on the paper: positive where it is seen counter-clockwise (y being
/// downwards, a facet seen from outside).
pub fn area(a: &Point, b: &Point, c: &Point) -> f64 {
    (b.y - a.y) * (c.x - a.x) - (b.x - a.x) * (c.y - a.y)
}

/// The convex hull of points as they are seen (A. M. Andrew, "Another efficient algorithm for convex hulls in
/// two dimensions", IPL 1979).
pub fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut around = Vec::new();
    for _ in 0..2 {
        let mut chain: Vec<Point> = Vec::new();
        for point in &points {
            while chain.len() > 1 && area(&chain[chain.len() - 2], &chain[chain.len() - 1], point) <= 0.0 {
                chain.pop();
            }
            chain.push(*point);
        }
        chain.pop();
        around.extend(chain);
        points.reverse();
    }
    around
}
