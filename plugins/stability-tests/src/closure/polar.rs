//! The polar body Ω = {w : h_i(-w) ≤ 1 for all i} and its barrier -Σ log q_i.
//!
//! With v = a + b×r, s0 = 1 + v_n and β = b·n the body is s0 ≥ sqrt(μ²|v_t|² + γ²β²) at every contact, and q
//! = s0² - μ²|v_t|² - γ²β² is quadratic along every line. Ω is bounded exactly where the grasp is force
//! closure. A grain makes μ²|v_t|² + (g·v_t)² of μ²|v_t|², which changes nothing else.

use super::symmetric::Symmetric6;
use crate::contacts::{ScaledContact, ScaledGrasp, Twist};
use regrasp_api::{MAX_FINGERS, Vec3};

/// What a contact sees of a twist: its normal, tangential and spinning part, and the barrier's argument.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local {
    /// s0 at a point, the normal part of the velocity along a direction.
    pub s0: f64,
    /// Tangential part of the velocity at the contact.
    pub v_t: Vec3,
    /// Spin about the normal.
    pub beta: f64,
    /// q at a point; q' along a direction.
    pub q: f64,
    /// q'' / 2 along a direction.
    pub curvature: f64,
}

impl Local {
    const ZERO: Self = Self { s0: 0.0, v_t: Vec3::new(0.0, 0.0, 0.0), beta: 0.0, q: 0.0, curvature: 0.0 };

    #[inline]
    fn velocity(contact: &ScaledContact, w: &Twist) -> Self {
        let v = w.a + w.b.cross(&contact.r);
        let s0 = v.dot(&contact.n);
        Self { s0, v_t: v - contact.n * s0, beta: w.b.dot(&contact.n), q: 0.0, curvature: 0.0 }
    }

    /// The bilinear form of q between two: `s0 s0' - μ² v_t·v_t' - γ² β β'`.
    #[inline]
    fn form(&self, contact: &ScaledContact, other: &Self) -> f64 {
        let gamma2 = contact.gamma * contact.gamma;
        self.s0 * other.s0 - contact.form(&self.v_t, &other.v_t) - gamma2 * (self.beta * other.beta)
    }
}

impl Local {
    /// The largest eigenvalue of the barrier's Hessian at a point, over (v_n, μ v_t, γ β): 2/(s0 - |u|)² = 2
    /// (s0 + |u|)²/q², at most 8 s0²/q².
    #[inline]
    pub fn stiffness(&self) -> f64 {
        8.0 * (self.s0 / self.q).powi(2)
    }
}

/// One value of [`Local`] for each contact.
pub(crate) type Locals = [Local; MAX_FINGERS];

/// The polar body of a grasp.
#[derive(Clone, Copy)]
pub(crate) struct PolarBody<'a> {
    pub grasp: &'a ScaledGrasp,
}

