//! Sums of squared distances from planes (Garland and Heckbert, "Surface simplification using quadric error
//! metrics", SIGGRAPH 1997).

use regrasp_api::{Mat3, Vec3};

/// Σ w (n · x - d)², with the sum of the weights.
#[derive(Clone, Copy)]
pub(super) struct Quadric {
    A: Mat3,
    b: Vec3,
    c: f64,
    weight: f64,
}

impl Quadric {
    pub fn zero() -> Self {
        Self { A: Mat3::zeros(), b: Vec3::zeros(), c: 0.0, weight: 0.0 }
    }

    /// Of the plane through `p` with the unit normal `n`.
    pub fn plane(n: &Vec3, p: &Vec3, weight: f64) -> Self {
        let d = n.dot(p);
        Self { A: n * n.transpose() * weight, b: n * (-d * weight), c: d * d * weight, weight }
    }

    pub fn plus(&self, other: &Self) -> Self {
        Self {
            A: self.A + other.A,
            b: self.b + other.b,
            c: self.c + other.c,
            weight: self.weight + other.weight,
        }
    }

    /// The mean squared distance (m²) of a point from the planes.
    pub fn error(&self, x: &Vec3) -> f64 {
        let sum = x.dot(&(self.A * x)) + 2.0 * self.b.dot(x) + self.c;
        (sum / self.weight.max(f64::MIN_POSITIVE)).max(0.0)
    }

    /// The point of least error near `middle`; where the planes leave a direction open, `middle` decides it.
    pub fn best(&self, middle: &Vec3) -> Vec3 {
        let A = self.A / self.weight + Mat3::identity() * 1e-3;
        let b = -self.b / self.weight + middle * 1e-3;
        A.try_inverse().map_or(*middle, |inverse| inverse * b)
    }
}
