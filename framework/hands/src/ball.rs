//! The ball that fits the end of a fingertip's shape.

use crate::solids::Piece;
use nalgebra::{DMatrix, DVector};
use regrasp_api::{Vec3, any_orthogonal};
use std::f64::consts::TAU;

/// The directions that are looked at lie within this angle (rad) of the finger's: there a fingertip touches.
pub(crate) const CAP: f64 = 60.0 * std::f64::consts::PI / 180.0;
/// Rings of directions about the finger's, and directions in each.
const RINGS: usize = 6;
const TURNS: usize = 16;
/// A ball from which the shape departs by more than this share of its radius, and more than this length (m),
/// is none.
const ROUGH: (f64, f64) = (0.35, 2e-3);
/// Radii of fingertips (m).
const RADII: (f64, f64) = (2e-3, 0.03);

/// A ball in the frame of the shapes that it was fitted to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    /// (m).
    pub center: Vec3,
    /// (m).
    pub radius: f64,
    /// By how much (m) the shapes depart from it at most, over the directions of the cap.
    pub error: f64,
}

impl Ball {
    /// Whether the shapes are about this ball, and it is about as large as a fingertip.
    pub fn is_fit(&self) -> bool {
        let Self { radius, error, .. } = *self;
        (RADII.0..=RADII.1).contains(&radius) && error <= ROUGH.1.max(ROUGH.0 * radius)
    }
}

/// The ball whose support function is nearest to that of the shapes over the directions about `outward`
/// (least squares: it is linear in centre and radius); with the radius (m) given, its centre alone is sought.
pub(crate) fn fit(pieces: &[Piece], outward: &Vec3, radius: Option<f64>) -> Option<Ball> {
    if pieces.is_empty() {
        return None;
    }
    let directions = directions(outward);
    let heights: Vec<f64> = directions.iter().map(|n| height(pieces, n)).collect();
    let unknown = if radius.is_some() { 3 } else { 4 };
    let A = DMatrix::from_fn(directions.len(), unknown, |row, column| match column {
        3 => 1.0,
        axis => directions[row][axis],
    });
    let b = DVector::from_iterator(heights.len(), heights.iter().map(|h| h - radius.unwrap_or(0.0)));
    let x = A.svd(true, true).solve(&b, 1e-12).ok()?;
    let (center, radius) = (Vec3::new(x[0], x[1], x[2]), radius.unwrap_or_else(|| x[3]));
    let off = |(n, h): (&Vec3, &f64)| (h - n.dot(&center) - radius).abs();
    let error = directions.iter().zip(&heights).map(off).fold(0.0, f64::max);
    Some(Ball { center, radius, error })
}

fn height(pieces: &[Piece], n: &Vec3) -> f64 {
    pieces.iter().map(|piece| piece.reach(n)).fold(f64::NEG_INFINITY, f64::max)
}

fn directions(outward: &Vec3) -> Vec<Vec3> {
    let across = any_orthogonal(outward);
    let other = outward.cross(&across);
    let rings = (1..=RINGS).flat_map(|ring| {
        let (s, c) = (CAP * ring as f64 / RINGS as f64).sin_cos();
        (0..TURNS).map(move |turn| {
            let (sin, cos) = (turn as f64 * TAU / TURNS as f64).sin_cos();
            outward * c + (across * cos + other * sin) * s
        })
    });
    [*outward].into_iter().chain(rings).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_capsule_is_its_ball_and_that_of_a_box_is_none() {
        let from = Vec3::new(0.001, 0.002, 0.0);
        let rod = [Piece::capsule([from, from + Vec3::z() * 0.04], 0.007)];
        let ball = fit(&rod, &Vec3::z(), None).unwrap();
        assert!((ball.radius - 0.007).abs() < 1e-9 && ball.error < 1e-9, "{ball:?}");
        assert!((ball.center - from - Vec3::z() * 0.04).norm() < 1e-9, "{ball:?}");
        let smaller = fit(&rod, &Vec3::z(), Some(0.006)).unwrap();
        assert!(smaller.error < 0.001 && (smaller.center.z - 0.041).abs() < 5e-4, "{smaller:?}");
        let plank = [Piece::cuboid(Vec3::new(0.03, 0.004, 0.03), regrasp_api::Pose::identity())];
        assert!(!fit(&plank, &Vec3::z(), None).unwrap().is_fit());
    }
}
