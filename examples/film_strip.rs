//! Draws a plan as a film strip: hand and object at even steps of time, as an SVG picture.
//!
//! `cargo run --release --example film_strip [SCENARIO [FILE.svg]]`
//!
//! A finger that holds the object has a dark tip, a lifted one a red tip. The cross painted on the object
//! shows how it turns.

use regrasp::view::picture::{Picture, Scene, sheet};
use std::error::Error;

/// How many frames, and how many side by side.
const FRAMES: (usize, usize) = (8, 4);

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
    let (count, columns) = FRAMES;
    let at = |k: usize| states[k * last / (count - 1)];
    let frame = |(q, time): (_, &f64)| (Picture::of(&scene, q), format!("{time:.1} s"));
    std::fs::write(&file, sheet(&(0..count).map(at).map(frame).collect::<Vec<_>>(), columns))?;
    println!("{file}: {count} frames of a motion of {:.1} s", states[last].1);
    Ok(())
}
