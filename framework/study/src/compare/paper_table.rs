//! Table 1 of the paper beside ours.

use super::statistics::{quantile, sorted};
use super::{Figure, RunRecord, RunStatus};
use regrasp_run::scenario::PaperFigures;

/// A scenario's runs beside what was published about it.
pub struct PaperRow<'a> {
    /// The scenario's name.
    pub scenario: &'a str,
    /// What was published.
    pub paper: Option<&'a PaperFigures>,
    /// Our runs, a run a seed.
    pub runs: Vec<&'a RunRecord>,
}

/// The table as lines of text, a row a scenario.
///
/// The paper: A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous manipulation
/// planning", SSD 2007, Table 1: averages on an Athlon64 3500+. It gives no dimensions, so that the problems
/// are alike, not the same. Ours are over all runs, solved or not: how many were solved and how many
/// verified, quantiles of the planning time on one thread (ms), medians of nodes and regrasps.
pub fn paper_table(rows: &[PaperRow<'_>]) -> String {
    let wide = rows.iter().map(|row| row.scenario.chars().count()).max().unwrap_or(0).max(15);
    let seeds = rows.iter().map(|row| row.runs.len()).max().unwrap_or(0);
    let space = "";
    let mut text = format!(
        "{space:<wide$} the paper (averages)  | ours over {seeds} seeds: one thread, medians, planning \
            alone in ms\n\
         {space:<wide$}   time genrtd  graph  | solved verified   median      90%  slowest generated graph \
         regrasps\n"
    );
    for row in rows {
        text += &format!("{:<wide$} {}  | {}\n", row.scenario, published(row.paper), ours(&row.runs));
    }
    text
}

fn published(paper: Option<&PaperFigures>) -> String {
    let Some(paper) = paper else { return "     -      -      -".into() };
    let time = format!("{} s", paper.time_s);
    format!("{time:>6} {:>6} {:>6}", paper.generated_nodes, paper.graph_nodes)
}

fn ours(runs: &[&RunRecord]) -> String {
    let solved = runs.iter().filter(|run| run.status == RunStatus::Solved).count();
    let verified = runs.iter().filter(|run| run.is_success()).count();
    let of = |figure: Figure, share: f64, scale: f64| {
        let values = sorted(runs.iter().filter_map(|run| figure.of(run)));
        quantile(&values, share).map_or(f64::NAN, |value| value * scale)
    };
    let ms = |share| of(Figure::Planning, share, 1e3);
    format!(
        "{solved:>6} {verified:>8} {:>8.1} {:>8.1} {:>8.1} {:>9.0} {:>5.0} {:>8.0}",
        ms(0.5),
        ms(0.9),
        ms(1.0),
        of(Figure::GeneratedNodes, 0.5, 1.0),
        of(Figure::GraphNodes, 0.5, 1.0),
        of(Figure::Regrasps, 0.5, 1.0)
    )
}
