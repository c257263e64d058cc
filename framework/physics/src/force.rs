//! What a contact exerts, and which of it friction allows.

use crate::PhysicsError;
use crate::settings::check;
use regrasp_api::Vec3;

/// Friction of all contacts: |f_t|²/μ² + m²/γ² ≤ f_n², with f_n, f_t the normal and tangential force (N) and
/// m the torque about the normal (N·m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient of friction μ, no unit, above 0.
    pub mu: f64,
    /// Torsional friction radius γ (m); 0 for contacts that carry no torque about their normal.
    pub gamma: f64,
}

impl Friction {
    /// Of contacts that carry no torque about their normal.
    pub fn point(mu: f64) -> Self {
        Self { mu, gamma: 0.0 }
    }

    /// Refuses the first value outside its range: μ in 1e-6 to 10, γ in 0 to 1 m.
    pub fn validate(&self) -> Result<(), PhysicsError> {
        check("friction", self.mu, 1e-6, 10.0)?;
        check("gamma", self.gamma, 0.0, 1.0)
    }

    /// How long (m) the lever is with which a tangential force compares with a torque about the normal: γ/μ.
    pub(crate) fn lever(&self) -> f64 {
        self.gamma / self.mu
    }

    /// Whether contacts carry torques about their normals.
    pub(crate) fn has_torsion(&self) -> bool {
        self.gamma > 0.0
    }

    /// The share of the friction that a force without torque needs, for the outward normal `n`: |f_t|/(μ
    /// f_n); infinite where it does not press.
    pub(crate) fn share(&self, n: &Vec3, force: &Vec3) -> f64 {
        let normal = -n.dot(force);
        if normal > 0.0 { (force + n * normal).norm() / (self.mu * normal) } else { f64::INFINITY }
    }

    /// The distance of a force from the cone's boundary (N), positive inside, for the outward normal `n`: μ
    /// f_n - √(|f_t|² + (μ m/γ)²).
    pub fn margin(&self, n: &Vec3, exerted: &ContactForce) -> f64 {
        let normal = -n.dot(&exerted.force);
        let spin = if self.has_torsion() { exerted.spin / self.lever() } else { 0.0 };
        self.mu * normal - (exerted.force + n * normal).norm().hypot(spin)
    }
}

/// What one fingertip exerts on the object at its contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce {
    /// The force on the object (N), in H where nothing else is said.
    pub force: Vec3,
    /// The torque on the object about the contact's outward normal (N·m); 0 without torsional friction.
    pub spin: f64,
}

impl ContactForce {
    /// A force without a torque.
    pub fn pure(force: Vec3) -> Self {
        Self { force, spin: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_on_its_cone_has_no_margin() {
        let friction = Friction { mu: 0.5, gamma: 0.004 };
        let n = Vec3::z();
        let press = Vec3::new(0.0, 0.0, -2.0);
        // All of the friction as force, all as torque, and some of both.
        let (f, m) = (0.5 * 2.0, 0.004 * 2.0);
        for (tangential, spin) in [(f, 0.0), (0.0, -m), (0.6 * f, 0.8 * m)] {
            let exerted = ContactForce { force: press + Vec3::x() * tangential, spin };
            assert!(friction.margin(&n, &exerted).abs() < 1e-12, "{exerted:?}");
        }
        assert_eq!(friction.margin(&n, &ContactForce::pure(press)), 1.0);
        assert_eq!(Friction::point(0.5).margin(&n, &ContactForce::pure(-press)), -1.0);
    }
}
