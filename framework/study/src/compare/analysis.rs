//! What the runs of a study say: figures of each variant on each scenario, and its comparison with the
//! baseline.

use super::statistics::{Estimate, Paired, holm, median_interval, wilson};
use super::{RunRecord, RunStatus, Study, StudyScenario, Variant};
use std::collections::BTreeMap;

/// One variant on one scenario.
pub struct Cell<'a> {
    /// The scenario.
    pub scenario: &'a StudyScenario,
    /// The variant.
    pub variant: &'a Variant,
    /// Index of the variant.
    pub index: usize,
    /// The runs, in the order of their seeds.
    pub runs: Vec<&'a RunRecord>,
    /// The comparison with the baseline; absent for the baseline itself, and where it was left out.
    pub compared: Option<Compared>,
    /// The median of each of [`Figure::ALL`], worked out once: a bootstrap takes a while.
    medians: [Option<Estimate>; Figure::ALL.len()],
}

/// A comparison with the baseline, corrected for there being several variants.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// The comparison, as if it were the only one.
    pub paired: Paired,
    /// p-value of the times, after Holm's correction over the scenario's variants.
    pub time_p: f64,
    /// p-value of the numbers of solved problems, after Holm's correction over the scenario's variants.
    pub solved_p: f64,
}

/// Figures of a run that are summed up by their median over the successes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    /// Planning time (s).
    Planning,
    /// Nodes that the search generated.
    GeneratedNodes,
    /// Nodes of the final graph.
    GraphNodes,
    /// Regrasps of the plan.
    Regrasps,
    /// Transfers of the plan.
    Transfers,
    /// Duration of the motion (s).
    Duration,
    /// Smallest closure margin.
    Margin,
    /// Smallest clearance (m).
    Clearance,
}

impl Figure {
    /// Every figure, in the order of the columns of `summary.csv`.
    pub const ALL: [Self; 8] = [
        Self::Planning,
        Self::GeneratedNodes,
        Self::GraphNodes,
        Self::Regrasps,
        Self::Transfers,
        Self::Duration,
        Self::Margin,
        Self::Clearance,
    ];

    /// The name in `summary.csv`, with its unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Planning => "planning_s",
            Self::GeneratedNodes => "generated_nodes",
            Self::GraphNodes => "graph_nodes",
            Self::Regrasps => "regrasps",
            Self::Transfers => "transfers",
            Self::Duration => "duration_s",
            Self::Margin => "margin",
            Self::Clearance => "clearance_m",
        }
    }

    /// The figure of one run; absent where the run has none.
    pub fn of(self, run: &RunRecord) -> Option<f64> {
        let (motion, certified) = (run.motion.as_ref(), run.certified.as_ref());
        match self {
            Self::Planning => Some(run.times.planning_s),
            Self::GeneratedNodes => Some(run.counts.generated_nodes as f64),
            Self::GraphNodes => Some(run.counts.graph_nodes as f64),
            Self::Regrasps => motion.map(|motion| motion.regrasps as f64),
            Self::Transfers => motion.map(|motion| motion.transfers as f64),
            Self::Duration => motion.map(|motion| motion.duration_s),
            Self::Margin => certified.and_then(|certified| certified.margin),
            Self::Clearance => certified.and_then(|certified| certified.clearance_m),
        }
    }
}

impl<'a> Cell<'a> {
    fn new(
        scenario: &'a StudyScenario,
        variant: &'a Variant,
        index: usize,
        runs: Vec<&'a RunRecord>,
    ) -> Self {
        let mut cell = Self { scenario, variant, index, runs, compared: None, medians: Default::default() };
        let median = |figure: Figure| median_interval(cell.successes().filter_map(|run| figure.of(run)));
        cell.medians = Figure::ALL.map(median);
        cell
    }

