//! The geodesic equation x'' = -κ n, and the spread of neighbouring geodesics.

use super::Smooth;
use crate::parametric::curve::Curve;
use regrasp_api::Vec3;

/// A step's length times the surface's pace: fourth order leaves 2e-7 of the length on flat ellipsoids, else
/// far less.
const STEP: f64 = 0.02;

/// A point of a geodesic and the unit tangent there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heading {
    pub p: Vec3,
    pub along: Vec3,
}

/// The Jacobi field at right angles to a geodesic: how far (m) its points move for each radian that it is
/// turned at its start.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    pub width: f64,
    slope: f64,
}

impl Default for Spread {
    fn default() -> Self {
        Self { width: 0.0, slope: 1.0 }
    }
}

impl Heading {
    /// Begins at a point, along the tangential part of a direction.
    pub fn new(surface: &impl Smooth, p: &Vec3, direction: &Vec3) -> Self {
        let n = surface.normal(p);
        let flat = direction - n * n.dot(direction);
        let along = flat.try_normalize(0.0).unwrap_or_else(|| regrasp_api::any_orthogonal(&n));
        Self { p: *p, along }
    }

    /// The change of the tangent (1/m).
    fn bend(&self, surface: &impl Smooth) -> Vec3 {
        surface.normal(&self.p) * -surface.turning(&self.p, &self.along).dot(&self.along)
    }

    fn ahead(&self, step: f64, p: &Vec3, along: &Vec3) -> Self {
        Self { p: self.p + p * step, along: self.along + along * step }
    }
}

/// Goes one step of the classical Runge-Kutta method, then back onto the surface.
fn step(surface: &impl Smooth, at: &mut Heading, spread: Option<&mut Spread>, h: f64) {
    let k1 = (at.along, at.bend(surface));
    let second = at.ahead(h / 2.0, &k1.0, &k1.1);
    let k2 = (second.along, second.bend(surface));
    let third = at.ahead(h / 2.0, &k2.0, &k2.1);
    let k3 = (third.along, third.bend(surface));
    let fourth = at.ahead(h, &k3.0, &k3.1);
    let k4 = (fourth.along, fourth.bend(surface));
    if let Some(spread) = spread {
        let stages = [at.p, second.p, third.p, fourth.p].map(|p| surface.curvature(&p));
        spread.step(&stages, h);
    }
    let p = surface.onto(&(at.p + (k1.0 + (k2.0 + k3.0) * 2.0 + k4.0) * (h / 6.0)));
    let along = at.along + (k1.1 + (k2.1 + k3.1) * 2.0 + k4.1) * (h / 6.0);
    *at = Heading::new(surface, &p, &along);
}

impl Spread {
    /// The same step for j'' = -K j.
    fn step(&mut self, curvature: &[f64; 4], h: f64) {
        let (j, s) = (self.width, self.slope);
        let k1 = (s, -curvature[0] * j);
        let k2 = (s + h / 2.0 * k1.1, -curvature[1] * (j + h / 2.0 * k1.0));
        let k3 = (s + h / 2.0 * k2.1, -curvature[2] * (j + h / 2.0 * k2.0));
        let k4 = (s + h * k3.1, -curvature[3] * (j + h * k3.0));
        self.width += h / 6.0 * (k1.0 + 2.0 * (k2.0 + k3.0) + k4.0);
        self.slope += h / 6.0 * (k1.1 + 2.0 * (k2.1 + k3.1) + k4.1);
    }
}

/// Follows a geodesic for a length (m), in steps as short as the surface's pace asks for, times `stretch`.
pub(super) fn run(
    surface: &impl Smooth,
    at: &mut Heading,
    mut spread: Option<&mut Spread>,
    length: f64,
    stretch: f64,
) {
    let mut left = length;
    while left > 0.0 {
        let h = stretch * STEP / surface.pace(&at.p, &at.along);
        // No tiny last step.
        let h = if left < 1.5 * h { left } else { h };
        step(surface, at, spread.as_deref_mut(), h);
        left -= h;
    }
}

/// Appends a geodesic, its points at most `spacing` (m) apart.
pub(super) fn draw(
    surface: &impl Smooth,
    from: &Vec3,
    along: &Vec3,
    length: f64,
    spacing: f64,
    curve: &mut Curve,
) {
    let mut at = Heading::new(surface, from, along);
    let count = (length / spacing).ceil().max(1.0);
    for _ in 0..count as usize {
        run(surface, &mut at, None, length / count, 1.0);
        curve.points.push(at.p);
    }
    curve.length += length;
}
