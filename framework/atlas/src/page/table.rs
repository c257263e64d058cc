//! All numbers in one table.

use super::in_words;
use crate::text::escape;
use crate::{Cell, CellSummary, Found, Summary};

/// A row for each hand and object.
pub(super) fn table(cells: &[Cell], summary: &Summary) -> String {
    let rows: String = cells.iter().zip(&summary.cells).map(|(cell, of)| row(cell, of)).collect();
    format!(
        "<section>\n<h2>All numbers</h2>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" \
         aria-label=\"All numbers\"><table>\n<thead><tr><th scope=\"col\">hand</th><th scope=\"col\">shape</th>\
         <th scope=\"col\">size (mm)</th><th scope=\"col\">friction</th><th scope=\"col\">mass (kg)</th>\
         <th scope=\"col\">reached (95 % interval)</th><th scope=\"col\">to 90°</th>\
         <th scope=\"col\">90 to 135°</th><th scope=\"col\">135 to 180°</th>\
         <th scope=\"col\">regrasps, median / 90 %</th><th scope=\"col\">not reached</th></tr></thead>\n\
         <tbody>\n{rows}</tbody>\n</table></div>\n</section>\n"
    )
}

fn row(cell: &Cell, of: &CellSummary) -> String {
    let member = &cell.member;
    let number = |value: Option<f64>| value.map_or("–".to_owned(), |value| value.to_string());
    let mut fields = vec![
        member.shape.name().to_owned(),
        member.size_mm().to_string(),
        member.friction.to_string(),
        number(member.mass),
    ];
    if let Some(cause) = &cell.cause {
        let fields: String = fields.iter().map(|field| format!("<td>{field}</td>")).collect();
        let hand = escape(&member.hand);
        let cause = escape(cause);
        return format!(
            "<tr><th scope=\"row\">{hand}</th>{fields}<td colspan=\"6\">not held: {cause}</td></tr>\n"
        );
    }
    fields.push(in_words(&of.share));
    fields.extend(of.by_angle.iter().map(|share| match share.estimate {
        None => "–".to_owned(),
        Some(estimate) => format!("{:.0} %", 100.0 * estimate.value),
    }));
    fields.push(format!("{} / {}", number(of.regrasps_median), number(of.regrasps_90)));
    fields.push(why(of));
    let fields: String = fields.iter().map(|field| format!("<td>{field}</td>")).collect();
    format!("<tr><th scope=\"row\">{}</th>{fields}</tr>\n", escape(&member.hand))
}

/// How the others ended.
fn why(of: &CellSummary) -> String {
    let word = |found: Found| match found {
        Found::Reached => "",
        Found::NoGrasp => "no grasp there",
        Found::NoWay => "no way found",
        Found::Unverified => "not verified",
    };
    let others = of.found.iter().filter(|(found, count)| **found != Found::Reached && **count > 0);
    others.map(|(found, count)| format!("{} {count}", word(*found))).collect::<Vec<_>>().join(", ")
}
