//! Pictures of a hand with its object, as SVG: seen from the front, 35° from above, without perspective.
//!
//! A finger that holds the object has a dark tip, a lifted one a red tip. The cross painted on the object
//! shows how it turns. Colours are classes, so that a page can have its own: [`STYLE`] is what they are by
//! default.

mod annotate;
mod body;
mod outline;
mod sheet;
mod view;

pub use sheet::sheet;
pub use view::Bounds;

use regrasp_api::{Configuration, Mesh, ObstacleDescription};
use regrasp_world::ChainHand;
use view::Point;

/// The rules that give the classes of a picture their colours.
pub const STYLE: &str = include_str!("picture.css");

/// What is seen in every picture of a problem.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The hand, its palm included.
    pub hand: &'a ChainHand,
    /// The object's surface, in O.
    pub mesh: &'a Mesh,
    /// The obstacles; meshes must be given in place, half-spaces are not drawn.
    pub obstacles: &'a [ObstacleDescription],
}

/// One picture, in millimetres on the paper: x to the right, y downwards, the hand's origin at zero.
pub struct Picture {
    bounds: Bounds,
    /// What is drawn, with its depth: larger is nearer.
    strokes: Vec<(f64, String)>,
}

impl Picture {
    /// Draws a configuration.
    pub fn of(scene: &Scene<'_>, q: &Configuration) -> Self {
        let mut picture = Self { bounds: Bounds::NOTHING, strokes: Vec::new() };
        picture.draw_obstacles(scene);
        picture.draw_object(scene.mesh, &q.X_HO);
        picture.draw_fingers(scene.hand, q);
        picture.strokes.sort_by(|a, b| a.0.total_cmp(&b.0));
        picture
    }

    /// The part of the paper that is drawn on.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The elements of the picture, from the farthest to the nearest, to be put into an `svg` or `g` element.
    pub fn elements(&self) -> String {
        self.strokes.iter().map(|(_, stroke)| format!("{stroke}\n")).collect()
    }

    /// Adds an element that reaches `radius` (mm) round these points.
    fn add(&mut self, depth: f64, points: &[Point], radius: f64, element: String) {
        points.iter().for_each(|point| self.bounds.include(point, radius));
        self.strokes.push((depth, element));
    }
}

#[cfg(test)]
mod tests;
