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

    proptest! {
        #[test]
        fn never_kinder_than_alone_nor_harder_than_bonferroni(p in prop::collection::vec(0.0..1.0_f64, 1..12)) {
            for (corrected, alone) in holm(&p).into_iter().zip(&p) {
                prop_assert!(*alone <= corrected && corrected <= (alone * p.len() as f64).min(1.0));
            }
        }
    }
}
