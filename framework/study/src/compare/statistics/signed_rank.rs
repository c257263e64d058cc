//! Whether paired differences lie on one side of zero.

use super::normal::upper_tail;
use serde::Serialize;

/// Up to this many differences the distribution is summed exactly.
const EXACT: usize = 60;

/// What the signed-rank test finds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SignedRank {
    /// How many differences are not zero; the others are left out, as Wilcoxon does.
    pub pairs: usize,
    /// Sum of the ranks of the positive differences.
    pub positive: f64,
    /// Sum of the ranks of the negative differences.
    pub negative: f64,
    /// Two-sided p-value: how likely sums as unequal as these are if either sign is as likely for every
    /// difference.
    pub p_value: f64,
}

impl SignedRank {
    /// Tests paired differences (finite, any order): F. Wilcoxon, "Individual comparisons by ranking
    /// methods", Biometrics Bulletin 1945.
    ///
    /// Equal magnitudes share their mean rank. Up to 60 pairs the p-value is exact, ties included (all 2ⁿ
    /// signs are counted, by a sum over ranks); beyond, it comes from the normal distribution with the
    /// corrections for ties and continuity.
    pub fn of(differences: &[f64]) -> Self {
        let mut differences: Vec<f64> = differences.iter().copied().filter(|&d| d != 0.0).collect();
        differences.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        let ranks = double_ranks(&differences);
        let sum = |is_wanted: fn(f64) -> bool| {
            let wanted = differences.iter().zip(&ranks).filter(|(d, _)| is_wanted(**d));
            wanted.map(|(_, rank)| rank).sum::<usize>()
        };
        let (positive, negative) = (sum(|d| d > 0.0), sum(|d| d < 0.0));
        let p_value = match differences.len() {
            0 => 1.0,
            n if n <= EXACT => exact(&ranks, positive.min(negative)),
            _ => approximate(&ranks, positive.min(negative)),
        };
        let [positive, negative] = [positive, negative].map(|doubled| doubled as f64 / 2.0);
        Self { pairs: differences.len(), positive, negative, p_value }
    }

    /// The matched-pairs rank-biserial correlation, -1..=1: the share of rank sums that is positive less the
    /// share that is negative.
    ///
    /// D. S. Kerby, "The simple difference formula", Comprehensive Psychology 2014. 0 for no pairs.
    pub fn rank_biserial(&self) -> f64 {
        match self.positive + self.negative {
            0.0 => 0.0,
            all => (self.positive - self.negative) / all,
        }
    }
}

/// Twice the rank of each magnitude (a mean rank may be half an integer), for differences in rising order of
/// magnitude.
fn double_ranks(differences: &[f64]) -> Vec<usize> {
    let same = |a: &f64, b: &f64| a.abs() == b.abs();
    let mut ranks = Vec::with_capacity(differences.len());
    for group in differences.chunk_by(same) {
        let before = ranks.len();
        ranks.extend(group.iter().map(|_| 2 * before + group.len() + 1));
    }
    ranks
}

/// The p-value with every choice of signs counted; `smaller` is the smaller sum of doubled ranks.
fn exact(ranks: &[usize], smaller: usize) -> f64 {
    let chances = distribution(ranks);
    (2.0 * chances[..=smaller].iter().sum::<f64>()).min(1.0)
}

/// How likely each sum of the given ranks is when a fair coin decides which ranks count.
pub(super) fn distribution(ranks: &[usize]) -> Vec<f64> {
    let mut chances = vec![0.0; ranks.iter().sum::<usize>() + 1];
    chances[0] = 1.0;
    let mut highest = 0;
    for &rank in ranks {
        highest += rank;
        for sum in (0..=highest).rev() {
            let with = if sum >= rank { chances[sum - rank] } else { 0.0 };
            chances[sum] = 0.5 * (chances[sum] + with);
        }
    }
    chances
}

