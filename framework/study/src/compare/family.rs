//! The one family of hypotheses of a study, corrected together, and the verdict on each.

use super::question::{Seeds, band, contrast, questions, row_horizon_s};
use super::statistics::{ALPHA, Contrast, Estimate, holm, holm_levels};
use super::{Cell, Figure, Measure, Question, Study};
use std::collections::BTreeMap;

/// What may be said of a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The first is shown to have more.
    More,
    /// The first is shown to have less.
    Less,
    /// Shown to be within the band of practical equivalence, and not shown to differ.
    Same,
    /// Neither a difference nor equivalence is shown.
    NotShown,
    /// So few pairs could show nothing, whatever they are.
    TooFew,
}

impl Verdict {
    /// Every verdict.
    pub const ALL: [Self; 5] = [Self::More, Self::Less, Self::Same, Self::NotShown, Self::TooFew];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::More => "more",
            Self::Less => "less",
            Self::Same => "same",
            Self::NotShown => "not-shown",
            Self::TooFew => "too-few",
        }
    }
}

/// The answer to one question in one measure on one scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Index of the scenario.
    pub scenario: usize,
    /// What was asked.
    pub question: Question,
    /// In what.
    pub measure: Measure,
    /// On how many seeds.
    pub pairs: usize,
    /// On how many of them the first had more, and less.
    pub sides: [usize; 2],
    /// p-value as if this were the only hypothesis.
    pub p: f64,
    /// p-value after Holm's correction over the family; below 0.05 a difference is shown.
    pub p_holm: f64,
    /// The level that the hypothesis met in the correction, and the chance that the interval misses.
    pub level: f64,
    /// The difference, in the SI unit of the measure, with its interval at that level; `None` for no seed.
    pub difference: Option<Estimate>,
    /// Half the width of the band of practical equivalence, in the same unit; `None` where it is not known.
    pub band: Option<f64>,
    /// What may be said.
    pub verdict: Verdict,
}

impl Comparison {
    /// How many seeds in common it needs to show anything, at its level.
    pub fn fewest(&self) -> usize {
        fewest_pairs(self.level)
    }

    /// Whether a difference is shown.
    pub fn is_shown(&self) -> bool {
        matches!(self.verdict, Verdict::More | Verdict::Less)
    }

    /// Whether the whole interval lies within the band of practical equivalence.
    pub fn is_within_band(&self) -> bool {
        is_within(self.difference, self.band)
    }

    /// Whether the first is shown to be better (1) or worse (-1); 0 where neither, or where neither more nor
    /// less is better.
    pub fn is_better(&self) -> i8 {
        match self.verdict {
            Verdict::More => self.measure.sense(),
            Verdict::Less => -self.measure.sense(),
            _ => 0,
        }
    }
}

/// All hypotheses of a study with their verdicts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Family {
    /// Scenario by scenario, question by question, measure by measure.
    pub comparisons: Vec<Comparison>,
    /// How many of them could be refused at all, and were corrected for.
    pub tested: usize,
}

impl Family {
    /// The comparisons on a scenario.
    pub fn on(&self, scenario: usize) -> &[Comparison] {
        let begin = self.comparisons.partition_point(|found| found.scenario < scenario);
        let end = self.comparisons.partition_point(|found| found.scenario <= scenario);
        &self.comparisons[begin..end]
    }

    /// The questions that were asked about a scenario, in their order, each with its answers, one a measure.
    pub fn questions(&self, scenario: usize) -> Vec<(&Question, &[Comparison])> {
        let chunks = self.on(scenario).chunk_by(|a, b| a.question == b.question);
        chunks.map(|answers| (&answers[0].question, answers)).collect()
    }
}

/// A hypothesis before it is judged.
pub(super) struct Asked {
    pub scenario: usize,
    pub question: Question,
    pub measure: Measure,
    pub contrast: Option<Contrast>,
    pub band: Option<f64>,
}

/// Tests all hypotheses of a study on the runs that are there.
pub fn judge_all(study: &Study, rows: &[Vec<Cell<'_>>]) -> Family {
    let mut asked = Vec::new();
    for (scenario, row) in rows.iter().enumerate() {
        let runs = row.iter().flat_map(|cell| cell.runs.iter().copied());
        let horizon_s = row_horizon_s(row);
        let measures = Measure::of_runs(runs, &study.hypotheses.measures);
        let seeds: BTreeMap<usize, Seeds<'_>> = row.iter().map(|cell| (cell.index, by_seed(cell))).collect();
        for (question, weights) in questions(study, row) {
            let weighed: Vec<_> = weights.iter().map(|(k, weight)| (&seeds[k], *weight)).collect();
            let base = match question {
                Question::Pair { b, .. } => &seeds[&b],
                _ => &seeds[&row[0].index],
            };
            asked.extend(measures.iter().map(|measure| Asked {
                scenario,
                question: question.clone(),
                measure: measure.clone(),
                contrast: contrast(&weighed, measure, horizon_s),
                band: band(measure, base, study.hypotheses.band, horizon_s),
            }));
        }
    }
    judge(asked)
}

fn by_seed<'a>(cell: &Cell<'a>) -> Seeds<'a> {
    cell.runs.iter().map(|run| (run.seed, *run)).collect()
}

