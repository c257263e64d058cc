//! What `compare` says about a study.

use crate::quantity::span;
use crate::table::Table;
use crate::terminal::{Paint, paint};
use regrasp::study::compare::statistics::{quantile, sorted};
use regrasp::study::compare::summary::{self, Finding};
use regrasp::study::compare::{
    self, Cell, Comparison, Family, Figure, Measure, PaperRow, Question, RunRecord, RunStatus, Study,
};
use serde_json::{Value, json};
use std::path::Path;

/// A row for each scenario and variant, then what may be said; where nothing is compared but with what was
/// published, the paper's table; where scenarios are instances of one problem, the paper's table in its own
/// meanings.
pub fn text(study: &Study, records: &[RunRecord]) -> String {
    let rows = compare::analyse(study, records);
    let family = compare::judge_all(study, &rows);
    let published = study.scenarios.iter().any(|scenario| scenario.paper.is_some());
    if compare::has_families(&rows) {
        let said: String = rows.iter().enumerate().map(|(k, row)| said(study, k, row, &family)).collect();
        return searches(&rows) + &said + &stated(study, &family) + &left_out(study);
    }
    if study.variants.len() == 1 && published {
        return paper(rows.into_iter().flatten().collect()) + &left_out(study);
    }
    let said: String = rows.iter().enumerate().map(|(k, row)| said(study, k, row, &family)).collect();
    table(&rows, &family) + &said + &stated(study, &family) + &left_out(study)
}

/// What may be said of a scenario, in the words of `summary.md`.
fn said(study: &Study, k: usize, row: &[Cell<'_>], family: &Family) -> String {
    let Finding { lead, lines } = summary::finding(study, k, row, family, &quoted);
    if lines.is_empty() {
        return String::new();
    }
    let lines: String = lines.iter().map(|line| format!("    {line}\n")).collect();
    format!("\n  {}. {lead}\n{lines}", paint(Paint::Head, &study.scenarios[k].name))
}

fn stated(study: &Study, family: &Family) -> String {
    let text = summary::family_text(study, family, &quoted);
    if text.is_empty() { text } else { format!("\n  {text}\n") }
}

fn quoted(name: &str) -> String {
    format!("`{name}`")
}

/// What the searches did, problem by problem, the paper's row first.
fn searches(rows: &[Vec<Cell<'_>>]) -> String {
    let mut table = Table::new("<<>", &compare::search_head());
    compare::search_lines(rows).into_iter().for_each(|line| table.row(line));
    format!("{}  means (medians) over the runs that were solved and verified\n", table.text())
}

fn paper(cells: Vec<Cell<'_>>) -> String {
    let mut rows = Vec::new();
    for Cell { scenario, runs, .. } in cells {
        rows.push(PaperRow { scenario: &scenario.name, paper: scenario.paper.as_ref(), runs });
    }
    compare::paper_table(&rows)
}

fn table(rows: &[Vec<Cell<'_>>], family: &Family) -> String {
    let head = ["scenario", "variant", "solved", "verified", "median", "90 %", "planning", "p (Holm)"];
    let mut table = Table::new("<<>", &head);
    for (k, cell) in rows.iter().enumerate().flat_map(|(k, row)| row.iter().map(move |cell| (k, cell))) {
        let of = |count: usize| format!("{count}/{}", cell.runs.len());
        let time = |share| planning_s(cell, share).map_or("-".to_owned(), span);
        let against = planning(family, k, cell.index);
        table.row([
            cell.scenario.name.clone(),
            cell.variant.name.clone(),
            of(cell.count(RunStatus::Solved)),
            of(cell.successes().count()),
            time(0.5),
            time(0.9),
            against.map_or("-".to_owned(), |found| match found.is_better() {
                1 => paint(Paint::Good, &summary::cell(found)),
                -1 => paint(Paint::Bad, &summary::cell(found)),
                _ => summary::cell(found),
            }),
            against.map_or("-".to_owned(), |found| p_value(found.p_holm)),
        ]);
    }
    table.text()
}

/// The comparison of a variant's planning time with the first variant's.
fn planning(family: &Family, scenario: usize, variant: usize) -> Option<&Comparison> {
    let wanted = |found: &&Comparison| {
        found.question == Question::Pair { a: variant, b: 0 }
            && found.measure == Measure::Figure(Figure::Planning)
    };
    family.on(scenario).iter().find(wanted)
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
    let rows = compare::analyse(study, records);
    let family = compare::judge_all(study, &rows);
    let cell = |cell: &Cell<'_>| {
        json!({
            "scenario": cell.scenario.name,
            "variant": cell.variant.name,
            "runs": cell.runs.len(),
            "solved": cell.count(RunStatus::Solved),
            "verified": cell.successes().count(),
            "planning_s": planning_s(cell, 0.5),
        })
    };
    json!({
        "folder": folder,
        "runs": records.len(),
        "verified": records.iter().filter(|record| record.is_success()).count(),
        "seeds": study.seeds,
        "shard": study.shard,
        "rows": rows.iter().flatten().map(cell).collect::<Vec<_>>(),
        "family": summary::family_text(study, &family, &quoted),
        "comparisons": comparisons(study, &family),
        "left_out": study.left_out,
    })
}

/// Every hypothesis with its verdict, in SI units.
pub fn comparisons(study: &Study, family: &Family) -> Vec<Value> {
    let one = |found: &Comparison| {
        json!({
            "scenario": study.scenarios[found.scenario].name,
            "subject": summary::subject(study, &found.question, &quoted),
            "measure": found.measure.column(),
            "seeds": found.pairs,
            "difference": found.difference.map(|difference| difference.value),
            "low": found.difference.map(|difference| difference.low).filter(|low| low.is_finite()),
            "high": found.difference.map(|difference| difference.high).filter(|high| high.is_finite()),
            "band": found.band,
            "p_holm": found.p_holm,
            "verdict": found.verdict.name(),
            "says": summary::clause(found),
        })
    };
    family.comparisons.iter().map(one).collect()
}

/// The one JSON object of `compare --against --json`.
pub fn against(against: &compare::Against, folder: &Path, older: &Path) -> Value {
    json!({
        "folder": folder,
        "against": older,
        "differs": against.differs,
        "comparisons": comparisons(&against.study, &against.family),
    })
}
