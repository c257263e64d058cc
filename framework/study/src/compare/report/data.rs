//! What the page shows, as plain data.

use super::verdicts::{Boxes, Matrix, best, boxes, matrix};
use crate::compare::statistics::{BoxPlot, Estimate, ecdf, log_box_plot};
use crate::compare::summary::{Finding, family_text, finding};
use crate::compare::{CLEARANCE, Cell, FRAMEWORK, Family, Figure, LeftOut, Machine, RunStatus, Study};
use regrasp_api::{Reason, Slot};
use regrasp_run::scenario::PaperFigures;
use serde::Serialize;
use std::collections::BTreeMap;

/// The whole page.
#[derive(Serialize)]
pub struct PageData<'a> {
    command: String,
    version: &'a str,
    machines: &'a [Machine],
    started_s: u64,
    seeds: u64,
    /// Which hypotheses were tested, and how; empty where none was.
    family: String,
    varied: Vec<&'static str>,
    variants: Vec<VariantData<'a>>,
    /// Names of those who take time, in the order in which they are drawn.
    roles: Vec<&'static str>,
    /// Names of causes, in the order of the columns.
    causes: Vec<&'static str>,
    scenarios: Vec<ScenarioData<'a>>,
    /// Share of stability tests and collision in the baseline's planning time, all scenarios together.
    remark: Option<Remark>,
}

#[derive(Serialize)]
struct VariantData<'a> {
    name: &'a str,
    levels: BTreeMap<&'static str, &'a str>,
}

#[derive(Serialize)]
struct ScenarioData<'a> {
    name: &'a str,
    summary: &'a str,
    source: &'a str,
    paper: Option<&'a PaperFigures>,
    finding: Finding,
    /// SVG that [`super::strip`] made; it holds no text of users.
    strip: Option<&'a str>,
    left_out: Vec<&'a LeftOut>,
    cells: Vec<CellData>,
    matrix: Matrix,
    boxes: Vec<Boxes>,
    best: Vec<usize>,
}

#[derive(Serialize)]
struct CellData {
    variant: usize,
    runs: usize,
    successes: usize,
    success: Option<Estimate>,
    /// How many runs ended otherwise, by status.
    failures: BTreeMap<&'static str, usize>,
    planning_s: Option<Estimate>,
    /// See [`Cell::median_of_all_s`]; absent where it is infinite.
    median_of_all_s: Option<f64>,
    ecdf: Vec<(f64, f64)>,
    box_plot: Option<BoxPlot>,
    /// Bytes.
    memory: Option<f64>,
    generated: Option<f64>,
    graph: Option<f64>,
    regrasps: Option<f64>,
    /// Mean seconds of a run by role.
    roles_s: BTreeMap<&'static str, f64>,
    /// Mean number of rejections of a run by slot and cause.
    rejections: BTreeMap<&'static str, BTreeMap<&'static str, f64>>,
}

/// Shares of planning time.
#[derive(Serialize)]
struct Remark {
    variant: String,
    stability: f64,
    collision: f64,
    /// The scenarios in which both together take more than half.
    holds: usize,
    scenarios: usize,
}

/// The two that the paper's remark is about.
const REMARKED: [&str; 2] = [CLEARANCE, "stability-test"];

fn roles() -> Vec<&'static str> {
    let first = REMARKED; // side by side, so that their sum can be seen
    let others = Slot::ALL.map(Slot::name).into_iter().filter(|name| !first.contains(name));
    first.into_iter().chain(others).chain([FRAMEWORK]).collect()
}

/// Gathers what the page shows.
pub fn page_data<'a>(
    study: &'a Study,
    rows: &[Vec<Cell<'a>>],
    family: &Family,
    strips: &'a [Option<String>],
) -> PageData<'a> {
    let strip = |k: usize| strips.get(k).and_then(Option::as_deref);
    PageData {
        command: study.command.join(" "),
        version: study.versions.get("regrasp").map_or("", String::as_str),
        machines: &study.machines,
        started_s: study.started_s,
        seeds: study.seeds.count,
        family: family_text(study, family, &quoted),
        varied: study.varied.iter().map(|slot| slot.name()).collect(),
        variants: study
            .variants
            .iter()
            .map(|variant| VariantData {
                name: &variant.name,
                levels: variant.levels.iter().map(|(slot, level)| (slot.name(), level.as_str())).collect(),
            })
            .collect(),
        roles: roles(),
        causes: Reason::ALL.map(Reason::name).to_vec(),
        scenarios: rows
            .iter()
            .enumerate()
            .map(|(k, row)| scenario_data(study, k, row, family, strip(k)))
            .collect(),
        remark: remark(rows),
    }
}