impl PolarBody<'_> {
    /// What the contacts see of the point `w`.
    #[inline]
    pub fn at(&self, w: &Twist) -> Locals {
        let mut locals = [Local::ZERO; MAX_FINGERS];
        for (local, contact) in locals.iter_mut().zip(self.grasp.contacts()) {
            *local = Local::velocity(contact, w);
            local.s0 += 1.0;
            local.q = local.form(contact, local);
        }
        locals
    }

    /// What the contacts see of a move along `d` from the point whose locals are `here`.
    #[inline]
    pub fn along(&self, here: &Locals, d: &Twist) -> Locals {
        let mut locals = [Local::ZERO; MAX_FINGERS];
        for ((local, here), contact) in locals.iter_mut().zip(here).zip(self.grasp.contacts()) {
            *local = Local::velocity(contact, d);
            local.q = 2.0 * here.form(contact, local);
            local.curvature = local.form(contact, local);
        }
        locals
    }

    /// Hessian H of the barrier and *minus* its gradient g at the point whose locals are `here`; Newton's
    /// step solves H d = g.
    #[inline]
    pub fn newton_system(&self, here: &Locals) -> (Symmetric6, [f64; 6]) {
        let mut H = Symmetric6::zeros();
        let mut g = [0.0; 6];
        for (local, contact) in here.iter().zip(self.grasp.contacts()) {
            let (mu2, gamma2) = (contact.mu * contact.mu, contact.gamma * contact.gamma);
            let scale = 2.0 / local.q;
            let phi = (contact.n * local.s0 - contact.squared(&local.v_t)) * scale;
            let moment = contact.r.cross(&phi) - contact.n * (scale * gamma2 * local.beta);
            let z = Twist { a: phi, b: moment }.to_array();
            H.add_outer(1.0, &z);
            H.add_outer(-scale * (1.0 + mu2), &normal_wrench(contact));
            H.add_velocity(scale * mu2, &contact.r);
            if contact.grained {
                H.add_outer(scale, &contact.grain_wrench());
            }
            if gamma2 > 0.0 {
                H.add_spin(scale * gamma2, &contact.n);
            }
            g.iter_mut().zip(z).for_each(|(g, z)| *g += z);
        }
        (H, g)
    }

    /// M = G Gᵀ with the columns of the grasp map scaled by 1, μ, μ, γ, and the sum of the normal wrenches.
    ///
    /// At w = 0 the barrier's Hessian is 2M and minus its gradient twice that sum.
    #[inline]
    pub fn grasp_map_square(&self) -> (Symmetric6, [f64; 6]) {
        let mut M = Symmetric6::zeros();
        let mut sum = [0.0; 6];
        for contact in self.grasp.contacts() {
            let g0 = normal_wrench(contact);
            Self::add_contact(&mut M, contact, &g0);
            sum.iter_mut().zip(g0).for_each(|(sum, g0)| *sum += g0);
        }
        (M, sum)
    }

    /// Adds the contact's part of M.
    #[inline]
    fn add_contact(M: &mut Symmetric6, contact: &ScaledContact, g0: &[f64; 6]) {
        let (mu2, gamma2) = (contact.mu * contact.mu, contact.gamma * contact.gamma);
        M.add_outer(1.0 - mu2, g0);
        M.add_velocity(mu2, &contact.r);
        if contact.grained {
            M.add_outer(1.0, &contact.grain_wrench());
        }
        if gamma2 > 0.0 {
            M.add_spin(gamma2, &contact.n);
        }
    }

    /// The part of M that belongs to the contacts which feel at most `bound` of `w`: |(v_n, μ v_t, γ β)| ≤
    /// bound.
    pub fn felt_square(&self, w: &Twist, bound: f64) -> Symmetric6 {
        let mut M = Symmetric6::zeros();
        for contact in self.grasp.contacts() {
            let seen = Local::velocity(contact, w);
            let tangential = contact.form(&seen.v_t, &seen.v_t);
            let spin = (contact.gamma * seen.beta).powi(2);
            if seen.s0 * seen.s0 + tangential + spin <= bound * bound {
                Self::add_contact(&mut M, contact, &normal_wrench(contact));
            }
        }
        M
    }

    /// Whether no contact resists the move `d`, to rounding: h_i(-d) ≤ 1e-12 |d| for all i, d ≠ 0.
    pub fn separates(&self, d: &Twist) -> bool {
        let bound = 1e-12 * d.norm();
        let back = d.scaled(-1.0);
        // An overflowed twist proves nothing.
        bound > 0.0
            && bound.is_finite()
            && self.grasp.contacts().iter().all(|contact| contact.support(&back) <= bound)
    }

    /// The largest support max h_i(-w): w is in Ω where it is at most 1.
    pub fn gauge(&self, w: &Twist) -> f64 {
        let back = w.scaled(-1.0);
        self.grasp.contacts().iter().map(|contact| contact.support(&back)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The step t > 0 that maximises `slope t + Σ log q_i(w + t d)`; `None` where the line never leaves Ω.
    ///
    /// Each q_i is quadratic in t, so no evaluation costs more than a few products. Newton in one dimension,
    /// kept inside the body.
    #[inline]
    pub fn best_step(&self, here: &Locals, along: &Locals, slope: f64) -> Option<f64> {
        let count = self.grasp.contacts().len();
        let lines = || here[..count].iter().zip(&along[..count]);
        let end = lines()
            .map(|(here, along)| first_root(here.q, along.q, along.curvature))
            .fold(f64::INFINITY, f64::min);
        if end == f64::INFINITY {
            return None;
        }
        let mut t = (0.5 * end).min(1.0);
        for _ in 0..LINE_STEPS {
            let (mut first, mut second) = (slope, 0.0);
            for (here, along) in lines() {
                let inverse = 1.0 / (here.q + t * (along.q + t * along.curvature));
                let rate = (along.q + 2.0 * t * along.curvature) * inverse;
                first += rate;
                second += rate * rate - 2.0 * along.curvature * inverse;
            }
            let next = t + first / second;
            let next = if next >= end { 0.5 * (t + end) } else { next.max(0.5 * t) };
            let done = (next - t).abs() <= 0.05 * t;
            t = next;
            if done {
                break;
            }
        }
        Some(t)
    }
}

/// Steps of the line search: near a face of Ω each halves the distance to it, and more precision is not
/// needed.
const LINE_STEPS: usize = 8;

/// (n, r×n): the wrench of a unit normal force.
#[inline]
fn normal_wrench(contact: &ScaledContact) -> [f64; 6] {
    Twist { a: contact.n, b: contact.r.cross(&contact.n) }.to_array()
}

/// The smallest positive root of q + t q' + t² c, for q > 0; infinite where there is none.
#[inline]
fn first_root(q: f64, slope: f64, c: f64) -> f64 {
    let root = (slope * slope - 4.0 * c * q).max(0.0).sqrt();
    if root > slope { 2.0 * q / (root - slope) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Cone, FingerIndex, Grasp, GraspContact};

    /// Four contacts around a regular tetrahedron: closed, so nothing separates.
    fn tetrahedron() -> ScaledGrasp {
        let mut grasp = Grasp::new(Vec3::zeros());
        for corner in [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]] {
            let n_O = Vec3::from(corner).normalize();
            let cone = Cone::Elliptic { mu: 0.5, gamma: 0.0 };
            grasp.push(GraspContact { finger: FingerIndex(0), p_OC: n_O, n_O, cone });
        }
        ScaledGrasp::gather(&grasp, None, "test").unwrap()
    }

    #[test]
    fn neither_no_twist_nor_an_overflowed_one_separates() {
        let grasp = tetrahedron();
        let body = PolarBody { grasp: &grasp };
        for size in [0.0, 1.0, 1e160, f64::INFINITY, f64::NAN] {
            let d = Twist { a: Vec3::new(size, 0.3 * size, -size), b: Vec3::zeros() };
            assert!(!body.separates(&d), "{size}");
        }
    }

    #[test]
    fn the_best_step_is_stationary_and_stays_inside() {
        let grasp = tetrahedron();
        let body = PolarBody { grasp: &grasp };
        let w = Twist { a: Vec3::new(0.2, -0.1, 0.3), b: Vec3::new(0.1, 0.4, -0.2) };
        let d = Twist { a: Vec3::new(-1.0, 0.4, 0.3), b: Vec3::new(0.3, 0.1, 0.9) };
        assert!(body.gauge(&w) < 1.0);
        let barrier = |t: f64| body.at(&w.plus(t, &d))[..4].iter().map(|local| local.q.ln()).sum::<f64>();
        let here = body.at(&w);
        let along = body.along(&here, &d);
        let slope: f64 = (0..4).map(|i| along[i].q / here[i].q).sum();
        let sign = slope.signum();
        let d = d.scaled(sign);
        let t = body.best_step(&here, &body.along(&here, &d), 0.0).expect("the body is bounded");
        assert!(t > 0.0 && body.gauge(&w.plus(t, &d)) < 1.0);
        let best = (1..1000).map(|k| barrier(sign * f64::from(k) * 0.01 * t)).filter(|x| !x.is_nan());
        assert!(best.fold(f64::NEG_INFINITY, f64::max) <= barrier(sign * t) + 0.05);
    }
}