    /// The runs whose plan reaches all goals and was verified.
    pub fn successes(&self) -> impl Iterator<Item = &'a RunRecord> {
        self.runs.iter().copied().filter(|run| run.is_success())
    }

    /// How many runs ended so.
    pub fn count(&self, status: RunStatus) -> usize {
        self.runs.iter().filter(|run| run.status == status).count()
    }

    /// The share of successes with its Wilson interval; `None` for no runs.
    pub fn success(&self) -> Option<Estimate> {
        wilson(self.successes().count(), self.runs.len())
    }

    /// The median of a figure over the successes with its bootstrap interval; `None` for no success.
    pub fn median(&self, figure: Figure) -> Option<Estimate> {
        self.medians[figure as usize]
    }

    /// The median planning time over *all* runs (s), one that did not succeed counting as endless; infinite
    /// where half of them failed. What variants are ranked by: who fails is not fast.
    pub fn median_of_all_s(&self) -> f64 {
        let time = |run: &&RunRecord| if run.is_success() { run.times.planning_s } else { f64::INFINITY };
        let mut times: Vec<f64> = self.runs.iter().map(time).collect();
        times.sort_by(f64::total_cmp);
        let Some(last) = times.len().checked_sub(1) else { return f64::INFINITY };
        0.5 * (times[last / 2] + times[last.div_ceil(2)])
    }

    /// Compares with another variant's runs of the same scenario, seed by seed; seeds that only one of them
    /// has are left out.
    pub fn against(&self, baseline: &Self) -> Paired {
        let time = |run: &RunRecord| run.is_success().then_some(run.times.planning_s);
        let theirs: BTreeMap<u64, Option<f64>> =
            baseline.runs.iter().map(|run| (run.seed, time(run))).collect();
        let pair = |run: &&RunRecord| Some((*theirs.get(&run.seed)?, time(run)));
        Paired::of(&self.runs.iter().filter_map(pair).collect::<Vec<_>>())
    }
}

/// All cells of a study, scenario by scenario, the baseline first; without those that were left out or have
/// no run yet.
pub fn analyse<'a>(study: &'a Study, records: &'a [RunRecord]) -> Vec<Vec<Cell<'a>>> {
    let mut runs: BTreeMap<(usize, usize), Vec<&RunRecord>> = BTreeMap::new();
    for record in records {
        let Some(key) = study.key(record) else { continue };
        runs.entry((key.scenario, key.variant)).or_default().push(record);
    }
    let mut cell = |scenario: usize, index: usize| {
        let mut runs = runs.remove(&(scenario, index))?;
        runs.sort_by_key(|run| run.seed);
        let (scenario, variant) = (&study.scenarios[scenario], &study.variants[index]);
        Some(Cell::new(scenario, variant, index, runs))
    };
    let row = |scenario| (0..study.variants.len()).filter_map(|k| cell(scenario, k)).collect();
    let mut rows: Vec<Vec<Cell<'_>>> = (0..study.scenarios.len()).map(row).collect();
    rows.iter_mut().for_each(|row| compare_with_baseline(row));
    rows
}

fn compare_with_baseline(row: &mut [Cell<'_>]) {
    let Some((baseline, others)) = row.split_first_mut().filter(|(first, _)| first.index == 0) else {
        return;
    };
    let all: Vec<Paired> = others.iter().map(|cell| cell.against(baseline)).collect();
    let time_p = holm(&all.iter().map(|paired| paired.time_test.p_value).collect::<Vec<_>>());
    let solved_p = holm(&all.iter().map(|paired| paired.solved_p).collect::<Vec<_>>());
    for (((cell, paired), time_p), solved_p) in others.iter_mut().zip(all).zip(time_p).zip(solved_p) {
        cell.compared = Some(Compared { paired, time_p, solved_p });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::RunKey;
    use crate::compare::fixture::{runs, study};

    #[test]
    fn figures_are_found_where_they_are_kept() {
        assert!(Figure::ALL.into_iter().enumerate().all(|(k, figure)| figure as usize == k));
        let study = study(&["rlg"]);
        let records = runs(&study, |_| Some(0.25));
        let rows = analyse(&study, &records);
        let median = |figure| rows[0][0].median(figure).map(|found| found.value);
        assert_eq!(median(Figure::Planning), Some(0.25));
        assert_eq!((median(Figure::Regrasps), median(Figure::Transfers)), (Some(3.0), Some(4.0)));
        assert_eq!((median(Figure::Margin), median(Figure::Clearance)), (Some(0.1), None));
    }

    #[test]
    fn who_fails_is_not_fast() {
        let study = study(&["rlg", "five of twelve", "six of twelve", "seven of twelve"]);
        let solved = |key: RunKey| [12, 5, 6, 7][key.variant] > key.seed;
        let records = runs(&study, |key| solved(key).then_some(1.0 + key.seed as f64));
        let rows = analyse(&study, &records);
        let medians: Vec<f64> = rows[0].iter().map(Cell::median_of_all_s).collect();
        assert_eq!(medians, [6.5, f64::INFINITY, f64::INFINITY, 6.5]);
    }
}
