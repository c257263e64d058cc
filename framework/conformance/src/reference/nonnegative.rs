//! Nonnegative least squares: which combinations of vectors with weights ≥ 0 come closest to a vector.

use nalgebra::{DMatrix, Vector6};

/// Steps after which the search ends wherever it is; about three a vector of the answer are usual.
const MOST_STEPS: usize = 500;

/// The weights s ≥ 0 that make |Σ sⱼ aⱼ - b| least, and the remainder b - Σ sⱼ aⱼ.
///
/// Active sets (Lawson & Hanson, "Solving Least Squares Problems", 1974, chapter 23). At the end no vector
/// makes an acute angle with the remainder, up to rounding: where it is not zero it separates b from the cone
/// of the vectors.
pub(super) fn nonnegative_least_squares(a: &[Vector6<f64>], b: &Vector6<f64>) -> (Vec<f64>, Vector6<f64>) {
    let size = a.iter().map(|v| v.norm()).fold(1e-300, f64::max);
    let mut s = vec![0.0; a.len()];
    let mut active: Vec<usize> = Vec::new();
    let mut remainder = *b;
    for _ in 0..MOST_STEPS {
        let slope = |j: usize| a[j].dot(&remainder);
        let outside = (0..a.len()).filter(|j| !active.contains(j));
        let Some(best) = outside.max_by(|&i, &j| slope(i).total_cmp(&slope(j))) else { break };
        if slope(best) <= 1e-12 * size * b.norm() || active.len() == 6 {
            break;
        }
        active.push(best);
        settle(a, b, &mut s, &mut active);
        remainder = active.iter().fold(*b, |rest, &j| rest - a[j] * s[j]);
    }
    (s, remainder)
}

/// Solves for the active weights; those that would turn negative leave the set on the way.
fn settle(a: &[Vector6<f64>], b: &Vector6<f64>, s: &mut [f64], active: &mut Vec<usize>) {
    while !active.is_empty() {
        let free = unconstrained(a, b, active);
        let ratio = |k: usize| {
            let now = s[active[k]];
            if free[k] > 0.0 { 1.0 } else { now / (now - free[k]) }
        };
        let step = (0..active.len()).map(ratio).fold(1.0, f64::min);
        let step = if step.is_finite() { step } else { 0.0 };
        for (k, &j) in active.iter().enumerate() {
            s[j] += step * (free[k] - s[j]);
        }
        if free.iter().all(|&x| x > 0.0) {
            return;
        }
        let dropped = (0..active.len()).filter(|&k| free[k] <= 0.0 && s[active[k]] <= 1e-14);
        let dropped: Vec<usize> = dropped.map(|k| active[k]).collect();
        let Some(&least) = active.iter().min_by(|&&i, &&j| s[i].total_cmp(&s[j])) else { return };
        active.retain(|j| !dropped.contains(j) && (!dropped.is_empty() || *j != least));
        (0..s.len()).filter(|j| !active.contains(j)).for_each(|j| s[j] = 0.0);
    }
}

/// The weights of the active vectors that come closest to b, whatever their signs.
fn unconstrained(a: &[Vector6<f64>], b: &Vector6<f64>, active: &[usize]) -> Vec<f64> {
    let matrix = DMatrix::from_fn(6, active.len(), |row, k| a[active[k]][row]);
    let qr = matrix.qr();
    let mut right = DMatrix::from_column_slice(6, 1, b.as_slice());
    qr.q_tr_mul(&mut right);
    let top = right.rows(0, active.len()).into_owned();
    match qr.r().solve_upper_triangular(&top) {
        Some(x) => x.iter().copied().collect(),
        None => vec![0.0; active.len()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    #[test]
    fn remainders_separate_and_combinations_are_found() {
        let mut random = Random::from_key(1, 2, 3, 4);
        for _ in 0..200 {
            let mut vector = || Vector6::from_fn(|_, _| random.normal());
            let a: Vec<_> = (0..20).map(|_| vector()).collect();
            let inside = a.iter().enumerate().fold(Vector6::zeros(), |sum, (j, v)| sum + v * (j % 3) as f64);
            let (s, remainder) = nonnegative_least_squares(&a, &inside);
            assert!(remainder.norm() < 1e-9 * inside.norm() && s.iter().all(|&x| x >= 0.0));
            // Five vectors reach a thin cone only: the remainder is what is orthogonal or obtuse to all of
            // them.
            let b = vector();
            let (_, remainder) = nonnegative_least_squares(&a[..5], &b);
            assert!(remainder.norm() > 0.0);
            assert!(a[..5].iter().all(|v| v.dot(&remainder) < 1e-9 * v.norm() * b.norm()));
        }
    }
}
