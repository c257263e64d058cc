//! Draws a plan as a film strip: hand and object at even steps of time, as an SVG picture.
//!
//! `cargo run --release --example film_strip [SCENARIO [FILE.svg]]`
//!
//! A finger that holds the object has a dark tip, a lifted one a red tip. The cross painted on the object shows how it turns.

use regrasp::study::picture::{Bounds, Picture, STYLE, Scene};
use std::error::Error;
use std::fmt::Write;

/// Frames side by side, and rows of them.
const GRID: (usize, usize) = (4, 2);
/// Room about and above a frame (mm).
const ROOM: (f64, f64) = (10.0, 16.0);

/// The frames with their times as one picture.
fn strip(frames: &[(Picture, f64)]) -> Result<String, std::fmt::Error> {
    let bounds = frames.iter().fold(Bounds::NOTHING, |all, (picture, _)| all.union(picture.bounds()));
    let (width, height) = (bounds.size()[0] + 2.0 * ROOM.0, bounds.size()[1] + ROOM.0 + ROOM.1);
    let (all_width, all_height) = (GRID.0 as f64 * width, GRID.1 as f64 * height);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {all_width:.0} {all_height:.0}\">\n<style>{STYLE}</style>\n"
    );
    writeln!(text, "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>")?;
    for (k, (picture, time)) in frames.iter().enumerate() {
        let (left, top) = ((k % GRID.0) as f64 * width, (k / GRID.0) as f64 * height);
        let (x, y) = (left + ROOM.0 - bounds.low[0], top + ROOM.1 - bounds.low[1]);
        writeln!(text, "<g transform=\"translate({x:.1} {y:.1})\">\n{}</g>", picture.elements())?;
        let (x, y) = (left + width / 2.0, top + 12.0);
        writeln!(
            text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-family=\"sans-serif\" font-size=\"9\" text-anchor=\"middle\">{time:.1} s</text>"
        )?;
    }
    Ok(text + "</svg>\n")
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let name = words.next().unwrap_or("sphere".into());
    let file = words.next().unwrap_or(format!("{name}.svg"));
    let scenario = regrasp::load(&name)?;
    let run = regrasp::solve(&scenario, 0)?;
    let segments = run.outcome.motion.segments.iter();
    let states: Vec<_> = segments.flat_map(|segment| segment.states.iter().zip(&segment.times)).collect();
    let Some(last) = states.len().checked_sub(1) else {
        return Err(format!("`{name}` was not solved: there is nothing to draw").into());
    };
    let (hand, obstacles) = (scenario.hand.as_ref(), scenario.problem.obstacle.as_slice());
    let scene = Scene { hand, mesh: &scenario.object.mesh, obstacles };
    let count = GRID.0 * GRID.1;
    let at = |k: usize| states[k * last / (count - 1)];
    let frames: Vec<_> = (0..count).map(at).map(|(q, time)| (Picture::of(&scene, q), *time)).collect();
    std::fs::write(&file, strip(&frames)?)?;
    println!("{file}: {count} frames of a motion of {:.1} s", states[last].1);
    Ok(())
}
