//! What is told of an atlas.

use crate::table::Table;
use regrasp::atlas::{Cell, CellSummary, Summary};
use std::path::Path;

/// A table with a row for each hand and object, and what became of those that cannot be held.
pub fn text(cells: &[Cell], summary: &Summary, page: &Path) -> String {
    let head =
        ["hand", "shape", "mm", "friction", "kg", "reached", "of", "share", "95 % interval", "regrasps"];
    let mut table = Table::new("<<>", &head);
    let mut causes = String::new();
    for (cell, of) in cells.iter().zip(&summary.cells) {
        table.row(row(cell, of));
        if let Some(cause) = &cell.cause {
            causes += &format!("  {}: {cause}\n", cell.member.title());
        }
    }
    let mut text = format!("{}  regrasps: median of the plans\n", table.text());
    if !causes.is_empty() {
        text += &format!("not held:\n{causes}");
    }
    text + &format!("page: {}\n", page.display())
}

fn row(cell: &Cell, of: &CellSummary) -> Vec<String> {
    let member = &cell.member;
    let percent = |x: f64| format!("{:.0}", 100.0 * x);
    let share = of.share.estimate;
    vec![
        member.hand.clone(),
        member.shape.name().into(),
        member.size_mm().to_string(),
        member.friction.to_string(),
        member.mass.map_or("-".into(), |mass| mass.to_string()),
        of.share.reached.to_string(),
        of.share.of.to_string(),
        share.map_or("-".into(), |share| percent(share.value) + " %"),
        share.map_or("-".into(), |share| format!("{}-{} %", percent(share.low), percent(share.high))),
        of.regrasps_median.map_or("-".into(), |median| median.to_string()),
    ]
}
