//! What a contact exerts, and which of it friction allows.

use crate::PhysicsError;
use crate::settings::check;
use regrasp_api::{Cone, Grain, Vec3, any_orthogonal};

/// Friction of all contacts: |f_t|²/μ² + m²/γ² ≤ f_n², with f_n, f_t the normal and tangential force (N) and
/// m the torque about the normal (N·m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient of friction μ, no unit, above 0.
    pub mu: f64,
    /// Torsional friction radius γ (m); 0 for contacts that carry no torque about their normal.
    pub gamma: f64,
    /// A grain: along it μ counts, across it the coefficient that it names; `None` where friction is the same
    /// all round.
    pub grain: Option<Across>,
    /// The torque about the outward normal, per newton of normal force (m), with which a contact that spins
    /// drags the object along, of either sign; 0 where it does not. It is on top of what the cone allows.
    pub drag: f64,
}

/// Friction across a grain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    /// Coefficient of friction across the grain, no unit, 0 to 10.
    pub mu: f64,
    /// Where the grain runs, in O: see [`regrasp_api::Grain`].
    pub axis_O: Vec3,
}

impl Friction {
    /// Of contacts that carry no torque about their normal.
    pub fn point(mu: f64) -> Self {
        Self::round(mu, 0.0)
    }

    /// The same all round.
    pub fn round(mu: f64, gamma: f64) -> Self {
        Self { mu, gamma, grain: None, drag: 0.0 }
    }

    /// Of contacts with this cone; `None` where it is a polyhedron.
    pub fn of(cone: &Cone<'_>) -> Option<Self> {
        match cone {
            Cone::Elliptic { mu, gamma } => Some(Self::round(*mu, *gamma)),
            Cone::Grained(grain) => {
                let ([mu, across], axis_O) = (grain.mu, grain.axis_O);
                let round = Self::round(mu, grain.gamma);
                Some(Self { grain: Some(Across { mu: across, axis_O }), ..round })
            }
            Cone::Polyhedral(_) => None,
        }
    }

    /// A part of the friction, and one of the torsional friction.
    pub(crate) fn scaled(self, part: f64, torsion_part: f64) -> Self {
        let grain = self.grain.map(|grain| Across { mu: grain.mu * part, ..grain });
        Self { mu: self.mu * part, gamma: self.gamma * torsion_part, grain, ..self }
    }

    /// Without torques about the normal.
    pub(crate) fn without_torsion(self) -> Self {
        Self { gamma: 0.0, ..self }
    }

    /// The same of a contact that drags.
    pub(crate) fn dragging(self, drag: f64) -> Self {
        Self { drag, ..self }
    }

    /// The tangential directions at the outward normal `n_O`, unit vectors in O, with their coefficients.
    pub(crate) fn tangents(&self, n_O: &Vec3) -> [(Vec3, f64); 2] {
        match self.grain {
            Some(Across { mu, axis_O }) => Grain { mu: [self.mu, mu], gamma: self.gamma, axis_O }.at(n_O),
            None => {
                let tangent = any_orthogonal(n_O);
                [(tangent, self.mu), (n_O.cross(&tangent), self.mu)]
            }
        }
    }

    /// Refuses the first value outside its range: μ in 1e-6 to 10, γ in 0 to 1 m.
    pub fn validate(&self) -> Result<(), PhysicsError> {
        check("friction", self.most(), 1e-6, 10.0)?;
        check("friction", self.mu, 0.0, 10.0)?;
        if let Some(grain) = self.grain {
            check("friction", grain.mu, 0.0, 10.0)?;
        }
        check("gamma", self.gamma, 0.0, 1.0)?;
        check("drag", self.drag, -1.0, 1.0)
    }

    /// How long (m) the lever is with which a tangential force compares with a torque about the normal: γ/μ.
    pub(crate) fn lever(&self) -> f64 {
        self.gamma / self.most()
    }

    /// The largest coefficient.
    pub(crate) fn most(&self) -> f64 {
        self.grain.map_or(self.mu, |grain| self.mu.max(grain.mu))
    }

    /// The length of a tangential force, its parts along and across a grain counted by how much harder they
    /// are to bear than where friction is largest; for the outward normal `n`.
    fn weighed(&self, n: &Vec3, tangential: &Vec3) -> f64 {
        if self.grain.is_none() {
            return tangential.norm();
        }
        let [(a, along), (b, across)] = self.tangents(n);
        let part = |t: &Vec3, mu: f64| {
            let f = tangential.dot(t);
            if mu > 0.0 { f * self.most() / mu } else { f * f64::INFINITY }
        };
        // No force at all needs no friction, where there is none either.
        let finite = |x: f64| if x.is_nan() { 0.0 } else { x };
        finite(part(&a, along)).hypot(finite(part(&b, across)))
    }

    /// Whether contacts carry torques about their normals.
    pub(crate) fn has_torsion(&self) -> bool {
        self.gamma > 0.0
    }

    /// The share of the friction that a force without torque needs, for the outward normal `n`: |f_t|/(μ
    /// f_n); infinite where it does not press.
    pub(crate) fn share(&self, n: &Vec3, force: &Vec3) -> f64 {
        let normal = -n.dot(force);
        if normal > 0.0 {
            self.weighed(n, &(force + n * normal)) / (self.most() * normal)
        } else {
            f64::INFINITY
        }
    }

    /// The distance of a force from the cone's boundary (N), positive inside, for the outward normal `n`: μ
    /// f_n - √(|f_t|² + (μ m/γ)²). With a grain μ is the larger coefficient, and the part of f_t that meets
    /// the smaller one counts as much more. `n` and the force in O, then.
    pub fn margin(&self, n: &Vec3, exerted: &ContactForce) -> f64 {
        let normal = -n.dot(&exerted.force);
        let spin = if self.has_torsion() { exerted.spin / self.lever() } else { 0.0 };
        self.most() * normal - self.weighed(n, &(exerted.force + n * normal)).hypot(spin)
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
        let friction = Friction::round(0.5, 0.004);
        let n = Vec3::z();
        let press = Vec3::new(0.0, 0.0, -2.0);
        // All of the friction as force, all as torque, and some of both.
        let (f, m) = (0.5 * 2.0, 0.004 * 2.0);
        for (tangential, spin) in [(f, 0.0), (0.0, -m), (0.6 * f, 0.8 * m)] {
            let exerted = ContactForce { force: press + Vec3::x() * tangential, spin };
            assert!(friction.margin(&n, &exerted).abs() < 1e-12, "{exerted:?}");
        }
        assert_eq!(friction.margin(&n, &ContactForce::pure(press)), 1.0);
        let grain = Some(Across { mu: 0.25, axis_O: Vec3::x() });
        let grained = Friction { grain, ..friction };
        for (tangential, share) in [(Vec3::x(), 1.0), (Vec3::y() * 0.5, 1.0), (Vec3::y(), 2.0)] {
            let found = grained.share(&n, &(press + tangential));
            assert!((found - share).abs() < 1e-12, "{found} for {share}");
        }
        assert_eq!(Friction::point(0.5).margin(&n, &ContactForce::pure(-press)), -1.0);
    }
}
