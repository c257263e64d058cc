//! A plan in a few moments.

use regrasp::api::Configuration;
use regrasp::plan::Motion;
use regrasp::run::scenario::Scenario;
use regrasp::view::picture::{Picture, Scene, sheet};

/// How many moments are shown, side by side.
const MOMENTS: usize = 4;

/// Draws a motion at even steps of time, from its first to its last state.
pub fn strip(scenario: &Scenario, motion: &Motion) -> String {
    let (hand, obstacles) = (scenario.hand.as_ref(), scenario.problem.obstacle.as_slice());
    let scene = Scene { hand, mesh: &scenario.object.mesh, obstacles };
    let states = motion.segments.iter().flat_map(|segment| segment.states.iter().zip(&segment.times));
    let states: Vec<(&Configuration, &f64)> = states.collect();
    let end = states.last().map_or(0.0, |(_, time)| **time);
    let moments = (0..MOMENTS).map(|k| end * k as f64 / (MOMENTS - 1) as f64);
    let at = |moment: f64| states.iter().find(|(_, time)| **time >= moment - 1e-9).or(states.last());
    let frames = moments.filter_map(at).map(|(q, time)| (Picture::of(&scene, q), format!("{time:.1} s")));
    // The comment by which the program knows its own picture.
    sheet(&frames.collect::<Vec<_>>(), MOMENTS).replacen("<style>", "<!-- regrasp-gallery -->\n<style>", 1)
}