fn quoted(name: &str) -> String {
    format!("“{name}”")
}

fn scenario_data<'a>(
    study: &'a Study,
    k: usize,
    row: &[Cell<'a>],
    family: &Family,
    strip: Option<&'a str>,
) -> ScenarioData<'a> {
    let scenario = &study.scenarios[k];
    ScenarioData {
        name: &scenario.name,
        summary: &scenario.summary,
        source: &scenario.source,
        paper: scenario.paper.as_ref(),
        finding: finding(study, k, row, family, &quoted),
        strip,
        left_out: study.left_out.iter().filter(|pair| pair.scenario == scenario.name).collect(),
        cells: row.iter().map(cell_data).collect(),
        matrix: matrix(study, k, family, &quoted),
        boxes: boxes(row, &study.hypotheses.measures),
        best: best(row, k, family),
    }
}

fn cell_data(cell: &Cell<'_>) -> CellData {
    let times = || cell.successes().map(|run| run.times.planning_s);
    let median = |figure: Figure| cell.median(figure).map(|found| found.value);
    let failures = RunStatus::ALL.into_iter().filter(|status| *status != RunStatus::Solved);
    let mut failures: BTreeMap<_, _> = failures.map(|status| (status.name(), cell.count(status))).collect();
    failures.insert("rejected", cell.count(RunStatus::Solved) - cell.successes().count());
    failures.retain(|_, count| *count > 0);
    CellData {
        variant: cell.index,
        runs: cell.runs.len(),
        successes: cell.successes().count(),
        success: cell.success(),
        failures,
        planning_s: cell.median(Figure::Planning),
        median_of_all_s: Some(cell.median_of_all_s()).filter(|time| time.is_finite()),
        ecdf: ecdf(times(), cell.runs.len()),
        box_plot: log_box_plot(times()),
        memory: median(Figure::Memory),
        generated: median(Figure::GeneratedNodes),
        graph: median(Figure::GraphNodes),
        regrasps: median(Figure::Regrasps),
        roles_s: mean_roles(cell),
        rejections: mean_rejections(cell),
    }
}

/// Mean seconds by role over the solved runs, or over all where none was solved.
fn mean_roles(cell: &Cell<'_>) -> BTreeMap<&'static str, f64> {
    let solved: Vec<_> = cell.successes().collect();
    let runs = if solved.is_empty() { &cell.runs } else { &solved };
    let mean = |role: &'static str| {
        let times = runs.iter().filter_map(|run| run.times.roles_s.get(role));
        (role, times.sum::<f64>() / runs.len().max(1) as f64)
    };
    roles().into_iter().map(mean).filter(|(_, mean)| *mean > 0.0).collect()
}

/// Mean rejections over all runs.
fn mean_rejections(cell: &Cell<'_>) -> BTreeMap<&'static str, BTreeMap<&'static str, f64>> {
    let mut all: BTreeMap<&str, BTreeMap<&str, f64>> = BTreeMap::new();
    for (slot, plugin) in cell.runs.iter().flat_map(|run| &run.counts.plugins) {
        for (reason, count) in &plugin.rejections {
            let sum = all.entry(slot.name()).or_default().entry(reason.name()).or_default();
            *sum += *count as f64 / cell.runs.len() as f64;
        }
    }
    all
}

/// What the baseline's time goes to, of all scenarios for which it was measured.
fn remark(rows: &[Vec<Cell<'_>>]) -> Option<Remark> {
    let baselines: Vec<&Cell<'_>> =
        rows.iter().filter_map(|row| row.first().filter(|cell| cell.index == 0)).collect();
    let measured: Vec<_> =
        baselines.iter().map(|cell| mean_roles(cell)).filter(|roles| !roles.is_empty()).collect();
    let share = |roles: &BTreeMap<&str, f64>, role: &str| {
        roles.get(role).unwrap_or(&0.0) / roles.values().sum::<f64>()
    };
    let mean =
        |role: &str| measured.iter().map(|roles| share(roles, role)).sum::<f64>() / measured.len() as f64;
    let together =
        |roles: &&BTreeMap<&str, f64>| REMARKED.iter().map(|role| share(roles, role)).sum::<f64>() > 0.5;
    Some(Remark {
        variant: baselines.first().filter(|_| !measured.is_empty())?.variant.name.clone(),
        stability: mean(REMARKED[1]),
        collision: mean(REMARKED[0]),
        holds: measured.iter().filter(together).count(),
        scenarios: measured.len(),
    })
}
