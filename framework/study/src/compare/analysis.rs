//! What the runs of a study say of each variant on each scenario by itself.

use super::statistics::{Estimate, median_interval, wilson};
use super::{Figure, RunRecord, RunStatus, Study, StudyScenario, Variant};
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
    /// The median of each of [`Figure::ALL`], worked out once: a bootstrap takes a while.
    medians: [Option<Estimate>; Figure::ALL.len()],
}

impl<'a> Cell<'a> {
    fn new(
        scenario: &'a StudyScenario,
        variant: &'a Variant,
        index: usize,
        runs: Vec<&'a RunRecord>,
    ) -> Self {
        let mut cell = Self { scenario, variant, index, runs, medians: Default::default() };
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
    (0..study.scenarios.len()).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::RunKey;
    use crate::compare::fixture::{runs, study};

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
