//! `report.html`: one page that holds all it needs and asks the network for nothing.
//!
//! Rust computes every figure; the script only draws, and filters. Text of users reaches the page as JSON in
//! which no `<` is left, and the script puts it in as text, never as HTML.

mod data;
mod strip;
mod verdicts;

pub use strip::strip;

use super::{Cell, Family, Study};
use data::page_data;

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");

/// The parts of the page's script, in the order in which they build upon each other.
const SCRIPT: [&str; 3] = [include_str!("draw.js"), include_str!("charts.js"), include_str!("page.js")];

/// The text of `report.html`.
///
/// `strips` are pictures of the scenarios, as [`strip`] makes them, in the order of the study's scenarios;
/// `None` where there is none.
pub fn html(study: &Study, rows: &[Vec<Cell<'_>>], family: &Family, strips: &[Option<String>]) -> String {
    let data = page_data(study, rows, family, strips);
    let data = serde_json::to_string(&data).expect("plain data is written without fault");
    let parts = [
        ("/*STYLE*/", format!("{}{STYLE}", regrasp_view::picture::STYLE)),
        // Within a script a `<` could end it (`</script>`) or hide its end (`<!--`); in JSON it only occurs
        // in strings.
        ("/*DATA*/", data.replace('<', "\\u003c")),
        ("/*SCRIPT*/", SCRIPT.concat()),
    ];
    // One pass over the page: what is put in is never searched for marks.
    let mut text = String::new();
    let mut rest = PAGE;
    for (mark, part) in parts {
        let (before, after) = rest.split_once(mark).expect("the page has every mark, in this order");
        text += before;
        text += &part;
        rest = after;
    }
    text + rest
}

#[cfg(test)]
mod tests;
