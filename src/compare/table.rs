//! What `compare` says about a study.

use crate::table::Table;
use regrasp::study::compare::statistics::{quantile, sorted};
use regrasp::study::compare::{self, Cell, PaperRow, RunRecord, RunStatus, Study};
use serde_json::{Value, json};
use std::path::Path;

/// A row for each scenario and variant; where nothing is compared but with what was published, the paper's
/// table.
pub fn text(study: &Study, records: &[RunRecord]) -> String {
    let cells: Vec<Cell<'_>> = compare::analyse(study, records).into_iter().flatten().collect();
    let published = study.scenarios.iter().any(|scenario| scenario.paper.is_some());
    let text = match study.variants.len() == 1 && published {
        true => paper(cells),
        false => table(&cells),
    };
    text + &left_out(study)
}

fn paper(cells: Vec<Cell<'_>>) -> String {
    let mut rows = Vec::new();
    for Cell { scenario, runs, .. } in cells {
        rows.push(PaperRow { scenario: &scenario.name, paper: scenario.paper.as_ref(), runs });
    }
    compare::paper_table(&rows)
}

fn table(cells: &[Cell<'_>]) -> String {
    let head =
        ["scenario", "variant", "solved", "verified", "median ms", "90 % ms", "time ratio", "p (Holm)"];
    let mut table = Table::new("<<>", &head);
    for cell in cells {
        let of = |count: usize| format!("{count}/{}", cell.runs.len());
        let ms = |share| planning_s(cell, share).map_or("-".to_owned(), |s| format!("{:.1}", s * 1e3));
        let compared = cell.compared.as_ref();
        let ratio = compared.and_then(|compared| compared.paired.ratio);
        table.row([
            cell.scenario.name.clone(),
            cell.variant.name.clone(),
            of(cell.count(RunStatus::Solved)),
            of(cell.successes().count()),
            ms(0.5),
            ms(0.9),
            ratio.map_or("-".to_owned(), |ratio| format!("{:.2}", ratio.value)),
            compared.map_or("-".to_owned(), |compared| p_value(compared.time_p)),
        ]);
    }
    table.text()
}

fn p_value(p: f64) -> String {
    if p < 0.001 { "< 0.001".into() } else { format!("{p:.3}") }
}

/// A quantile of the planning time over the successes (s).
fn planning_s(cell: &Cell<'_>, share: f64) -> Option<f64> {
    quantile(&sorted(cell.successes().map(|run| run.times.planning_s)), share)
}

fn left_out(study: &Study) -> String {
    let line = |pair: &compare::LeftOut| {
        format!("  left out: `{}` on `{}`: {}\n", pair.variant, pair.scenario, pair.reason)
    };
    study.left_out.iter().map(line).collect()
}

/// The one JSON object of `compare --json`.
pub fn json(study: &Study, records: &[RunRecord], folder: &Path) -> Value {
    let cell = |cell: Cell<'_>| {
        json!({
            "scenario": cell.scenario.name,
            "variant": cell.variant.name,
            "runs": cell.runs.len(),
            "solved": cell.count(RunStatus::Solved),
            "verified": cell.successes().count(),
            "planning_s": planning_s(&cell, 0.5),
            "time_ratio": cell.compared.as_ref().and_then(|compared| compared.paired.ratio).map(|ratio| ratio.value),
            "time_p": cell.compared.as_ref().map(|compared| compared.time_p),
        })
    };
    json!({
        "folder": folder,
        "runs": records.len(),
        "verified": records.iter().filter(|record| record.is_success()).count(),
        "seeds": study.seeds,
        "shard": study.shard,
        "rows": compare::analyse(study, records).into_iter().flatten().map(cell).collect::<Vec<_>>(),
        "left_out": study.left_out,
    })
}
