//! Symmetric matrices of six rows: the inner step of every proof, in loops that the compiler unrolls.

#![allow(clippy::needless_range_loop)] // rows and columns of matrices

use nalgebra::{Matrix6, Vector6};
use regrasp_api::Vec3;

/// A symmetric matrix, of which the lower triangle counts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Six([[f64; 6]; 6]);

impl Six {
    pub(crate) const ZERO: Self = Self([[0.0; 6]; 6]);

    /// Adds so many times a vector's outer product with itself.
    #[inline]
    pub(crate) fn add(&mut self, v: &Vector6<f64>, times: f64) {
        for i in 0..6 {
            let scaled = v[i] * times;
            for k in 0..=i {
                self.0[i][k] += scaled * v[k];
            }
        }
    }

    /// Adds so many times J Jᵀ with J = [I; [r]×]: all wrenches of unit forces at a point.
    #[inline]
    pub(crate) fn add_point(&mut self, r: &Vec3, times: f64) {
        let square = r.norm_squared();
        for i in 0..3 {
            self.0[i][i] += times;
            for k in 0..=i {
                let own = if i == k { square } else { 0.0 };
                self.0[3 + i][3 + k] += times * (own - r[i] * r[k]);
            }
        }
        let cross = [[0.0, -r.z, r.y], [r.z, 0.0, -r.x], [-r.y, r.x, 0.0]];
        for (row, cross) in self.0[3..].iter_mut().zip(&cross) {
            for (entry, cross) in row.iter_mut().zip(cross) {
                *entry += times * cross;
            }
        }
    }

    /// Its factor; `None` where it is not positive definite.
    #[inline]
    pub(crate) fn factor(&self) -> Option<Factor> {
        let mut lower = self.0;
        let (mut pivots, mut inverse) = ([0.0; 6], [0.0; 6]);
        for j in 0..6 {
            let scaled: [f64; 6] = std::array::from_fn(|k| lower[j][k] * pivots[k]);
            let mut pivot = lower[j][j];
            for k in 0..j {
                pivot -= lower[j][k] * scaled[k];
            }
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            (pivots[j], inverse[j]) = (pivot, 1.0 / pivot);
            for row in &mut lower[j + 1..] {
                let mut entry = row[j];
                for k in 0..j {
                    entry -= row[k] * scaled[k];
                }
                row[j] = entry * inverse[j];
            }
        }
        Some(Factor { lower, inverse })
    }

    /// Its smallest eigenvalue.
    pub(crate) fn smallest_eigenvalue(&self) -> f64 {
        Matrix6::from_fn(|i, k| self.0[i.max(k)][i.min(k)]).symmetric_eigenvalues().min()
    }
}

/// L D Lᵀ of a positive definite matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factor {
    /// L below its diagonal of ones; what stands above counts for nothing.
    lower: [[f64; 6]; 6],
    /// 1/D.
    inverse: [f64; 6],
}

impl Factor {
    /// The solution for a right side.
    #[inline]
    pub(crate) fn solve(&self, b: &Vector6<f64>) -> Vector6<f64> {
        let mut x: [f64; 6] = (*b).into();
        for i in 1..6 {
            for k in 0..i {
                x[i] -= x[k] * self.lower[i][k];
            }
        }
        for (x, inverse) in x.iter_mut().zip(&self.inverse) {
            *x *= inverse;
        }
        for i in (0..5).rev() {
            for k in i + 1..6 {
                x[i] -= x[k] * self.lower[k][i];
            }
        }
        x.into()
    }

    /// A lower bound of the matrix's smallest eigenvalue: 1/‖M⁻¹‖ ≤ λ_min.
    #[inline]
    pub(crate) fn least(&self) -> f64 {
        // K = L⁻¹; M⁻¹ = Kᵀ D⁻¹ K.
        let mut k = [[0.0; 6]; 6];
        for i in 0..6 {
            k[i][i] = 1.0;
            for j in 0..i {
                let mut entry = 0.0;
                for m in j..i {
                    entry -= self.lower[i][m] * k[m][j];
                }
                k[i][j] = entry;
            }
        }
        let mut square = 0.0;
        for i in 0..6 {
            for j in 0..=i {
                let mut entry = 0.0;
                for m in i..6 {
                    entry += k[m][i] * self.inverse[m] * k[m][j];
                }
                square += entry * entry * if i == j { 1.0 } else { 2.0 };
            }
        }
        1.0 / square.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SMatrix;
    use regrasp_api::{Random, cross_matrix};

    #[test]
    fn it_adds_solves_and_bounds_as_matrices_do() {
        let mut random = Random::from_key(5, 0, 0, 0);
        for _ in 0..200 {
            let (mut six, mut dense) = (Six::ZERO, Matrix6::zeros());
            for _ in 0..3 {
                let (r, v) = (random.direction() * random.unit(), Vector6::from_fn(|_, _| random.normal()));
                let mut J = SMatrix::<f64, 6, 3>::zeros();
                J.fixed_rows_mut::<3>(0).fill_with_identity();
                J.fixed_rows_mut::<3>(3).copy_from(&cross_matrix(&r));
                six.add_point(&r, 0.7);
                six.add(&v, 0.4);
                dense += J * J.transpose() * 0.7 + v * v.transpose() * 0.4;
            }
            let b = Vector6::from_fn(|_, _| random.normal());
            let factor = six.factor().expect("nine columns span all");
            assert!((dense * factor.solve(&b) - b).norm() < 1e-9);
            let eigenvalues = dense.symmetric_eigenvalues();
            assert!((six.smallest_eigenvalue() - eigenvalues.min()).abs() < 1e-12);
            let inverse = dense.try_inverse().expect("it is positive definite");
            assert!((factor.least() * inverse.norm() - 1.0).abs() < 1e-9);
            assert!(factor.least() <= eigenvalues.min());
        }
    }

    #[test]
    fn what_is_not_positive_has_no_factor() {
        let mut six = Six::ZERO;
        assert!(six.factor().is_none());
        six.add_point(&Vec3::x(), 1.0);
        assert!(six.factor().is_none(), "forces at one point do not turn about it");
    }
}