/// Corrects for all hypotheses that could be refused (the others are never claimed to differ, whatever the
/// correction), and gives each its verdict.
///
/// That a difference is shown anywhere although there is none happens in at most 5 % of studies, and so does
/// that equivalence is: each hypothesis that is not refused meets the level 0.05 over the number of those.
pub(super) fn judge(asked: Vec<Asked>) -> Family {
    let can_show = |asked: &Asked| asked.contrast.as_ref().is_some_and(|found| found.can_show(ALPHA));
    let alone: Vec<f64> =
        asked.iter().map(|asked| asked.contrast.as_ref().map_or(1.0, Contrast::p_value)).collect();
    let able: Vec<usize> = (0..asked.len()).filter(|&k| can_show(&asked[k])).collect();
    let weights = weights(able.iter().map(|&k| &asked[k].measure));
    let weight = |measure: &Measure| weights[usize::from(is_foremost(measure))];
    let tests: Vec<(f64, f64)> = able.iter().map(|&k| (alone[k], weight(&asked[k].measure))).collect();
    let all: f64 = asked.iter().map(|asked| weight(&asked.measure)).sum();
    let others = (all - tests.iter().map(|(_, weight)| weight).sum::<f64>()).max(0.0);
    let (levels, unit) = holm_levels(&tests, others, ALPHA);
    let tested = tests.len();
    let corrected: BTreeMap<usize, (f64, f64)> =
        able.into_iter().zip(holm(&tests).into_iter().zip(levels)).collect();
    let comparisons = asked.into_iter().enumerate().map(|(k, asked)| {
        let rest = (1.0, unit * weight(&asked.measure));
        let (p_holm, level) = corrected.get(&k).copied().unwrap_or(rest);
        judged(asked, alone[k], p_holm, level)
    });
    Family { comparisons: comparisons.collect(), tested }
}

/// The share of the level that goes to what a study is made for: whether problems are solved, and how fast.
pub const FOREMOST: f64 = 0.75;

/// The weights of hypotheses in the correction: those on solved runs and planning time, which come second
/// here, share [`FOREMOST`] of the level, and never have less than the others, so that a study of twenty
/// seeds which asks everything still shows what it is made for.
fn weights<'m>(tested: impl Iterator<Item = &'m Measure>) -> [f64; 2] {
    let (mut foremost, mut others) = (0.0_f64, 0.0_f64);
    tested.for_each(|measure| *(if is_foremost(measure) { &mut foremost } else { &mut others }) += 1.0);
    let ratio = (FOREMOST * others) / ((1.0 - FOREMOST) * foremost).max(f64::MIN_POSITIVE);
    [1.0, if foremost > 0.0 { ratio.max(1.0) } else { 1.0 }]
}

fn is_foremost(measure: &Measure) -> bool {
    matches!(measure, Measure::Solved | Measure::Figure(Figure::Planning))
}

/// Fewer pairs than this cannot meet a level, whatever they show: even if all point one way, p is 2 / 2ⁿ.
fn fewest_pairs(level: f64) -> usize {
    (1..1000).find(|n| 2.0 * 0.5_f64.powi(*n) < level).map_or(1000, |n| n as usize)
}

fn judged(asked: Asked, p: f64, p_holm: f64, level: f64) -> Comparison {
    let Asked { scenario, question, measure, contrast, band } = asked;
    let pairs = contrast.as_ref().map_or(0, Contrast::pairs);
    let difference = contrast.as_ref().and_then(|contrast| contrast.estimate(level));
    let leaning = contrast.as_ref().map_or(0.0, Contrast::leaning);
    let verdict = match () {
        () if p_holm < ALPHA && leaning > 0.0 => Verdict::More,
        () if p_holm < ALPHA => Verdict::Less,
        () if pairs < fewest_pairs(level) => Verdict::TooFew,
        () if is_within(difference, band) => Verdict::Same,
        () => Verdict::NotShown,
    };
    let sides = contrast.map_or([0, 0], |contrast| contrast.sides());
    Comparison { scenario, question, measure, pairs, sides, p, p_holm, level, difference, band, verdict }
}

