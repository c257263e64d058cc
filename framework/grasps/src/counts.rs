//! What happened while grasps were looked for.

use regrasp_api::Reason;

/// Counts of draws, and of what became of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Poses of the object that were drawn.
    pub poses: u64,
    /// Poses at which enough fingers have contacts.
    pub reached: u64,
    /// Combinations of contacts that were tried, those drawn again at the same pose not counted.
    pub tried: u64,
    /// Grasps that are like another of their pose or an earlier one.
    pub twins: u64,
    /// Grasps beyond what is kept of one choice of facets.
    pub surplus: u64,
    /// Grasps that the verifier refused: faults of the program.
    pub refused: u64,
    reasons: [u64; Reason::ALL.len()],
}

impl Counts {
    /// How many numbers [`Counts::words`] gives.
    pub(crate) const WORDS: usize = 6 + Reason::ALL.len();

    /// Counts one pose or combination that was given up because of `reason`.
    pub(crate) fn reject(&mut self, reason: Reason) {
        self.reasons[reason as usize] += 1;
    }

    /// How often something was given up because of `reason`.
    pub fn rejections(&self, reason: Reason) -> u64 {
        self.reasons[reason as usize]
    }

    /// The causes with their counts, the most frequent first.
    pub fn causes(&self) -> Vec<(Reason, u64)> {
        let all = Reason::ALL.into_iter().map(|reason| (reason, self.rejections(reason)));
        let mut causes: Vec<_> = all.filter(|(_, count)| *count > 0).collect();
        causes.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        causes
    }

    /// Adds other counts.
    pub(crate) fn add(&mut self, other: &Self) {
        let sums = self.words().zip(other.words()).map(|(a, b)| a + b).collect::<Vec<_>>();
        *self = Self::of_words(&sums);
    }

    /// All counts in turn.
    pub(crate) fn words(&self) -> impl Iterator<Item = u64> {
        [self.poses, self.reached, self.tried, self.twins, self.surplus, self.refused]
            .into_iter()
            .chain(self.reasons)
    }

    /// From [`Counts::WORDS`] numbers.
    pub(crate) fn of_words(words: &[u64]) -> Self {
        let mut reasons = [0; Reason::ALL.len()];
        reasons.copy_from_slice(&words[6..Self::WORDS]);
        let &[poses, reached, tried, twins, surplus, refused, ..] = words else {
            return Self::default();
        };
        Self { poses, reached, tried, twins, surplus, refused, reasons }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_add_and_survive_as_words() {
        let mut counts = Counts { poses: 3, refused: 1, ..Counts::default() };
        counts.reject(Reason::Reach);
        counts.reject(Reason::Stability);
        let other = counts.clone();
        counts.add(&other);
        assert_eq!((counts.poses, counts.refused, counts.rejections(Reason::Reach)), (6, 2, 2));
        let words: Vec<u64> = counts.words().collect();
        assert_eq!(Counts::of_words(&words), counts);
        assert_eq!(counts.causes().len(), 2);
    }
}