/// The p-value by the normal approximation. The variance Σ rank²/4 of the actual ranks *is* the one corrected
/// for ties.
fn approximate(ranks: &[usize], smaller: usize) -> f64 {
    let mean = ranks.iter().sum::<usize>() as f64 / 4.0;
    let deviation = ranks.iter().map(|&rank| (rank as f64 / 4.0).powi(2)).sum::<f64>().sqrt();
    let away = (mean - smaller as f64 / 2.0 - 0.5).max(0.0);
    2.0 * upper_tail(away / deviation)
}

#[cfg(test)]
mod tests {
    use super::super::DEPRESSION;
    use super::*;
    use proptest::prelude::*;

    fn assert_p(differences: &[f64], expected: f64, tolerance: f64) {
        let found = SignedRank::of(differences);
        assert!((found.p_value / expected - 1.0).abs() < tolerance, "{found:?}, expected {expected}");
    }

    /// C. Darwin's plants, crossed less self-fertilised, in eighths of an inch (R. A. Fisher, "The Design of
    /// Experiments", 1935).
    const DARWIN: [f64; 15] =
        [49.0, -67.0, 8.0, 16.0, 6.0, 23.0, 28.0, 41.0, 14.0, 29.0, 56.0, 24.0, 75.0, 60.0, -48.0];

    #[test]
    fn a_published_example() {
        // M. Hollander, D. A. Wolfe, "Nonparametric Statistical Methods", 1973, p. 29: depression scale
        // factors of nine patients, T+ = 40 (R's help page of `wilcox.test` has it): one-sided p = 0.01953,
        // so that the two-sided one is 0.03906.
        let found = SignedRank::of(&DEPRESSION);
        assert_eq!((found.positive, found.negative, found.pairs), (40.0, 5.0, 9));
        assert_p(&DEPRESSION, 0.039_062_5, 1e-12);
        assert!((found.rank_biserial() - 35.0 / 45.0).abs() < 1e-12);
    }

    #[test]
    fn values_of_scipy() {
        // scipy 1.17.1: scipy.stats.wilcoxon(DARWIN, method="exact").
        assert_eq!(SignedRank::of(&DARWIN).negative, 24.0);
        assert_p(&DARWIN, 0.041_259_765_625, 1e-12);
        // Ties: scipy.stats.wilcoxon(d, method=scipy.stats.PermutationMethod(n_resamples=numpy.inf)) counts
        // all 2¹⁰ signs.
        assert_p(&[1.0, 1.0, -1.0, 2.0, 2.0, 2.0, -3.0, 4.0, 5.0, 5.0], 0.066_406_25, 1e-12);
        // 80 differences with ties: scipy.stats.wilcoxon(d, method="approx", correction=True).
        let many: Vec<f64> = (0..80).map(|k| f64::from((k * 37) % 23) - 8.5).collect();
        assert_p(&many, 0.006_543_055_825_302_372, 1e-10);
    }

    #[test]
    fn no_difference_is_no_evidence() {
        let found = SignedRank::of(&[0.0, 0.0]);
        assert_eq!((found.pairs, found.p_value, found.rank_biserial()), (0, 1.0, 0.0));
    }

    proptest! {
        #[test]
        fn signs_mirror_and_scale_does_not_matter(d in prop::collection::vec(-9_i32..9, 0..90)) {
            let of = |factor: f64| SignedRank::of(&d.iter().map(|&d| factor * f64::from(d)).collect::<Vec<_>>());
            let (plain, doubled, mirrored) = (of(1.0), of(2.0), of(-1.0));
            prop_assert_eq!(plain, doubled);
            prop_assert_eq!((plain.positive, plain.p_value), (mirrored.negative, mirrored.p_value));
            prop_assert!((0.0..=1.0).contains(&plain.p_value));
            let n = plain.pairs as f64;
            prop_assert_eq!(plain.positive + plain.negative, n * (n + 1.0) / 2.0);
        }

        #[test]
        fn the_approximation_meets_the_exact_value(d in prop::collection::vec(-1.0..1.3_f64, 40..60)) {
            let mut sizes = d.clone();
            sizes.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
            let ranks = double_ranks(&sizes);
            let found = SignedRank::of(&d);
            let smaller = (2.0 * found.positive.min(found.negative)) as usize;
            prop_assert!((approximate(&ranks, smaller) - found.p_value).abs() < 0.01);
        }
    }
}
