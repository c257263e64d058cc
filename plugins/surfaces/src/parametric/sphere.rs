//! A ball: great circles.

use super::curve::{Curve, Form};
use regrasp_api::{Vec3, any_orthogonal};

/// A ball about the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sphere {
    /// Radius (m).
    pub radius: f64,
}

impl Sphere {
    /// Appends the great circle's arc from one direction through another at right angles.
    fn arc(
        &self,
        from: &Vec3,
        across: &Vec3,
        angle: f64,
        end: Option<&Vec3>,
        spacing: f64,
        curve: &mut Curve,
    ) {
        let at = |t: f64| (from * (t * angle).cos() + across * (t * angle).sin()) * self.radius;
        let last = end.copied().unwrap_or_else(|| at(1.0));
        curve.arc(self.radius * angle, spacing, &last, at);
    }
}

impl Form for Sphere {
    fn outward(&self, p: &Vec3) -> Vec3 {
        self.normal(p) * self.radius
    }

    fn core(&self, _: &Vec3) -> Vec3 {
        Vec3::zeros()
    }

    fn normal(&self, p: &Vec3) -> Vec3 {
        p.try_normalize(0.0).unwrap_or(Vec3::z())
    }

    fn shortest(&self, a: &Vec3, b: &Vec3, spacing: f64, curve: &mut Curve) {
        curve.restart(a);
        let (from, to) = (self.normal(a), self.normal(b));
        let normal = from.cross(&to);
        let angle = normal.norm().atan2(from.dot(&to));
        // Opposite points are joined by any half circle.
        let across =
            (to - from * from.dot(&to)).try_normalize(1e-15).unwrap_or_else(|| any_orthogonal(&from));
        // At right angles to rounding also where the points are nearly the same or opposite.
        let across = (across - from * from.dot(&across)).normalize();
        self.arc(&from, &across, angle, Some(b), spacing, curve);
    }

    fn walk(&self, from: &Vec3, along: &Vec3, distance: f64, spacing: f64, curve: &mut Curve) {
        let n = self.normal(from);
        let Some(across) = (along - n * n.dot(along)).try_normalize(0.0) else { return };
        self.arc(&n, &across, distance / self.radius, None, spacing, curve);
    }
}
