//! Which size of a cube suits a hand? A small atlas: two hands, three sizes, twelve orientations each.
//!
//! `cargo run --release --example 14_an_atlas`
//!
//! `regrasp atlas` does the same for more of everything, and draws a page. Whoever is told of the members may
//! keep them; here they stay in memory.

use regrasp::Stopwatch;
use regrasp::atlas::{AtlasError, AtlasHand, Cell, Shape, Summary, Told, Wish, explore};
use regrasp::host::Registry;
use std::error::Error;

/// Keeps all members.
#[derive(Default)]
struct Cells(Vec<Cell>);

impl Told for Cells {
    fn done(&mut self, cell: &Cell) -> Result<(), AtlasError> {
        self.0.push(cell.clone());
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let hands = ["free-fingertips", "four-finger"].map(AtlasHand::load);
    let hands = hands.into_iter().collect::<Result<Vec<_>, _>>()?;
    let wish = Wish { shapes: vec![Shape::Cube], sizes: vec![0.02, 0.05, 0.5], goals: 12, ..Wish::default() };
    let (watch, mut cells) = (Stopwatch::start(), Cells::default());
    explore(&wish, &hands, &[], &Registry::linked()?, (1, &watch, &watch), &mut cells)?;
    let mut cells = cells.0;
    cells.sort_by_key(|cell| cell.number);

    let summary = Summary::of(&cells);
    println!("hand             cube    orientations reached (95 %)  regrasps, median");
    for (cell, of) in cells.iter().zip(&summary.cells) {
        let head = format!("{:<15} {:>3.0} mm", cell.member.hand, 1e3 * cell.member.size);
        let (Some(share), None) = (of.share.estimate, &cell.cause) else {
            println!("{head}    none: {}", cell.cause.as_deref().unwrap_or("nothing was tried"));
            continue;
        };
        let (low, high) = (100.0 * share.low, 100.0 * share.high);
        let regrasps = of.regrasps_median.map_or("-".into(), |median| median.to_string());
        println!(
            "{head} {:>7} of {} ({low:.0} to {high:.0} %) {regrasps:>15}",
            of.share.reached, of.share.of
        );
    }
    // Nobody holds half a metre; what the free fingertips reach, bound ones reach too or not.
    assert!(cells.iter().filter(|cell| cell.member.size > 0.4).all(|cell| cell.attempts.is_empty()));
    assert!(summary.cells.iter().any(|of| of.share.reached > of.share.of / 2));
    Ok(())
}
