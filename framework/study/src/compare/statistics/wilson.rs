//! How sure a proportion is.

use super::Estimate;
use super::normal::Z_95;

/// The proportion `hits / runs` with its 95 % score interval; `None` for no runs. `hits` must not exceed
/// `runs`.
///
/// E. B. Wilson, "Probable inference, the law of succession, and statistical inference", JASA 1927. Unlike
/// the interval that textbooks give it is right for few runs and at 0 and 1, where a study of planners mostly
/// is.
pub fn wilson(hits: usize, runs: usize) -> Option<Estimate> {
    wilson_at(hits, runs, Z_95)
}

/// The same with an interval of `z` standard deviations on each side.
pub(super) fn wilson_at(hits: usize, runs: usize, z: f64) -> Option<Estimate> {
    if runs == 0 {
        return None;
    }
    let (n, p) = (runs as f64, hits as f64 / runs as f64);
    let z2 = z * z;
    let middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
    let half = z / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
    // Rounding must not put an end on the wrong side of the value.
    Some(Estimate { value: p, low: (middle - half).clamp(0.0, p), high: (middle + half).clamp(p, 1.0) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn assert_interval(hits: usize, runs: usize, low: f64, high: f64, digits: f64) {
        let found = wilson(hits, runs).unwrap();
        assert!((found.low - low).abs() < digits && (found.high - high).abs() < digits, "{found:?}");
    }

    #[test]
    fn published_examples() {
        // R. G. Newcombe, "Two-sided confidence intervals for the single proportion", Statistics in Medicine
        // 1998, Table I, method 3.
        assert_interval(81, 263, 0.2553, 0.3662, 5e-5);
        assert_interval(15, 148, 0.0624, 0.1605, 5e-5);
        assert_interval(0, 20, 0.0, 0.1611, 5e-5);
        assert_interval(1, 29, 0.0061, 0.1718, 5e-5);
    }

    #[test]
    fn values_of_scipy() {
        // scipy 1.17.1: scipy.stats.binomtest(k, n).proportion_ci(method="wilson").
        assert_interval(20, 20, 0.838_874_841_947_180_8, 1.0, 1e-12);
        assert_interval(97, 100, 0.915_480_635_709_472_4, 0.989_745_475_975_961_1, 1e-12);
    }

    #[test]
    fn nothing_is_known_of_no_runs() {
        assert_eq!(wilson(0, 0), None);
    }

    proptest! {
        #[test]
        fn failures_mirror_hits(runs in 1_usize..500, share in 0.0..=1.0) {
            let hits = (share * runs as f64) as usize;
            let (of_hits, of_failures) = (wilson(hits, runs).unwrap(), wilson(runs - hits, runs).unwrap());
            prop_assert!((of_hits.low - (1.0 - of_failures.high)).abs() < 1e-12);
            prop_assert!(of_hits.low <= of_hits.value && of_hits.value <= of_hits.high);
        }
    }
}
