//! One contact's part of a Newton step: its barrier, and what of it the other contacts see.

use super::bearing::{Bearing, Exerted};
use super::ldl::Ldl;
use nalgebra::{Vector4, Vector6};
use regrasp_api::MAX_FINGER_JOINTS;

/// -log(s²μ² f_n² - |f_t|²) - Σ log(1 - (a·x)²) - log(1 - f_n/most) of one contact, to second order.
///
/// With the Hessian H = L D Lᵀ and the grasp map G everything that a step needs is in L⁻¹Gᵀ and L⁻¹ times the
/// gradient.
#[derive(Clone, Copy)]
pub(crate) struct Barrier {
    /// s²μ².
    sigma2: f64,
    /// The form s²μ² f_n² - |f_t|², and half its gradient.
    form: f64,
    half: Vector4<f64>,
    /// First and second derivative along each effort's row.
    slopes: [(f64, f64); MAX_FINGER_JOINTS],
    /// 1/(most - f_n).
    press: f64,
    hessian: Ldl<4>,
    map: [Vector6<f64>; 4],
    gradient: [f64; 4],
    /// Coordinates that count: 4, or 3 without torsion.
    size: usize,
}

/// The sums of a Newton step over all contacts.
pub(crate) struct Sums {
    /// G H⁻¹ Gᵀ, column by column.
    pub square: [[f64; 6]; 6],
    /// The right side.
    pub right: Vector6<f64>,
}

impl Barrier {
    /// Fills a place.
    pub const NOTHING: Self = Self {
        sigma2: 0.0,
        form: 1.0,
        half: Vector4::new(0.0, 0.0, 0.0, 0.0),
        slopes: [(0.0, 0.0); MAX_FINGER_JOINTS],
        press: 0.0,
        hessian: Ldl::NOTHING,
        map: [Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0); 4],
        gradient: [0.0; 4],
        size: 0,
    };

    /// At forces inside; whether that is possible.
    pub fn set(&mut self, bearing: &Bearing, share: f64, x: &Exerted) -> bool {
        let sigma2 = (share * bearing.mu).powi(2);
        let half = Vector4::new(sigma2 * x[0], -x[1], -x[2], -x[3]);
        let form = half.dot(x);
        (self.sigma2, self.form, self.half) = (sigma2, form, half);
        let inverse = 1.0 / form;
        let mut gradient = half * (-2.0 * inverse);
        let outer = half * (4.0 * inverse * inverse);
        let mut hessian: [[f64; 4]; 4] = std::array::from_fn(|i| std::array::from_fn(|j| outer[i] * half[j]));
        hessian[0][0] -= 2.0 * sigma2 * inverse;
        (1..4).for_each(|k| hessian[k][k] += 2.0 * inverse);
        for (row, slope) in bearing.rows().iter().zip(&mut self.slopes) {
            *slope = slopes(row.dot(x));
            gradient += row * slope.0;
            let scaled = row * slope.1;
            (0..4).for_each(|i| (0..=i).for_each(|j| hessian[i][j] += scaled[i] * row[j]));
        }
        self.press = if bearing.most.is_finite() { 1.0 / (bearing.most - x[0]) } else { 0.0 };
        gradient[0] += self.press;
        hessian[0][0] += self.press * self.press;
        self.size = 4;
        if !bearing.has_torsion() {
            // The coordinate does nothing and stays 0.
            hessian[3] = [0.0, 0.0, 0.0, 2.0 * inverse];
            gradient[3] = 0.0;
            self.size = 3;
        }
        let Some(factor) = Ldl::new(&hessian) else { return false };
        self.hessian = factor;
        self.map = factor.forward(std::array::from_fn(|k| bearing.map.column(k).into_owned()));
        self.gradient = factor.forward(gradient.into());
        true
    }

    /// Adds this contact's part: G H⁻¹ Gᵀ, and G H⁻¹ times the gradient.
    pub fn add(&self, sums: &mut Sums) {
        for k in 0..self.size {
            let row = &self.map[k];
            let scaled = row * self.hessian.inverse[k];
            for (column, factor) in sums.square.iter_mut().zip(row.iter()) {
                (0..6).for_each(|i| column[i] += scaled[i] * factor);
            }
            sums.right += scaled * self.gradient[k];
        }
    }

    /// The change of the forces for a multiplier, H⁻¹(Gᵀλ - ∇), and its part of the decrement's square.
    pub fn change(&self, multiplier: &Vector6<f64>) -> (Exerted, f64) {
        let uphill: [f64; 4] = std::array::from_fn(|k| self.map[k].dot(multiplier) - self.gradient[k]);
        let decrement = (0..4).map(|k| uphill[k] * uphill[k] * self.hessian.inverse[k]).sum();
        (self.hessian.backward(uphill).into(), decrement)
    }

    /// How the forces follow a multiplier, H⁻¹Gᵀλ.
    pub fn follow(&self, multiplier: &Vector6<f64>) -> Exerted {
        self.hessian.backward(std::array::from_fn(|k| self.map[k].dot(multiplier))).into()
    }

    /// The most power that this contact's forces can have on the step's multiplier, by weak duality.
    ///
    /// What the contact sees of the multiplier is exactly a part v in the cone's coordinates and parts λ_j
    /// along the efforts' rows. Where v is in the polar of the cone it has no power, and the rest has at most
    /// Σ |λ_j| within the efforts.
    pub fn power(&self, bearing: &Bearing, d: &Exerted) -> f64 {
        let inverse = 1.0 / self.form;
        let bent = Vector4::new(-self.sigma2 * d[0], d[1], d[2], d[3]);
        let along = 2.0 * inverse * self.half.dot(d) - 1.0;
        let v = (self.half * along + bent) * (2.0 * inverse);
        let tangential = v.fixed_rows::<3>(1).norm();
        let over = v[0] + self.sigma2.sqrt() * tangential;
        let mut power = 0.0;
        if over > 0.0 {
            // Only the bound of the normal force limits what the cone gives along v.
            power += over * bearing.most;
        }
        for (row, (first, second)) in bearing.rows().iter().zip(self.slopes) {
            power += (first + second * row.dot(d)).abs();
        }
        if bearing.most.is_finite() {
            power += (self.press + self.press * self.press * d[0]).max(0.0) * bearing.most;
        }
        power
    }

    /// The largest multiple of `d` that may be added to `x` within the bounds.
    pub fn reach(&self, bearing: &Bearing, x: &Exerted, d: &Exerted) -> f64 {
        let slope = 2.0 * self.half.dot(d);
        let curve = self.sigma2 * d[0] * d[0] - (d[1] * d[1] + d[2] * d[2] + d[3] * d[3]);
        // The smallest positive root of q + t q' + t² c, for q > 0.
        let root = (slope * slope - 4.0 * curve * self.form).max(0.0).sqrt();
        let mut reach = if root > slope { 2.0 * self.form / (root - slope) } else { f64::INFINITY };
        for row in bearing.rows() {
            let (u, du) = (row.dot(x), row.dot(d));
            if du != 0.0 {
                reach = reach.min((du.signum() - u) / du);
            }
        }
        if d[0] > 0.0 {
            reach = reach.min((bearing.most - x[0]) / d[0]);
        }
        reach
    }
}

/// First and second derivative of -log(1 - u²).
pub(super) fn slopes(u: f64) -> (f64, f64) {
    let inverse = 1.0 / (1.0 - u * u);
    (2.0 * u * inverse, 2.0 * (1.0 + u * u) * inverse * inverse)
}
