//! A scenario's picture: a plan at a few moments, side by side.

use regrasp_api::Configuration;
use regrasp_plan::{Plan, configuration};
use regrasp_view::picture::{Bounds, Picture, Scene};
use regrasp_world::{ChainHand, load_object};

/// How many moments are shown.
const FRAMES: usize = 4;
/// Room about each picture (mm).
const ROOM: f64 = 6.0;

/// Draws a plan at even steps from its first to its last state; `None` where it has no state, or is not of a
/// problem that can be drawn.
pub fn strip(plan: &Plan) -> Option<String> {
    let problem = &plan.scenario.problem;
    let hand = ChainHand::new(problem.hand.clone()).ok()?;
    let object = load_object(&problem.object).ok()?;
    let scene = Scene { hand: &hand, mesh: &object.mesh, obstacles: &problem.obstacle };
    let states: Vec<_> = plan.segments.iter().flat_map(|segment| &segment.states).collect();
    let last = states.len().checked_sub(1)?;
    let moments = (0..FRAMES).map(|k| configuration(states[k * last / (FRAMES - 1)]));
    let moments: Vec<Configuration> = moments.collect::<Result<_, _>>().ok()?;
    let pictures: Vec<Picture> = moments.iter().map(|q| Picture::of(&scene, q)).collect();
    Some(side_by_side(&pictures))
}

fn side_by_side(pictures: &[Picture]) -> String {
    let bounds = pictures.iter().fold(Bounds::NOTHING, |all, picture| all.union(picture.bounds()));
    let [width, height] = bounds.size().map(|size| size + 2.0 * ROOM);
    let all = width * pictures.len() as f64;
    let mut text = format!(
        "<svg viewBox=\"0 0 {all:.1} {height:.1}\" role=\"img\" aria-label=\"the plan at four moments\">"
    );
    for (k, picture) in pictures.iter().enumerate() {
        let (x, y) = (k as f64 * width + ROOM - bounds.low[0], ROOM - bounds.low[1]);
        text += &format!("<g transform=\"translate({x:.1} {y:.1})\">{}</g>", picture.elements());
    }
    text + "</svg>"
}
