//! The standard normal distribution.

use std::f64::consts::FRAC_1_SQRT_2;

/// The value that a standard normal variable exceeds with probability 0.025: half the width of a 95 %
/// interval in standard deviations.
pub const Z_95: f64 = 1.959_963_984_540_054;

/// P(Z ≥ z) of a standard normal variable; relative error below 1e-12 for z up to 37, where it underflows.
pub fn upper_tail(z: f64) -> f64 {
    0.5 * libm::erfc(z * FRAC_1_SQRT_2)
}

/// The value that a standard normal variable exceeds with probability `tail` (above 0, below 1): the inverse
/// of [`upper_tail`], by bisection.
pub fn upper_point(tail: f64) -> f64 {
    let (mut low, mut high) = (-40.0, 40.0);
    // Each step halves what is left; after 100 nothing is.
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if upper_tail(middle) > tail { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_where_their_tails_are() {
        assert!((upper_point(0.025) - Z_95).abs() < 1e-11);
        // scipy 1.17.1: scipy.stats.norm.isf(1e-6).
        assert!((upper_point(1e-6) - 4.753_424_308_822_899).abs() < 1e-9);
        assert!((upper_point(0.9) + upper_point(0.1)).abs() < 1e-11);
    }

    #[test]
    fn tails_are_those_of_the_tables() {
        // scipy 1.17.1: scipy.stats.norm.sf(z).
        let table = [
            (0.0, 0.5),
            (0.5, 0.308_537_538_725_986_9),
            (Z_95, 0.025),
            (2.4999, 0.006_211_418_374_944_587),
            (2.5001, 0.006_207_912_714_815_193),
            (4.0, 3.167_124_183_311_986e-5),
            (10.0, 7.619_853_024_160_47e-24),
            (-1.0, 0.841_344_746_068_542_9),
        ];
        for (z, tail) in table {
            assert!((upper_tail(z) / tail - 1.0).abs() < 1e-11, "{z}: {} is not {tail}", upper_tail(z));
        }
    }
}
