//! Whether one side solves what the other does not.

/// The two-sided p-value of McNemar's test in its exact form, from the pairs that only one side solved.
///
/// Q. McNemar, "Note on the sampling error of the difference between correlated proportions or percentages",
/// Psychometrika 1947; exact: a fair coin decides each such pair. 1 where there is none. Cost: the smaller
/// count.
pub fn mcnemar(only_baseline: usize, only_variant: usize) -> f64 {
    let pairs = only_baseline + only_variant;
    // The logarithm of C(n, k) / 2ⁿ: the number itself underflows beyond a thousand pairs.
    let mut log_chance = -(pairs as f64) * std::f64::consts::LN_2;
    let mut tail = log_chance.exp();
    for k in 1..=only_baseline.min(only_variant) {
        log_chance += ((pairs - k + 1) as f64 / k as f64).ln();
        tail += log_chance.exp();
    }
    (2.0 * tail).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_scipy() {
        // scipy 1.17.1: scipy.stats.binomtest(k, n, 0.5).pvalue.
        let table = [
            (0, 5, 0.0625),
            (1, 9, 0.039_062_5),
            (3, 20, 0.002_576_828_002_929_687_5),
            (40, 100, 0.056_887_933_640_980_89),
            (1400, 3000, 0.000_278_563_961_039_233_66),
        ];
        for (k, n, expected) in table {
            assert!((mcnemar(k, n - k) / expected - 1.0).abs() < 1e-9, "{k} of {n}: {}", mcnemar(k, n - k));
            assert_eq!(mcnemar(k, n - k), mcnemar(n - k, k));
        }
    }

    #[test]
    fn equal_counts_show_nothing() {
        assert_eq!(mcnemar(0, 0), 1.0);
        assert_eq!(mcnemar(7, 7), 1.0);
    }
}