fn is_within(difference: Option<Estimate>, band: Option<f64>) -> bool {
    difference.zip(band).is_some_and(|(found, band)| found.low >= -band && found.high <= band)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::fixture::{factorial, runs, study};
    use crate::compare::{Pairs, RunKey, analyse};

    fn family(study: &Study, time: impl Fn(RunKey) -> Option<f64>) -> Family {
        let records = runs(study, time);
        judge_all(study, &analyse(study, &records))
    }

    const PLANNING: Measure = Measure::Figure(Figure::Planning);

    fn planning(family: &Family, scenario: usize) -> Vec<&Comparison> {
        family.on(scenario).iter().filter(|found| found.measure == PLANNING).collect()
    }

    #[test]
    fn shown_same_and_not_shown_are_told_apart() {
        let mut study = study(&["rlg", "slow", "same", "erratic"]);
        study.seeds.count = 20;
        let noise = |key: RunKey, size: f64| if key.seed.is_multiple_of(2) { 1.0 + size } else { 1.0 - size };
        let factor = |key: RunKey| [1.0, 3.0, noise(key, 0.01), noise(key, 0.6)][key.variant];
        let family = family(&study, |key| Some(factor(key) * (1.0 + 0.01 * key.seed as f64)));
        let verdicts: Vec<Verdict> = planning(&family, 0).iter().map(|found| found.verdict).collect();
        assert_eq!(verdicts, [Verdict::More, Verdict::Same, Verdict::NotShown]);
        let slow = planning(&family, 0)[0];
        let difference = slow.difference.unwrap();
        assert!((difference.value - 2.19).abs() < 0.02 && difference.low > 2.0, "{difference:?}");
        assert_eq!((slow.sides, slow.is_better()), ([20, 0], -1));
    }

    #[test]
    fn what_cannot_show_costs_nothing() {
        // Everything but the time is equal in all runs: one test a scenario is left.
        let study = study(&["rlg", "slow"]);
        let family = family(&study, |key| Some([1.0, 1.1][key.variant] + 0.01 * key.seed as f64));
        assert_eq!(family.tested, 2);
        let slow = planning(&family, 0)[0];
        assert_eq!((slow.p, slow.p_holm), (2.0 / 4096.0, 4.0 / 4096.0));
    }

    #[test]
    fn failures_count_as_the_whole_limit() {
        let mut study = study(&["rlg", "hasty"]);
        study.scenarios[0].problem.limits.budget.time_limit = Some(2.0);
        // Where it plans at all it takes half the time; that is in four runs of twelve.
        let time = |key: RunKey| match key.variant {
            0 => Some(1.0),
            _ => key.seed.is_multiple_of(3).then_some(0.5),
        };
        let family = family(&study, time);
        let found = planning(&family, 0)[0];
        assert_eq!((found.pairs, found.sides), (12, [8, 4]));
        assert!(found.difference.unwrap().value > 0.0, "who fails is not fast: {found:?}");
    }

    #[test]
    fn a_factor_is_found_whatever_the_other() {
        let study = factorial(&["rlg", "slow"], &["interleaved", "lazy"]);
        let time = |key: RunKey| {
            let [slow, lazy] = [key.variant / 2, key.variant % 2].map(|level| level as f64);
            Some(
                1.0 + 0.5 * slow
                    + 0.3 * slow * lazy
                    + 0.001 * (key.seed * (1 + key.variant as u64) % 7) as f64,
            )
        };
        let family = family(&study, time);
        let of = |question: fn(&Question) -> bool| -> Vec<&Comparison> {
            planning(&family, 0).into_iter().filter(|found| question(&found.question)).collect()
        };
        let effects = of(|question| matches!(question, Question::Effect { .. }));
        let values: Vec<f64> = effects.iter().map(|found| found.difference.unwrap().value).collect();
        assert!((values[0] - 0.65).abs() < 0.01 && (values[1] - 0.15).abs() < 0.01, "{values:?}");
        let interaction = of(|question| matches!(question, Question::Interaction { .. }))[0];
        assert!((interaction.difference.unwrap().value - 0.3).abs() < 0.01, "{interaction:?}");
        assert_eq!(interaction.verdict, Verdict::More);
    }

    #[test]
    fn all_pairs_are_one_family() {
        let mut study = study(&["a", "b", "c"]);
        let time = |key: RunKey| Some([1.0, 2.0, 3.0][key.variant] + 0.01 * key.seed as f64);
        let few = family(&study, time).tested;
        study.hypotheses.pairs = Pairs::All;
        let many = family(&study, time);
        assert_eq!((few, many.tested), (4, 6));
        assert!(planning(&many, 0).iter().all(|found| found.is_shown()));
        let pairs: Vec<&Question> = many.questions(0).into_iter().map(|(question, _)| question).collect();
        assert_eq!(
            pairs,
            [&Question::Pair { a: 1, b: 0 }, &Question::Pair { a: 2, b: 0 }, &Question::Pair { a: 2, b: 1 }]
        );
    }
}
