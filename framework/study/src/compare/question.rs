//! What is asked about the variants of a scenario: pairs of them, and the effects of factors.

use super::statistics::{Contrast, Solved};
use super::{Cell, Figure, Measure, Pairs, RunRecord, Study};
use regrasp_api::Slot;
use std::collections::{BTreeMap, BTreeSet};

/// A question about a scenario; answered for every measure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Question {
    /// One variant against another: indices of variants.
    Pair {
        /// The variant.
        a: usize,
        /// What it is compared with.
        b: usize,
    },
    /// One level of a factor against the first variant's, the mean over all levels of the other factors.
    Effect {
        /// The factor.
        slot: Slot,
        /// The level.
        level: String,
        /// The first variant's level.
        base: String,
    },
    /// How much more one level of a factor does with a level of another factor than with the first
    /// variant's.
    Interaction {
        /// The factors.
        slots: [Slot; 2],
        /// A level of each.
        levels: [String; 2],
    },
    /// A variant against the variant of the same name in an older study.
    Older {
        /// Index of the variant.
        variant: usize,
    },
}

/// Weights of variants: their values, so weighed and summed, are the contrast of a seed.
pub(super) type Weights = Vec<(usize, f64)>;

/// The questions of one scenario's variants, each with its weights.
///
/// Effects and interactions are asked of a full factorial of two factors or more: contrasts of the runs with
/// one seed, which the signed-rank test and the estimate of Hodges and Lehmann then take as they take
/// differences of pairs (E. L. Lehmann, "Asymptotically nonparametric inference in some linear models with
/// one observation per cell", Annals of Mathematical Statistics 1964). Whatever makes a seed hard for all
/// variants cancels.
pub(super) fn questions(study: &Study, row: &[Cell<'_>]) -> Vec<(Question, Weights)> {
    let pair = |a: usize, b: usize| (Question::Pair { a, b }, vec![(a, 1.0), (b, -1.0)]);
    let there: Vec<usize> = row.iter().map(|cell| cell.index).collect();
    let mut all: Vec<_> = match study.hypotheses.pairs {
        Pairs::Baseline if there.first() == Some(&0) => there[1..].iter().map(|&a| pair(a, 0)).collect(),
        Pairs::Baseline => Vec::new(),
        Pairs::All => {
            let later = there.iter().enumerate();
            later.flat_map(|(k, &a)| there[..k].iter().map(move |&b| pair(a, b))).collect()
        }
    };
    all.extend(effects(study, &there));
    all
}

/// A factor: its slot, its levels, the first variant's first.
type Factor = (Slot, Vec<String>);

/// The factors, where the variants that are there are all combinations of two or more.
fn factors(study: &Study, there: &[usize]) -> Option<Vec<Factor>> {
    if there.len() != study.variants.len() || study.varied.len() < 2 {
        return None;
    }
    let level = |k: usize, slot: Slot| study.variants[k].levels.get(&slot).cloned();
    let mut factors = Vec::new();
    for &slot in &study.varied {
        let mut levels: Vec<String> = Vec::new();
        for k in 0..study.variants.len() {
            let level = level(k, slot)?;
            if !levels.contains(&level) {
                levels.push(level);
            }
        }
        factors.push((slot, levels));
    }
    let distinct: BTreeSet<Vec<Option<String>>> = (0..study.variants.len())
        .map(|k| study.varied.iter().map(|slot| level(k, *slot)).collect())
        .collect();
    let product: usize = factors.iter().map(|(_, levels)| levels.len()).product();
    let varied = factors.iter().filter(|(_, levels)| levels.len() > 1).count();
    (product == study.variants.len() && distinct.len() == product && varied >= 2).then_some(factors)
}

fn effects(study: &Study, there: &[usize]) -> Vec<(Question, Weights)> {
    let Some(factors) = factors(study, there) else { return Vec::new() };
    let has = |k: usize, slot: Slot, level: &str| study.variants[k].levels[&slot] == level;
    // +1 where a variant has the level, -1 where it has the first, 0 elsewhere.
    let sign = |k: usize, slot: Slot, level: &str, base: &str| {
        f64::from(u8::from(has(k, slot, level))) - f64::from(u8::from(has(k, slot, base)))
    };
    let weigh = |of: &dyn Fn(usize) -> f64, cells: usize| -> Weights {
        let weights = (0..study.variants.len()).map(|k| (k, of(k) / cells as f64));
        weights.filter(|(_, weight)| *weight != 0.0).collect()
    };
    let count = study.variants.len();
    let mut all = Vec::new();
    for (slot, levels) in &factors {
        for level in &levels[1..] {
            let weights = weigh(&|k| sign(k, *slot, level, &levels[0]), count / levels.len());
            let (level, base) = (level.clone(), levels[0].clone());
            all.push((Question::Effect { slot: *slot, level, base }, weights));
        }
    }
    for (i, (first, firsts)) in factors.iter().enumerate() {
        for (second, seconds) in &factors[i + 1..] {
            for (a, b) in firsts[1..].iter().flat_map(|a| seconds[1..].iter().map(move |b| (a, b))) {
                let of = |k: usize| sign(k, *first, a, &firsts[0]) * sign(k, *second, b, &seconds[0]);
                let weights = weigh(&of, count / (firsts.len() * seconds.len()));
                let (slots, levels) = ([*first, *second], [a.clone(), b.clone()]);
                all.push((Question::Interaction { slots, levels }, weights));
            }
        }
    }
    all
}

/// The time at which planning times are restricted on a scenario (s): its time limit, or without one the
/// longest run of all.
pub(super) fn horizon_s<'a>(limit_s: Option<f64>, runs: impl Iterator<Item = &'a RunRecord>) -> f64 {
    limit_s.unwrap_or_else(|| runs.map(|run| run.times.planning_s).fold(0.0, f64::max))
}

