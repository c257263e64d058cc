//! `summary.csv`.

use crate::compare::statistics::Estimate;
use crate::compare::{Cell, Figure, Measure, RunStatus, StudyScenario, csv, row_horizon_s};
use regrasp_api::Slot;
use std::collections::BTreeMap;

const PLANNING: Measure = Measure::Figure(Figure::Planning);

/// The text of `summary.csv`: a head, then a row for each scenario and variant. Numbers have all their
/// digits; what does not exist is empty.
pub fn csv(rows: &[Vec<Cell<'_>>]) -> String {
    let cells = rows.iter().flat_map(|row| row.iter().map(move |cell| (cell, row)));
    csv::line(head()) + &cells.map(|(cell, all)| csv::line(row(cell, all))).collect::<String>()
}

fn head() -> Vec<String> {
    let mut names: Vec<String> = ["scenario", "variant"].map(str::to_owned).to_vec();
    names.extend(Slot::ALL.map(|slot| slot.name().to_owned()));
    names.extend(["runs", "successes"].map(str::to_owned));
    names.extend(RunStatus::ALL.map(|status| status.name().to_owned()));
    names.extend(["success", "success_low", "success_high"].map(str::to_owned));
    for figure in Figure::ALL {
        let name = figure.name();
        names.extend([format!("{name}_median"), format!("{name}_low"), format!("{name}_high")]);
    }
    names.extend(PAIRED.iter().chain(&PAPER).map(ToString::to_string));
    names
}

/// Columns of who solved what on the same seeds.
const PAIRED: [&str; 5] =
    ["both_solved", "only_baseline_solved", "only_variant_solved", "neither_solved", "restricted_mean_s"];

/// Columns of the published figures.
const PAPER: [&str; 3] = ["paper_time_s", "paper_generated_nodes", "paper_graph_nodes"];

fn row(cell: &Cell<'_>, all: &[Cell<'_>]) -> Vec<String> {
    let mut cells = vec![cell.scenario.name.clone(), cell.variant.name.clone()];
    let plugins = cell.scenario.plugins.get(cell.index);
    let id = |slot: Slot| plugins.and_then(|plugins| plugins.get(&slot)).map(|choice| choice.id.clone());
    cells.extend(Slot::ALL.map(|slot| id(slot).unwrap_or_default()));
    cells.extend([cell.runs.len(), cell.successes().count()].map(|count| count.to_string()));
    cells.extend(RunStatus::ALL.map(|status| cell.count(status).to_string()));
    cells.extend(interval(cell.success()));
    cells.extend(Figure::ALL.into_iter().flat_map(|figure| interval(cell.median(figure))));
    cells.extend(paired(cell, all));
    cells.extend(paper(cell.scenario));
    cells
}

fn interval(estimate: Option<Estimate>) -> [String; 3] {
    let text = |part: fn(Estimate) -> f64| estimate.map(|found| part(found).to_string()).unwrap_or_default();
    [text(|found| found.value), text(|found| found.low), text(|found| found.high)]
}

/// Who solved which seeds, and the mean planning time, a run that failed counting as the whole horizon.
fn paired(cell: &Cell<'_>, row: &[Cell<'_>]) -> Vec<String> {
    let first = row.first().filter(|first| first.index == 0 && cell.index != 0);
    let counts = first.map(|first| {
        let (mine, theirs) = (solved(cell), solved(first));
        let count = |a: bool, b: bool| {
            let pairs = mine.iter().filter_map(|(seed, solved)| Some((theirs.get(seed)?, solved)));
            pairs.filter(|pair| *pair == (&a, &b)).count().to_string()
        };
        [count(true, true), count(true, false), count(false, true), count(false, false)]
    });
    let mut cells = counts.unwrap_or_default().to_vec();
    let horizon_s = row_horizon_s(row);
    let times = cell.runs.iter().filter_map(|run| PLANNING.of(run, horizon_s));
    cells.push((times.sum::<f64>() / cell.runs.len().max(1) as f64).to_string());
    cells
}

fn solved(cell: &Cell<'_>) -> BTreeMap<u64, bool> {
    cell.runs.iter().map(|run| (run.seed, run.is_success())).collect()
}

fn paper(scenario: &StudyScenario) -> [String; 3] {
    scenario.paper.as_ref().map_or_else(Default::default, |paper| {
        [paper.time_s.to_string(), paper.generated_nodes.to_string(), paper.graph_nodes.to_string()]
    })
}
