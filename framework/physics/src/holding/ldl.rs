//! Small symmetric systems, whose loops the compiler unrolls: the inner step of every search for forces.

/// L D Lᵀ of a positive definite matrix (G. H. Golub, C. F. Van Loan, "Matrix Computations", 2013, 4.1.2).
///
/// nalgebra's Cholesky with its inverse took two thirds of a Newton step.
#[derive(Clone, Copy)]
pub(crate) struct Ldl<const N: usize> {
    /// L below its diagonal of ones; what stands above counts for nothing.
    lower: [[f64; N]; N],
    /// 1/D.
    pub inverse: [f64; N],
}

impl<const N: usize> Ldl<N> {
    /// Of the identity: fills a place.
    pub const NOTHING: Self = Self { lower: [[0.0; N]; N], inverse: [1.0; N] };

    /// Of a matrix of which the lower triangle is read; `None` where it is not positive definite.
    #[inline]
    pub fn new(matrix: &[[f64; N]; N]) -> Option<Self> {
        let mut made = Self { lower: *matrix, inverse: [0.0; N] };
        let mut pivots = [0.0; N];
        for j in 0..N {
            let scaled: [f64; N] = std::array::from_fn(|k| made.lower[j][k] * pivots[k]);
            let pivot = (0..j).fold(matrix[j][j], |left, k| left - made.lower[j][k] * scaled[k]);
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            (pivots[j], made.inverse[j]) = (pivot, 1.0 / pivot);
            for row in &mut made.lower[j + 1..] {
                let entry = (0..j).fold(row[j], |left, k| left - row[k] * scaled[k]);
                row[j] = entry * made.inverse[j];
            }
        }
        Some(made)
    }

    /// L⁻¹ b, for numbers or whole rows.
    #[inline]
    pub fn forward<T>(&self, mut b: [T; N]) -> [T; N]
    where
        T: Copy + std::ops::Mul<f64, Output = T> + std::ops::Sub<Output = T>,
    {
        for i in 1..N {
            b[i] = (0..i).fold(b[i], |left, k| left - b[k] * self.lower[i][k]);
        }
        b
    }

    /// L⁻ᵀ D⁻¹ b.
    #[inline]
    pub fn backward(&self, mut b: [f64; N]) -> [f64; N] {
        (0..N).for_each(|k| b[k] *= self.inverse[k]);
        for i in (0..N).rev() {
            b[i] = (i + 1..N).fold(b[i], |left, k| left - b[k] * self.lower[k][i]);
        }
        b
    }

    /// The solution for a right side.
    #[inline]
    pub fn solve(&self, b: [f64; N]) -> [f64; N] {
        self.backward(self.forward(b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix5, Vector5};
    use regrasp_api::Random;

    #[test]
    fn it_solves_as_a_matrix_of_any_condition_asks() {
        let mut random = Random::from_key(3, 0, 0, 0);
        for scale in [1.0, 1e3, 1e6] {
            for _ in 0..100 {
                let root =
                    Matrix5::from_fn(|_, k| random.range(-1.0, 1.0) * if k == 2 { scale } else { 1.0 });
                let matrix = root * root.transpose() + Matrix5::identity();
                let wanted = Vector5::from_fn(|_, _| random.range(-1.0, 1.0));
                let rows = std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]));
                let found = Ldl::new(&rows).unwrap().solve((matrix * wanted).into());
                assert!((Vector5::from(found) - wanted).norm() < 1e-14 * scale * scale + 1e-13);
            }
        }
    }

    #[test]
    fn what_is_not_positive_is_refused() {
        assert!(Ldl::new(&[[1.0, 0.0], [2.0, 4.0]]).is_none());
        assert!(Ldl::new(&[[-1.0]]).is_none());
        assert!(Ldl::new(&[[f64::NAN]]).is_none());
    }
}