/// The same of the cells of a scenario.
pub(super) fn row_horizon_s(row: &[Cell<'_>]) -> f64 {
    let limit_s = row.first().and_then(|cell| cell.scenario.problem.limits.budget.time_limit);
    horizon_s(limit_s, row.iter().flat_map(|cell| cell.runs.iter().copied()))
}

/// The runs of a variant, by seed.
pub(super) type Seeds<'a> = BTreeMap<u64, &'a RunRecord>;

/// The contrast of a measure over the seeds on which all that are weighed have a value; `None` where no seed
/// is.
pub(super) fn contrast(weighed: &[(&Seeds<'_>, f64)], measure: &Measure, horizon_s: f64) -> Option<Contrast> {
    let (first, rest) = weighed.split_first()?;
    let mut numbers = Vec::new();
    let mut solved = Solved::default();
    for seed in first.0.keys() {
        if rest.iter().any(|(runs, _)| !runs.contains_key(seed)) {
            continue;
        }
        let values = weighed.iter().map(|(runs, weight)| Some(weight * measure.of(runs[seed], horizon_s)?));
        let Some(values) = values.collect::<Option<Vec<f64>>>() else { continue };
        numbers.push(snapped(&values));
        if let [a, b] = values.as_slice() {
            match (*a != 0.0, *b != 0.0) {
                (true, true) => solved.both += 1,
                (true, false) => solved.first += 1,
                (false, true) => solved.second += 1,
                (false, false) => solved.neither += 1,
            }
        }
    }
    match (measure, weighed.len()) {
        _ if numbers.is_empty() => None,
        (Measure::Solved, 2) => Some(Contrast::Shares(solved)),
        _ => Some(Contrast::Numbers(numbers)),
    }
}

/// The sum, zero where it is only rounding: thirds of ones must cancel.
fn snapped(values: &[f64]) -> f64 {
    let sum: f64 = values.iter().sum();
    let size = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    if sum.abs() <= 1e-12 * size { 0.0 } else { sum }
}

/// The band within which a difference of a measure counts as none: a share of the median of the first
/// variant's values; of shares that share itself.
pub(super) fn band(measure: &Measure, base: &Seeds<'_>, share: f64, horizon_s: f64) -> Option<f64> {
    if matches!(measure, Measure::Solved | Measure::Figure(Figure::Effort)) {
        return Some(share);
    }
    let values = base.values().filter_map(|run| measure.of(run, horizon_s));
    super::statistics::median(values).map(|median| share * median.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::analyse;
    use crate::compare::fixture::{factorial, runs};

    #[test]
    fn a_two_by_two_has_two_effects_and_one_interaction() {
        let study = factorial(&["rlg", "new"], &["interleaved", "lazy"]);
        let records = runs(&study, |_| Some(0.1));
        let rows = analyse(&study, &records);
        let all = questions(&study, &rows[0]);
        assert_eq!(all.len(), 3 + 2 + 1);
        let weights: Vec<&Weights> = all[3..].iter().map(|(_, weights)| weights).collect();
        // Variants: rlg + interleaved, rlg + lazy, new + interleaved, new + lazy.
        assert_eq!(*weights[0], [(0, -0.5), (1, -0.5), (2, 0.5), (3, 0.5)]);
        assert_eq!(*weights[1], [(0, -0.5), (1, 0.5), (2, -0.5), (3, 0.5)]);
        assert_eq!(*weights[2], [(0, 1.0), (1, -1.0), (2, -1.0), (3, 1.0)]);
    }

    #[test]
    fn what_is_no_full_factorial_has_no_effects() {
        let mut study = factorial(&["rlg", "new"], &["interleaved", "lazy"]);
        study.variants.pop();
        let records = runs(&study, |_| Some(0.1));
        assert_eq!(questions(&study, &analyse(&study, &records)[0]).len(), 2);
        study.hypotheses.pairs = Pairs::All;
        assert_eq!(questions(&study, &analyse(&study, &records)[0]).len(), 3);
    }
}
