//! Symmetric 6×6 matrices and their LDLᵀ factors, unrolled by the compiler.

// Index loops over triangles read like the formulas, and unroll.
#![allow(clippy::needless_range_loop)]

use crate::contacts::Twist;
use regrasp_api::Vec3;

/// A symmetric 6×6 matrix; only the lower triangle is kept.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Symmetric6 {
    lower: [[f64; 6]; 6],
}

impl Symmetric6 {
    /// The zero matrix.
    #[inline]
    pub fn zeros() -> Self {
        Self { lower: [[0.0; 6]; 6] }
    }

    /// Adds `c x xᵀ`.
    #[inline]
    pub fn add_outer(&mut self, c: f64, x: &[f64; 6]) {
        for i in 0..6 {
            let scaled = c * x[i];
            for j in 0..=i {
                self.lower[i][j] += scaled * x[j];
            }
        }
    }

    /// Adds `c JᵀJ` with J = [I | -[r]×], the map from a twist to the velocity at r.
    #[inline]
    pub fn add_velocity(&mut self, c: f64, r: &Vec3) {
        let (cr, square) = (r * c, c * r.norm_squared());
        for i in 0..3 {
            self.lower[i][i] += c;
            self.lower[3 + i][3 + i] += square;
            for j in 0..=i {
                self.lower[3 + i][3 + j] -= cr[i] * r[j];
            }
        }
        self.lower[3][1] -= cr.z;
        self.lower[3][2] += cr.y;
        self.lower[4][0] += cr.z;
        self.lower[4][2] -= cr.x;
        self.lower[5][0] -= cr.y;
        self.lower[5][1] += cr.x;
    }

    /// Adds `c (0,n)(0,n)ᵀ`.
    #[inline]
    pub fn add_spin(&mut self, c: f64, n: &Vec3) {
        for i in 0..3 {
            for j in 0..=i {
                self.lower[3 + i][3 + j] += c * n[i] * n[j];
            }
        }
    }

    /// Adds `c` times the identity.
    pub fn add_identity(&mut self, c: f64) {
        (0..6).for_each(|i| self.lower[i][i] += c);
    }

    /// The whole matrix, for eigenvalues.
    pub fn full(&self) -> nalgebra::Matrix6<f64> {
        nalgebra::Matrix6::from_fn(|i, j| self.lower[i.max(j)][i.min(j)])
    }

    /// The LDLᵀ factors of a positive semidefinite matrix; pivots at or below `floor` are raised to it and
    /// remembered.
    #[inline]
    pub fn factor(&self, floor: f64) -> Factor {
        let mut l = self.lower;
        let mut inverse = [0.0; 6];
        let (mut weak, mut smallest) = (None, f64::INFINITY);
        for j in 0..6 {
            let mut pivot = l[j][j];
            smallest = smallest.min(pivot);
            if pivot <= floor {
                weak = weak.or(Some(j));
                pivot = floor;
            }
            inverse[j] = 1.0 / pivot;
            for i in j + 1..6 {
                let l_ij = l[i][j] * inverse[j];
                for k in j + 1..=i {
                    l[i][k] -= l_ij * l[k][j];
                }
            }
            for row in l.iter_mut().skip(j + 1) {
                row[j] *= inverse[j];
            }
        }
        Factor { l, inverse, weak, smallest }
    }
}

/// L (unit lower triangle) and the inverse of D of a symmetric matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factor {
    l: [[f64; 6]; 6],
    inverse: [f64; 6],
    /// The first pivot that was at or below the floor.
    weak: Option<usize>,
    /// The smallest pivot before any was raised.
    pub smallest: f64,
}

impl Factor {
    /// Solves H x = y.
    #[inline]
    pub fn solve(&self, y: [f64; 6]) -> [f64; 6] {
        let mut x = y;
        for i in 0..6 {
            for j in 0..i {
                x[i] -= self.l[i][j] * x[j];
            }
        }
        for i in (0..6).rev() {
            x[i] *= self.inverse[i];
            for j in i + 1..6 {
                x[i] -= self.l[j][i] * x[j];
            }
        }
        x
    }

    /// A twist u with largest coefficient in the weak pivot's place and uᵀHu = that pivot, if there is a weak
    /// pivot.
    pub fn weak_direction(&self) -> Option<Twist> {
        let weak = self.weak?;
        let mut u = [0.0; 6];
        u[weak] = 1.0;
        for j in (0..weak).rev() {
            u[j] = -(j + 1..=weak).map(|i| self.l[i][j] * u[i]).sum::<f64>();
        }
        Some(Twist::from_array(u))
    }

    /// The trace of H⁻¹: the sum of |L⁻¹ e_k|² over D, an upper bound of 1 / the smallest eigenvalue.
    #[inline]
    pub fn trace_of_inverse(&self) -> f64 {
        let mut trace = 0.0;
        for k in 0..6 {
            let mut x = [0.0; 6];
            x[k] = 1.0;
            trace += self.inverse[k];
            for i in k + 1..6 {
                for j in k..i {
                    x[i] -= self.l[i][j] * x[j];
                }
                trace += x[i] * x[i] * self.inverse[i];
            }
        }
        trace
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Random, cross_matrix};

    fn sample(random: &mut Random, rank: usize) -> Symmetric6 {
        let mut h = Symmetric6::zeros();
        for _ in 0..rank {
            h.add_outer(1.0, &std::array::from_fn(|_| random.normal()));
        }
        h
    }

    #[test]
    fn solves_and_traces_agree_with_nalgebra() {
        let mut random = Random::from_key(1, 0, 0, 0);
        for _ in 0..200 {
            let h = sample(&mut random, 9);
            let inverse = h.full().try_inverse().expect("nine random outer products have rank 6");
            let y: [f64; 6] = std::array::from_fn(|_| random.normal());
            let factor = h.factor(0.0);
            let error = nalgebra::Vector6::from(factor.solve(y)) - inverse * nalgebra::Vector6::from(y);
            assert!(factor.smallest > 0.0 && error.norm() < 1e-9 * inverse.norm());
            assert!((factor.trace_of_inverse() - inverse.trace()).abs() < 1e-9 * inverse.trace());
        }
    }

    #[test]
    fn the_weak_direction_is_in_the_null_space() {
        let mut random = Random::from_key(2, 0, 0, 0);
        for rank in 1..6 {
            let h = sample(&mut random, rank);
            let u = h.factor(1e-12).weak_direction().expect("the matrix is singular").to_array();
            let u = nalgebra::Vector6::from(u);
            assert!((h.full() * u).norm() < 1e-9 * u.norm());
        }
    }

    #[test]
    fn velocity_and_spin_terms_are_those_of_their_definitions() {
        let (r, n) = (Vec3::new(0.3, -0.5, 0.9), Vec3::new(0.6, 0.0, 0.8));
        let mut h = Symmetric6::zeros();
        h.add_velocity(0.7, &r);
        h.add_spin(0.2, &n);
        let mut J = nalgebra::Matrix3x6::zeros();
        J.fixed_view_mut::<3, 3>(0, 0).copy_from(&nalgebra::Matrix3::identity());
        J.fixed_view_mut::<3, 3>(0, 3).copy_from(&-cross_matrix(&r));
        let spin = nalgebra::Vector6::new(0.0, 0.0, 0.0, n.x, n.y, n.z);
        let expected = J.transpose() * J * 0.7 + spin * spin.transpose() * 0.2;
        assert!((h.full() - expected).norm() < 1e-14);
    }
}
