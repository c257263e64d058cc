//! Which part of the last link is really the fingertip's, by the shapes that are seen.
//!
//! Collision shapes are often plain boxes from joint to joint. That of the last link then reaches to the
//! middle of the fingertip and is wider than it there: on flat faces the box would touch first. Where the
//! visual shapes show that the link ends farther back, and that the tip's own shape goes on from there, they
//! are believed.

use crate::solids::Piece;
use crate::tip::{CLEARANCE, Tip};
use regrasp_api::Vec3;

/// By how much (m) more than what planning keeps the capsule lies inside of the ball: at every contact, this
/// is all the room it has.
const SPARE: f64 = 1e-4;
/// How far (m) the seen shapes of link and tip may be apart and still count as one.
const JOINT: f64 = 1e-3;

/// The shapes that are seen, in the last link's frame L.
pub(crate) struct Seen {
    /// Those of the tip link.
    pub tip: Vec<Piece>,
    /// Those of the other links that move with it.
    pub behind: Vec<Piece>,
}

impl Seen {
    /// `behind`, the collision shapes of the links behind the ball, cut where those links are seen to end,
    /// and a capsule for the tip in its place.
    ///
    /// The capsule lies inside of the tip as it is seen, by what planning keeps between bodies: on a face
    /// that is parallel to the finger the ball still touches, not the capsule. Shapes that tell nothing else
    /// leave `behind` as it is.
    pub fn trimmed(
        &self,
        tip: &Tip,
        behind: Vec<Piece>,
        radius: f64,
        notes: &mut Vec<String>,
        name: &str,
    ) -> Vec<Piece> {
        let n = tip.outward;
        let height = n.dot(&tip.center);
        let Some(end) = self.end(tip, radius) else { return behind };
        let top = reach(&behind, &n);
        if top.min(height) < end + JOINT {
            return behind;
        }
        let mut kept: Vec<Piece> =
            behind.into_iter().filter_map(|piece| crate::tip::below(piece, &n, end)).collect();
        let width = self.width(tip).min(radius - CLEARANCE - SPARE);
        kept.push(rod(tip, width, height - end));
        notes.push(format!(
            "the last link of `{name}` is cut {:.1} mm behind the ball's centre, where its visual shape \
                ends; from there on the tip's own is \
             seen, for which a capsule of {:.1} mm radius stands",
            1e3 * (height - end),
            1e3 * width
        ));
        kept
    }

    /// How far the links behind the tip are seen to reach along the finger, if the tip is seen to go on from
    /// there, no wider than the ball.
    fn end(&self, tip: &Tip, radius: f64) -> Option<f64> {
        let end = reach(&self.behind, &tip.outward);
        let begin = -reach(&self.tip, &-tip.outward);
        (end.is_finite() && begin <= end + JOINT && self.width(tip) <= radius + CLEARANCE).then_some(end)
    }

    /// How wide (m, a radius about the finger's direction) the tip is seen to be.
    fn width(&self, tip: &Tip) -> f64 {
        let aside = |p: &Vec3| (p - tip.center).cross(&tip.outward).norm();
        let wide = |piece: &Piece| piece.corners.iter().map(aside).fold(0.0, f64::max) + piece.radius;
        self.tip.iter().map(wide).fold(0.0, f64::max)
    }
}

fn reach(pieces: &[Piece], n: &Vec3) -> f64 {
    pieces.iter().map(|piece| piece.reach(n)).fold(f64::NEG_INFINITY, f64::max)
}

/// From the ball's centre back by `length`, `radius` wide (m); its round end lies in the link, where it does
/// no harm.
fn rod(tip: &Tip, radius: f64, length: f64) -> Piece {
    let ends = [tip.center, tip.center - tip.outward * length];
    Piece::capsule(ends, radius)
}
