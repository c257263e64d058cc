//! Many tests at once.

/// The p-values corrected for their number, in the given order (S. Holm, "A simple sequentially rejective
/// multiple test procedure", Scandinavian Journal of Statistics 1979): calling all below 0.05 a difference is
/// wrong anywhere in at most 5 % of studies.
pub fn holm(p_values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p_values.len()).collect();
    order.sort_by(|&a, &b| p_values[a].total_cmp(&p_values[b]));
    let mut corrected = vec![0.0; p_values.len()];
    let mut least: f64 = 0.0;
    for (rank, &k) in order.iter().enumerate() {
        least = least.max((p_values.len() - rank) as f64 * p_values[k]).min(1.0);
        corrected[k] = least;
    }
    corrected
}

/// The level at which Holm's method meets each p-value, in the given order: `alpha` over the number of those
/// that are not yet refused. Those that are not refused all meet the level of the first of them.
///
/// An interval of a hypothesis at its level leaves out zero exactly where the hypothesis is refused. `others`
/// more hypotheses that cannot be refused share the level of those that are not.
pub fn holm_levels(p_values: &[f64], others: usize, alpha: f64) -> (Vec<f64>, f64) {
    let mut order: Vec<usize> = (0..p_values.len()).collect();
    order.sort_by(|&a, &b| p_values[a].total_cmp(&p_values[b]));
    let level = |rank: usize| alpha / (p_values.len() - rank) as f64;
    let refused = order.iter().enumerate().take_while(|(rank, k)| p_values[**k] < level(*rank)).count();
    let rest = alpha / (p_values.len() - refused + others).max(1) as f64;
    let mut levels = vec![rest; p_values.len()];
    order.iter().take(refused).enumerate().for_each(|(rank, &k)| levels[k] = level(rank));
    (levels, rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_worked_example() {
        // R 4.x, help page of `p.adjust`'s method "holm" by hand: 4 × 0.005, 3 × 0.011, 2 × 0.02, then the
        // larger of 0.04 and 1 × 0.04.
        let found = holm(&[0.02, 0.005, 0.04, 0.011]);
        for (found, expected) in found.iter().zip([0.04, 0.02, 0.04, 0.033]) {
            assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
        }
        assert!(holm(&[]).is_empty());
        assert_eq!(holm(&[0.7, 0.9]), [1.0, 1.0]);
    }

    #[test]
    fn levels_are_those_of_the_steps() {
        // 4 × 0.005 and 3 × 0.011 are below 0.05, 2 × 0.03 is not: the rest meets 0.05 / (2 + 1 other).
        let (levels, rest) = holm_levels(&[0.03, 0.005, 0.04, 0.011], 1, 0.05);
        assert_eq!(levels, [0.05 / 3.0, 0.0125, 0.05 / 3.0, 0.05 / 3.0]);
        assert_eq!(rest, 0.05 / 3.0);
        assert_eq!(holm_levels(&[], 0, 0.05), (Vec::new(), 0.05));
    }

    proptest! {
        #[test]
        fn refused_below_its_level_and_nowhere_else(
            p in prop::collection::vec(0.0..0.1_f64, 1..12),
            others in 0_usize..5,
        ) {
            let (levels, _) = holm_levels(&p, others, 0.05);
            for ((corrected, alone), level) in holm(&p).into_iter().zip(&p).zip(levels) {
                prop_assert_eq!(corrected < 0.05, *alone < level);
            }
        }

        #[test]
        fn never_kinder_than_alone_nor_harder_than_bonferroni(
            p in prop::collection::vec(0.0..1.0_f64, 1..12),
        ) {
            for (corrected, alone) in holm(&p).into_iter().zip(&p) {
                prop_assert!(*alone <= corrected && corrected <= (alone * p.len() as f64).min(1.0));
            }
        }
    }
}
