//! How large paired differences are.

use super::normal::upper_point;
use super::signed_rank::distribution;
use super::{ALPHA, Estimate, sorted};

/// Up to this many differences the interval is read from the exact distribution.
const EXACT: usize = 60;

/// The Hodges-Lehmann estimate of the middle of paired differences: the median of the means of all pairs of
/// them, each with itself too (the Walsh averages); `None` for no differences. An end of the interval is
/// infinite where 5 or fewer differences can prove nothing.
///
/// J. L. Hodges, E. L. Lehmann, "Estimates of location based on rank tests", Annals of Mathematical
/// Statistics 1963. The interval holds those shifts that the signed-rank test would not refuse (J. W.
/// Tukey's; M. Hollander, D. A. Wolfe, "Nonparametric Statistical Methods", 1973, 3.3).
pub fn hodges_lehmann(differences: &[f64]) -> Option<Estimate> {
    hodges_lehmann_at(differences, ALPHA)
}

/// The same with an interval that misses the true value with probability `alpha` (above 0, below 1) instead
/// of 0.05.
pub fn hodges_lehmann_at(differences: &[f64], alpha: f64) -> Option<Estimate> {
    let values = sorted(differences.iter().copied());
    let n = values.len();
    let averages = n * (n + 1) / 2;
    let last = averages.checked_sub(1)?;
    let value = 0.5 * (walsh(&values, last / 2) + walsh(&values, last.div_ceil(2)));
    let (low, high) = match skipped(n, alpha) {
        Some(k) => (walsh(&values, k), walsh(&values, last - k)),
        None => (f64::NEG_INFINITY, f64::INFINITY),
    };
    // Rounding must not put an end on the wrong side of the value.
    Some(Estimate { value, low: low.min(value), high: high.max(value) })
}

/// How many of the ordered averages lie outside of the interval on each side; `None` if even all of them do
/// not reach the confidence 1 - `alpha`.
fn skipped(n: usize, alpha: f64) -> Option<usize> {
    if n > EXACT {
        let n = n as f64;
        let (mean, deviation) = (n * (n + 1.0) / 4.0, (n * (n + 1.0) * (2.0 * n + 1.0) / 24.0).sqrt());
        let place = (mean - upper_point(alpha / 2.0) * deviation - 0.5).floor();
        return (place >= 0.0).then_some(place as usize);
    }
    let ranks: Vec<usize> = (1..=n).collect();
    let mut tail = 0.0;
    let mut is_rare = |chance: &f64| {
        tail += chance;
        tail <= alpha / 2.0
    };
    distribution(&ranks).iter().take_while(|chance| is_rare(chance)).count().checked_sub(1)
}

/// The Walsh average of rank `k` (from 0) of values in rising order, by bisection: all of them would be n²/2
/// numbers.
fn walsh(values: &[f64], k: usize) -> f64 {
    let (mut low, mut high) = (values[0], values[values.len() - 1]);
    // Each step halves what is left; after 100 nothing is.
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if count_up_to(values, middle) > k { high = middle } else { low = middle }
    }
    high
}

/// How many Walsh averages are at most `limit`: as the first of a pair grows, its last partner shrinks.
fn count_up_to(values: &[f64], limit: f64) -> usize {
    let mut end = values.len();
    let mut count = 0;
    for (i, first) in values.iter().enumerate() {
        while end > i && 0.5 * (first + values[end - 1]) > limit {
            end -= 1;
        }
        count += end.saturating_sub(i);
    }
    count
}

#[cfg(test)]
mod tests {
    use super::super::DEPRESSION;
    use super::*;
    use proptest::prelude::*;

    /// All of them, the slow and obvious way.
    fn walsh_averages(values: &[f64]) -> Vec<f64> {
        sorted(
            (0..values.len())
                .flat_map(|i| (i..values.len()).map(move |j| (i, j)))
                .map(|(i, j)| 0.5 * (values[i] + values[j])),
        )
    }

    #[test]
    fn a_published_example() {
        // Hollander & Wolfe 1973, example 3.1: estimate 0.46 and, by R's `wilcox.test(conf.int = TRUE)`, 95 %
        // interval (0.010, 0.786).
        let found = hodges_lehmann(&DEPRESSION).unwrap();
        assert!((found.value - 0.46).abs() < 1e-9, "{found:?}");
        assert!((found.low - 0.01).abs() < 1e-9 && (found.high - 0.786).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn few_differences_prove_nothing() {
        let found = hodges_lehmann(&[1.0, 2.0, 3.0, 4.0, 5.0]).unwrap();
        assert_eq!((found.value, found.low, found.high), (3.0, f64::NEG_INFINITY, f64::INFINITY));
        // Six that agree are just enough: 2/2⁶ < 0.05.
        assert_eq!(hodges_lehmann(&[1.0; 6]), Some(Estimate { value: 1.0, low: 1.0, high: 1.0 }));
        assert_eq!(hodges_lehmann(&[]), None);
    }

    proptest! {
        #[test]
        fn bisection_finds_the_averages(values in prop::collection::vec(-5.0..5.0_f64, 1..25), share in 0.0..1.0_f64) {
            let all = walsh_averages(&values);
            let k = (share * all.len() as f64) as usize;
            prop_assert!((walsh(&sorted(values), k) - all[k]).abs() < 1e-12);
        }

        #[test]
        fn shifts_carry_over_and_the_test_agrees(values in prop::collection::vec(-5.0..5.0_f64, 7..80), shift in -3.0..3.0_f64) {
            let found = hodges_lehmann(&values).unwrap();
            let shifted = hodges_lehmann(&values.iter().map(|value| value + shift).collect::<Vec<_>>()).unwrap();
            prop_assert!((found.low + shift - shifted.low).abs() < 1e-9 && (found.value + shift - shifted.value).abs() < 1e-9);
            // What lies well inside is not refused by the signed-rank test, what lies outside is (up to 60
            // values both are exact).
            let p = |at: f64| super::super::SignedRank::of(&values.iter().map(|v| v - at).collect::<Vec<_>>()).p_value;
            if values.len() <= EXACT {
                prop_assert!(p(found.low - 1e-6) <= ALPHA && p(found.high + 1e-6) <= ALPHA);
                prop_assert!(p(found.low + 1e-6) > ALPHA || found.low + 1e-6 > found.high);
            }
        }
    }
}
