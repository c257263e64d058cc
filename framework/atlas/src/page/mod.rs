//! The page: curves over size and friction, maps of turns, and the table, hands side by side.
//!
//! One HTML file that needs no script and loads nothing. Every picture has its numbers beside it: in the
//! table, or in words that a pointer or a screen reader finds at each mark.

mod axis;
mod curves;
mod map;
mod table;

use crate::text::escape;
use crate::{AtlasHand, Cell, Summary, Wish};
use curves::Curves;

const STYLE: &str = include_str!("style.css");

/// The text of `atlas.html`.
pub fn page(wish: &Wish, hands: &[AtlasHand], cells: &[Cell], summary: &Summary) -> String {
    let curves = Curves { hands, cells, summary };
    let body = [
        head(wish, hands, cells),
        curves.over_size(wish),
        curves.over_friction(wish),
        map::maps(hands, summary),
        table::table(cells, summary),
    ];
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta name=\"generator\" content=\"regrasp atlas\">\n\
         <title>Atlas – Regrasp</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n{}</body>\n</html>\n",
        body.concat()
    )
}

/// What the atlas is about, and what its figures mean.
fn head(wish: &Wish, hands: &[AtlasHand], cells: &[Cell]) -> String {
    let names: Vec<String> = hands.iter().map(named).collect();
    let goals: usize = cells.iter().map(|cell| cell.attempts.len()).sum();
    let asked = match wish.masses.is_empty() {
        true => "Grasps must close, whatever the force.",
        false => "Grasps must hold the object's weight within the joints' efforts.",
    };
    format!(
        "<header>\n<h1>What these hands can do</h1>\n<p>{}.</p>\n\
         <p>From a start grasp about the middle of where the hand can hold the object, the object was to be \
         turned into an orientation drawn uniformly from all, {} for each hand and object, {goals} in all; it \
         may end within {} mm of where it was. A share counts the orientations to which a verified plan leads. \
         It is a lower bound: each search had {} nodes for each of {} positions. Bars and brackets are 95 % \
         intervals (Wilson). {asked}</p>\n</header>\n",
        names.join(", "),
        wish.goals,
        wish.reach * 1e3,
        wish.nodes,
        wish.tries,
    )
}

/// A hand's name, and what it touches with.
fn named(hand: &AtlasHand) -> String {
    let tips = if hand.is_soft() { "soft" } else { "hard" };
    format!("{} ({} fingers, {tips} tips)", escape(&hand.name), hand.fingers())
}

/// A share in percent, with its interval and its count, in words.
fn in_words(share: &crate::Share) -> String {
    let percent = |x: f64| format!("{:.0}", 100.0 * x);
    match share.estimate {
        None => "nothing was tried".into(),
        Some(estimate) => format!(
            "{} % ({} to {} %), {} of {}",
            percent(estimate.value),
            percent(estimate.low),
            percent(estimate.high),
            share.reached,
            share.of
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::tests::{attempt, cell};

    fn made() -> String {
        let attempts = |n: usize| {
            let one = |k: usize| attempt([0.0, 0.6, 0.8], 60.0 * k as f64, (k <= n).then_some(k));
            (0..4).map(one).collect::<Vec<_>>()
        };
        let hands = ["four-finger", "three-finger"].map(|name| AtlasHand::load(name).unwrap());
        let cells = [
            cell(0, "four-finger", 0.03, attempts(3)),
            cell(1, "four-finger", 0.05, attempts(1)),
            cell(2, "three-finger", 0.03, attempts(2)),
            cell(3, "three-finger", 0.05, Vec::new()),
        ];
        page(&Wish::default(), &hands, &cells, &Summary::of(&cells))
    }

    #[test]
    fn the_page_stands_alone_and_is_well_formed() {
        let page = made();
        for bad in ["http:", "https:", "src=", "<script", "NaN", "inf"] {
            let text = page.replace("http://www.w3.org/2000/svg", "");
            assert!(!text.contains(bad), "{bad}");
        }
        for tag in ["svg", "g", "table", "tr", "td", "th", "text", "section", "details", "title", "p"] {
            let (open, close) =
                (page.matches(&format!("<{tag}>")).count(), page.matches(&format!("</{tag}>")).count());
            let open = open + page.matches(&format!("<{tag} ")).count();
            assert_eq!(open, close, "{tag}");
        }
    }

    #[test]
    fn axes_have_ticks_and_units_and_marks_have_words() {
        let page = made();
        for text in ["size (mm)", "orientations reached (%)", ">100<", ">30<", ">50<", "no grasp in 7 poses"]
        {
            assert!(page.contains(text), "{text}");
        }
        assert!(page.matches("role=\"img\"").count() >= 3);
        assert!(page.contains("<title>four-finger, 30 mm: 100 %"), "marks have words");
    }
}
