//! How much more often one side solves than the other.

use super::Estimate;
use super::normal::upper_point;
use super::wilson::wilson_at;

/// Pairs of runs by who solved: both, the first alone, the second alone, neither.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Solved {
    /// Seeds that both sides solved.
    pub both: usize,
    /// Seeds that the first alone solved.
    pub first: usize,
    /// Seeds that the second alone solved.
    pub second: usize,
    /// Seeds that neither solved.
    pub neither: usize,
}

/// The share of pairs that the first solved less the share that the second solved (-1..=1), with an interval
/// that misses the true difference with probability `alpha`; `None` for no pairs.
///
/// R. G. Newcombe, "Improved confidence intervals for the difference between binomial proportions based on
/// paired data", Statistics in Medicine 1998, method 10: Wilson's intervals of both shares, joined by their
/// correlation. It is no point where both solved everything.
pub fn paired_difference(solved: Solved, alpha: f64) -> Option<Estimate> {
    let Solved { both, first, second, neither } = solved;
    let n = both + first + second + neither;
    let z = upper_point(alpha / 2.0);
    let (mine, theirs) = (wilson_at(both + first, n, z)?, wilson_at(both + second, n, z)?);
    let phi = correlation(solved);
    let reach = |a: f64, b: f64| (a * a - 2.0 * phi * a * b + b * b).max(0.0).sqrt();
    let value = mine.value - theirs.value;
    let low = value - reach(mine.value - mine.low, theirs.high - theirs.value);
    let high = value + reach(mine.high - mine.value, theirs.value - theirs.low);
    Some(Estimate { value, low: low.max(-1.0), high: high.min(1.0) })
}

/// Newcombe's correlation of the two sides, corrected for continuity.
fn correlation(solved: Solved) -> f64 {
    let [a, b, c, d] = [solved.both, solved.first, solved.second, solved.neither].map(|count| count as f64);
    let product = (a + b) * (c + d) * (a + c) * (b + d);
    if product == 0.0 {
        return 0.0;
    }
    let (surplus, half) = (a * d - b * c, 0.5 * (a + b + c + d));
    let surplus = if surplus > 0.0 { (surplus - half).max(0.0) } else { surplus };
    surplus / product.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(both: usize, first: usize, second: usize, neither: usize) -> Estimate {
        paired_difference(Solved { both, first, second, neither }, 0.05).unwrap()
    }

    #[track_caller]
    fn assert_interval(found: Estimate, low: f64, high: f64) {
        assert!((found.low - low).abs() < 5e-5 && (found.high - high).abs() < 5e-5, "{found:?}");
    }

    #[test]
    fn values_of_another_program() {
        // The formulas of method 10 written anew in Python, with the standard library's `NormalDist`.
        assert_interval(of(36, 12, 2, 0), 0.0569, 0.3404);
        assert_interval(of(54, 0, 0, 0), -0.0664, 0.0664);
        assert_interval(of(20, 12, 2, 16), 0.0562, 0.3292);
    }

    #[test]
    fn sides_mirror() {
        let (found, mirror) = (of(5, 7, 2, 6), of(5, 2, 7, 6));
        assert!((found.value + mirror.value).abs() < 1e-15 && (found.low + mirror.high).abs() < 1e-15);
        assert_eq!(paired_difference(Solved::default(), 0.05), None);
    }
}
