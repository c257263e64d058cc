//! The scenario's text, with a comment for each key.

use super::answers::{GoalChoice, HandGiven, ObjectChoice, quoted};
use crate::outputs::SCENARIO_MARK;

/// The text; `start` is the object's position in the hand's frame (m).
pub(super) fn scenario(
    hand: &HandGiven,
    object: &ObjectChoice,
    goal: &GoalChoice,
    start: [f64; 3],
    fingers: usize,
) -> String {
    let shape = match object {
        ObjectChoice::Shape { table, .. } => table.clone(),
        ObjectChoice::Mesh(path) => {
            format!("{{ kind = \"mesh\", file = {} }} # `scale` makes it smaller or larger", quoted(path))
        }
    };
    let position = |p: [f64; 3]| format!("[{:.4}, {:.4}, {:.4}]", p[0], p[1], p[2]);
    let end = match goal {
        GoalChoice::Turn { axis, degrees } => {
            format!("position = {}, axis = {axis:?}, angle_deg = {degrees:?}", position(start))
        }
        GoalChoice::Move(by) => format!("position = {}", position([0, 1, 2].map(|k| start[k] + by[k]))),
    };
    let soft = match fingers {
        3 => {
            "\n# Three fingers: two hold while one moves, which takes soft contacts.\n\
              [plugins.contact-model]\nuse = \"soft-finger\"\n"
        }
        _ => "",
    };
    format!(
        "{SCENARIO_MARK}\n\
         # Lengths in m, masses in kg, angles in degrees. `regrasp schema` says every key, the book \
         explains them.\n\
         \n[hand]\n{hand}\n\
         \n[object]\nmass = 0.1 # kg\nfriction = 0.8 # between fingertips and object\nshape = {shape}\n\
         \n# Uncomment to plan for weight and thinner friction within the joints' efforts:\n\
         # [hold]\n# friction_factor = 0.7\n\
         \n[start]\npose = {{ position = {start} }} # of the object's frame in the hand's\n\
         \n# One table for each goal, visited in turn.\n\
         [[goal]]\npose = {{ {end} }}\n{soft}",
        hand = hand.line(),
        start = position(start),
    )
}
