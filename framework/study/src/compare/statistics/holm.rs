//! Many tests at once.

/// The p-values corrected for their number, in the given order (S. Holm, "A simple sequentially rejective
/// multiple test procedure", Scandinavian Journal of Statistics 1979, section 4: with weights): calling all
/// below 0.05 a difference is wrong anywhere in at most 5 % of studies.
///
/// Each is a p-value and its weight, above 0: the share of the level that it gets before the others are
/// known.
pub fn holm(tests: &[(f64, f64)]) -> Vec<f64> {
    let mut left: f64 = tests.iter().map(|(_, weight)| weight).sum();
    let mut corrected = vec![0.0; tests.len()];
    let mut least: f64 = 0.0;
    for k in most_telling_first(tests) {
        let (p, weight) = tests[k];
        // Rounding leaves the last weight a little too small.
        least = least.max(p * (left / weight).max(1.0)).min(1.0);
        corrected[k] = least;
        left -= weight;
    }
    corrected
}

/// The level at which Holm's method meets each test, in the given order: `alpha` times its share of the
/// weights of those that are not yet refused. Those that are not refused share the level of the first of
/// them.
///
/// An interval of a hypothesis at its level leaves out zero exactly where the hypothesis is refused. More
/// hypotheses that cannot be refused, with these `others` as their weights' sum, share the level of those
/// that are not. The second result is that level for a weight of 1.
pub fn holm_levels(tests: &[(f64, f64)], others: f64, alpha: f64) -> (Vec<f64>, f64) {
    let mut left: f64 = tests.iter().map(|(_, weight)| weight).sum();
    let mut levels = vec![None; tests.len()];
    for k in most_telling_first(tests) {
        let (p, weight) = tests[k];
        let level = alpha * (weight / left).min(1.0);
        if p >= level {
            break;
        }
        levels[k] = Some(level);
        left -= weight;
    }
    let open = levels.iter().zip(tests).filter(|(level, _)| level.is_none());
    let open: f64 = open.map(|(_, (_, weight))| weight).sum::<f64>() + others;
    let unit = if open > 0.0 { alpha / open } else { alpha };
    let level = |(level, (_, weight)): (Option<f64>, &(f64, f64))| level.unwrap_or(unit * weight);
    (levels.into_iter().zip(tests).map(level).collect(), unit)
}

/// The tests in the order in which Holm's method meets them.
fn most_telling_first(tests: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..tests.len()).collect();
    let telling = |k: usize| tests[k].0 / tests[k].1;
    order.sort_by(|&a, &b| telling(a).total_cmp(&telling(b)));
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn alike(p: &[f64]) -> Vec<(f64, f64)> {
        p.iter().map(|&p| (p, 1.0)).collect()
    }

    fn near(found: &[f64], expected: &[f64]) -> bool {
        found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn a_worked_example() {
        // R 4.x, help page of `p.adjust`'s method "holm" by hand: 4 × 0.005, 3 × 0.011, 2 × 0.02, then the
        // larger of 0.04 and 1 × 0.04.
        let found = holm(&alike(&[0.02, 0.005, 0.04, 0.011]));
        assert!(near(&found, &[0.04, 0.02, 0.04, 0.033]), "{found:?}");
        assert!(holm(&[]).is_empty());
        assert_eq!(holm(&alike(&[0.7, 0.9])), [1.0, 1.0]);
    }

    #[test]
    fn a_worked_example_with_weights() {
        // 0.03 ÷ 3 comes first: it gets 3 of 5 parts; then 0.012 with 1 of 2, then 0.2 with all that is left.
        let tests = [(0.012, 1.0), (0.03, 3.0), (0.2, 1.0)];
        assert!(near(&holm(&tests), &[0.05, 0.05, 0.2]));
        let (levels, unit) = holm_levels(&[(0.012, 1.0), (0.02, 3.0), (0.2, 1.0)], 0.0, 0.05);
        assert!(near(&levels, &[0.025, 0.03, 0.05]) && near(&[unit], &[0.05]), "{levels:?}");
    }

    #[test]
    fn levels_are_those_of_the_steps() {
        // 4 × 0.005 and 3 × 0.011 are below 0.05, 2 × 0.03 is not: the rest meets 0.05 / (2 + 1 other).
        let (levels, unit) = holm_levels(&alike(&[0.03, 0.005, 0.04, 0.011]), 1.0, 0.05);
        assert!(near(&levels, &[0.05 / 3.0, 0.0125, 0.05 / 3.0, 0.05 / 3.0]));
        assert!(near(&[unit], &[0.05 / 3.0]));
        assert_eq!(holm_levels(&[], 0.0, 0.05), (Vec::new(), 0.05));
    }

    proptest! {
        #[test]
        fn refused_below_its_level_and_nowhere_else(
            tests in prop::collection::vec((0.0..0.1_f64, 0.1..4.0_f64), 1..12),
            others in 0.0..5.0_f64,
        ) {
            let (levels, _) = holm_levels(&tests, others, 0.05);
            for ((corrected, (alone, _)), level) in holm(&tests).into_iter().zip(&tests).zip(levels) {
                prop_assert_eq!(corrected < 0.05, *alone < level);
            }
        }

        #[test]
        fn never_kinder_than_alone_nor_harder_than_bonferroni(
            tests in prop::collection::vec((0.0..1.0_f64, 0.1..4.0_f64), 1..12),
        ) {
            let all: f64 = tests.iter().map(|(_, weight)| weight).sum();
            for (corrected, (alone, weight)) in holm(&tests).into_iter().zip(&tests) {
                let bonferroni = (alone * all / weight).min(1.0);
                prop_assert!(*alone <= corrected + 1e-12 && corrected <= bonferroni + 1e-12);
            }
        }
    }
}
