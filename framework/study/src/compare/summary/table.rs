//! `summary.csv`.

use crate::compare::statistics::Estimate;
use crate::compare::{Cell, Figure, RunStatus, StudyScenario, csv};
use regrasp_api::Slot;

/// The text of `summary.csv`: a head, then a row for each scenario and variant. Numbers have all their
/// digits; what does not exist is empty.
pub fn csv(rows: &[Vec<Cell<'_>>]) -> String {
    let cells = rows.iter().flatten();
    csv::line(head()) + &cells.map(|cell| csv::line(row(cell))).collect::<String>()
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

/// Columns of the comparison with the baseline.
const PAIRED: [&str; 12] = [
    "both_solved",
    "only_baseline_solved",
    "only_variant_solved",
    "neither_solved",
    "time_ratio",
    "time_ratio_low",
    "time_ratio_high",
    "time_effect",
    "time_p",
    "time_p_holm",
    "solved_p",
    "solved_p_holm",
];

/// Columns of the published figures.
const PAPER: [&str; 3] = ["paper_time_s", "paper_generated_nodes", "paper_graph_nodes"];

fn row(cell: &Cell<'_>) -> Vec<String> {
    let mut cells = vec![cell.scenario.name.clone(), cell.variant.name.clone()];
    let plugins = cell.scenario.plugins.get(cell.index);
    let id = |slot: Slot| plugins.and_then(|plugins| plugins.get(&slot)).map(|choice| choice.id.clone());
    cells.extend(Slot::ALL.map(|slot| id(slot).unwrap_or_default()));
    cells.extend([cell.runs.len(), cell.successes().count()].map(|count| count.to_string()));
    cells.extend(RunStatus::ALL.map(|status| cell.count(status).to_string()));
    cells.extend(interval(cell.success()));
    cells.extend(Figure::ALL.into_iter().flat_map(|figure| interval(cell.median(figure))));
    cells.extend(paired(cell));
    cells.extend(paper(cell.scenario));
    cells
}

fn interval(estimate: Option<Estimate>) -> [String; 3] {
    let text = |part: fn(Estimate) -> f64| estimate.map(|found| part(found).to_string()).unwrap_or_default();
    [text(|found| found.value), text(|found| found.low), text(|found| found.high)]
}

fn paired(cell: &Cell<'_>) -> Vec<String> {
    let Some(compared) = &cell.compared else { return vec![String::new(); PAIRED.len()] };
    let paired = &compared.paired;
    let counts = [paired.both, paired.only_baseline, paired.only_variant, paired.neither];
    let tests =
        [paired.effect, paired.time_test.p_value, compared.time_p, paired.solved_p, compared.solved_p];
    let mut cells = counts.map(|count| count.to_string()).to_vec();
    cells.extend(interval(paired.ratio));
    cells.extend(tests.map(|value| value.to_string()));
    cells
}

fn paper(scenario: &StudyScenario) -> [String; 3] {
    scenario.paper.as_ref().map_or_else(Default::default, |paper| {
        [paper.time_s.to_string(), paper.generated_nodes.to_string(), paper.graph_nodes.to_string()]
    })
}
