//! A variant against the baseline, seed by seed.

use super::{Estimate, SignedRank, hodges_lehmann, mcnemar};
use serde::Serialize;

/// How a variant did against the baseline on the same seeds.
///
/// Times are compared where both sides solved the problem; where one side alone did, there is no ratio, and
/// the pair is counted for the test of solving instead. So "faster" speaks of problems that both can solve,
/// and is to be read beside the other figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Paired {
    /// Seeds that both sides solved.
    pub both: usize,
    /// Seeds that the baseline alone solved.
    pub only_baseline: usize,
    /// Seeds that the variant alone solved.
    pub only_variant: usize,
    /// Seeds that neither solved.
    pub neither: usize,
    /// p-value of McNemar's exact test: whether one side solves more.
    pub solved_p: f64,
    /// Ratio of times, variant to baseline (Hodges-Lehmann on the logarithms); `None` where no seed was
    /// solved by both.
    pub ratio: Option<Estimate>,
    /// The signed-rank test on the logarithms of the ratios.
    pub time_test: SignedRank,
    /// Matched-pairs rank-biserial correlation: -1 where the variant was always faster, 1 where it was always
    /// slower.
    pub effect: f64,
}

impl Paired {
    /// Compares times of planning (s, positive; `None` where the problem was not solved), one pair a seed:
    /// baseline first.
    pub fn of(pairs: &[(Option<f64>, Option<f64>)]) -> Self {
        let count = |baseline: bool, variant: bool| {
            pairs.iter().filter(|(a, b)| (a.is_some(), b.is_some()) == (baseline, variant)).count()
        };
        let logs: Vec<f64> = pairs.iter().filter_map(|&(a, b)| Some(log_ratio(b?, a?))).collect();
        let (only_baseline, only_variant) = (count(true, false), count(false, true));
        let time_test = SignedRank::of(&logs);
        Self {
            both: count(true, true),
            only_baseline,
            only_variant,
            neither: count(false, false),
            solved_p: mcnemar(only_baseline, only_variant),
            ratio: hodges_lehmann(&logs).map(|log| log.map(f64::exp)),
            effect: time_test.rank_biserial(),
            time_test,
        }
    }
}

/// ln(a/b). No run takes no time; a clock too coarse to see one counts as a nanosecond.
fn log_ratio(a: f64, b: f64) -> f64 {
    (a.max(1e-9) / b.max(1e-9)).ln()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn twice_as_fast_is_found() {
        let pairs: Vec<_> = (1..=12).map(|k| (Some(f64::from(k)), Some(f64::from(k) / 2.0))).collect();
        let found = Paired::of(&pairs);
        let ratio = found.ratio.unwrap();
        assert!((ratio.value - 0.5).abs() < 1e-12 && ratio.high < 0.500_001, "{ratio:?}");
        assert_eq!((found.effect, found.both), (-1.0, 12));
        assert!((found.time_test.p_value - 2.0 / 4096.0).abs() < 1e-12);
        assert_eq!(found.solved_p, 1.0);
    }

    #[test]
    fn unsolved_runs_are_counted_apart() {
        let mut pairs = vec![(Some(1.0), None); 8];
        pairs.extend([(None, Some(1.0)), (None, None), (Some(1.0), Some(3.0))]);
        let found = Paired::of(&pairs);
        assert_eq!((found.both, found.only_baseline, found.only_variant, found.neither), (1, 8, 1, 1));
        // 2 · (C(9,0) + C(9,1)) / 2⁹
        assert!((found.solved_p - 20.0 / 512.0).abs() < 1e-12);
        assert!((found.ratio.unwrap().value - 3.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_in_common_gives_no_ratio() {
        let found = Paired::of(&[(Some(1.0), None)]);
        assert_eq!((found.ratio, found.time_test.p_value, found.effect), (None, 1.0, 0.0));
    }

    proptest! {
        #[test]
        fn swapping_sides_inverts_the_ratio(pairs in prop::collection::vec((prop::option::of(0.1..9.0_f64), prop::option::of(0.1..9.0_f64)), 1..50)) {
            let swapped: Vec<_> = pairs.iter().map(|&(a, b)| (b, a)).collect();
            let (found, mirror) = (Paired::of(&pairs), Paired::of(&swapped));
            prop_assert_eq!(found.solved_p, mirror.solved_p);
            prop_assert!((found.time_test.p_value - mirror.time_test.p_value).abs() < 1e-12);
            if let (Some(found), Some(mirror)) = (found.ratio, mirror.ratio) {
                prop_assert!((found.value * mirror.value - 1.0).abs() < 1e-9);
                prop_assert!(found.high.is_infinite() || (found.high * mirror.low - 1.0).abs() < 1e-9);
            }
        }
    }
}
