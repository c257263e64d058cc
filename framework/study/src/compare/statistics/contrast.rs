//! Paired differences, tested and measured so that both say the same.

use super::{Estimate, SignedRank, Solved, hodges_lehmann_at, mcnemar, paired_difference};

/// Paired differences of one figure, seed by seed: first less second.
#[derive(Clone, Debug, PartialEq)]
pub enum Contrast {
    /// Of numbers: Wilcoxon's signed-rank test, and the estimate of Hodges and Lehmann.
    Numbers(Vec<f64>),
    /// Of solved runs: McNemar's exact test, and Newcombe's interval of the difference of shares.
    Shares(Solved),
}

impl Contrast {
    /// How many pairs there are.
    pub fn pairs(&self) -> usize {
        match self {
            Self::Numbers(differences) => differences.len(),
            Self::Shares(Solved { both, first, second, neither }) => both + first + second + neither,
        }
    }

    /// In how many pairs the first has more, and in how many it has less.
    pub fn sides(&self) -> [usize; 2] {
        match self {
            Self::Numbers(all) => {
                [all.iter().filter(|d| **d > 0.0).count(), all.iter().filter(|d| **d < 0.0).count()]
            }
            Self::Shares(solved) => [solved.first, solved.second],
        }
    }

    /// The largest size of a difference.
    fn largest(&self) -> f64 {
        match self {
            Self::Numbers(all) => all.iter().fold(0.0, |most, difference| difference.abs().max(most)),
            Self::Shares(_) => 1.0,
        }
    }

    /// The p-value, two-sided, as if this were the only test.
    pub fn p_value(&self) -> f64 {
        match self {
            Self::Numbers(differences) => SignedRank::of(differences).p_value,
            Self::Shares(solved) => mcnemar(solved.first, solved.second),
        }
    }

    /// Which side the test leans to: above 0 where the first has more.
    pub fn leaning(&self) -> f64 {
        match self {
            Self::Numbers(differences) => SignedRank::of(differences).rank_biserial(),
            Self::Shares(solved) => solved.first as f64 - solved.second as f64,
        }
    }

    /// Whether the test could come out below `alpha`, whatever the signs of these differences are: else it
    /// needs no place among those that are corrected for (R. E. Tarone, "A modified Bonferroni method for
    /// discrete data", Biometrics 1990).
    pub fn can_show(&self, alpha: f64) -> bool {
        let [more, less] = self.sides();
        2.0 * 0.5_f64.powi((more + less).min(1000) as i32) < alpha
    }

    /// The difference with an interval that misses it with probability `alpha`, made to agree with the test:
    /// zero lies strictly inside exactly where the test at that level does not refuse it, or at an end.
    ///
    /// Test and interval treat ties and zeros differently, so that without this they could differ by a rank.
    /// `None` for no pairs.
    pub fn estimate(&self, alpha: f64) -> Option<Estimate> {
        let found = match self {
            Self::Numbers(differences) => hodges_lehmann_at(differences, alpha)?,
            Self::Shares(solved) => paired_difference(*solved, alpha)?,
        };
        // Bisection ends beside a zero, not on it.
        let size = self.largest();
        let Estimate { value, low, high } = found.map(|x| if x.abs() <= 1e-12 * size { 0.0 } else { x });
        if self.p_value() >= alpha {
            return Some(Estimate { value, low: low.min(0.0), high: high.max(0.0) });
        }
        Some(match self.leaning() > 0.0 {
            true => Estimate { value: value.max(0.0), low: low.max(0.0), high: high.max(0.0) },
            false => Estimate { value: value.min(0.0), low: low.min(0.0), high: high.min(0.0) },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn shares_are_tested_as_numbers_are() {
        // McNemar's exact test is the signed-rank test of zeros and ones.
        let solved = Solved { both: 3, first: 9, second: 1, neither: 2 };
        let numbers: Vec<f64> =
            [(3 + 2, 0.0), (9, 1.0), (1, -1.0)].into_iter().flat_map(|(n, d)| vec![d; n]).collect();
        let (shares, numbers) = (Contrast::Shares(solved), Contrast::Numbers(numbers));
        assert!((shares.p_value() - numbers.p_value()).abs() < 1e-12);
        assert_eq!((shares.pairs(), shares.sides()), (numbers.pairs(), numbers.sides()));
    }

    #[test]
    fn no_difference_at_the_middle_is_exactly_none() {
        let contrast = Contrast::Numbers([[1.0; 4], [0.0; 4], [-1.0; 4]].concat());
        assert_eq!(contrast.estimate(0.05).unwrap().value, 0.0);
    }

    #[test]
    fn what_cannot_show_is_known_beforehand() {
        let of = |n: usize| Contrast::Numbers([vec![1.0; n], vec![0.0; 9]].concat());
        assert!(!of(0).can_show(0.05) && !of(5).can_show(0.05) && of(6).can_show(0.05));
    }

    proptest! {
        #[test]
        fn test_and_interval_agree(d in prop::collection::vec(-3_i32..5, 1..80), tests in 1_u32..40) {
            let alpha = 0.05 / f64::from(tests);
            let contrast = Contrast::Numbers(d.into_iter().map(f64::from).collect());
            let Estimate { value, low, high } = contrast.estimate(alpha).unwrap();
            prop_assert!(low <= value && value <= high);
            match contrast.p_value() < alpha {
                true if contrast.leaning() > 0.0 => prop_assert!(low >= 0.0),
                true => prop_assert!(high <= 0.0 && contrast.leaning() < 0.0),
                false => prop_assert!(low <= 0.0 && high >= 0.0),
            }
        }
    }
}
