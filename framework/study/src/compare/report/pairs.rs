//! Every variant against every other.

use crate::compare::Cell;
use crate::compare::statistics::{ALPHA, Estimate, Paired, holm};
use serde::Serialize;

/// Two variants on one scenario.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// Index of the first variant.
    pub a: usize,
    /// Index of the second variant, larger than the first.
    pub b: usize,
    /// Time of the first divided by that of the second, where both solved; interval not corrected.
    pub ratio: Option<Estimate>,
    /// p-value of the times, corrected (Holm) for all pairs of the scenario.
    pub time_p: f64,
    /// p-value of the numbers of solved runs, corrected likewise.
    pub solved_p: f64,
    /// How many seeds both solved.
    pub both: usize,
    /// How many seeds the first alone solved, and the second alone.
    pub only: [usize; 2],
}

impl Pair {
    /// Whether the two are shown to differ, in time or in what they solve.
    pub fn differs(&self) -> bool {
        self.time_p < ALPHA || self.solved_p < ALPHA
    }
}

/// All pairs of a scenario's variants.
pub fn pairs(row: &[Cell<'_>]) -> Vec<Pair> {
    let indices = (0..row.len()).flat_map(|a| (a + 1..row.len()).map(move |b| (a, b)));
    let compared: Vec<(usize, usize, Paired)> =
        indices.map(|(a, b)| (a, b, row[a].against(&row[b]))).collect();
    let time_p = holm(&compared.iter().map(|(_, _, paired)| paired.time_test.p_value).collect::<Vec<_>>());
    let solved_p = holm(&compared.iter().map(|(_, _, paired)| paired.solved_p).collect::<Vec<_>>());
    let pair = |((k, l, paired), (time_p, solved_p)): (&(usize, usize, Paired), (f64, f64))| Pair {
        a: row[*k].index,
        b: row[*l].index,
        // An end that is not known (too few pairs) has no number in JSON: then there is no interval to show,
        // and no ratio either.
        ratio: paired.ratio.filter(|ratio| ratio.high.is_finite()),
        time_p,
        solved_p,
        both: paired.both,
        only: [paired.only_variant, paired.only_baseline],
    };
    compared.iter().zip(time_p.into_iter().zip(solved_p)).map(pair).collect()
}

/// The variants that may be called best: the one with the smallest median over all runs, and those not shown
/// to differ from it. Indices of variants in their order, the best one first.
pub fn best(row: &[Cell<'_>], pairs: &[Pair]) -> Vec<usize> {
    let solvers = row.iter().filter(|cell| cell.median_of_all_s().is_finite());
    let Some(first) = solvers.clone().min_by(|a, b| a.median_of_all_s().total_cmp(&b.median_of_all_s()))
    else {
        return Vec::new();
    };
    let differs = |other: usize| {
        let ends = (first.index.min(other), first.index.max(other));
        pairs.iter().any(|pair| (pair.a, pair.b) == ends && pair.differs())
    };
    let equals = solvers.map(|cell| cell.index).filter(|&other| other != first.index && !differs(other));
    std::iter::once(first.index).chain(equals).collect()
}
