//! Where a ball that rolls over the facets one by one would sink into others.

use super::{Follower, SAME, SINK, between};
use crate::closest::{ClosestPoints, closest_of_facet};
use crate::polyhedron::Polyhedron;
use regrasp_api::{Contact, Projection, Vec3};

/// Balls larger than the fingertip by this factor are looked at around a facet: enough for all places of a turn between two
/// facets whose normals differ by [`GENTLE`] at most.
///
/// With n = α n_A + β n_B between the two normals, a point that the ball at n holds lies in one of the balls at n_A and n_B
/// of the radius α + β ≤ 1 / cos(GENTLE / 2).
const SWELL: f64 = 1.021;
/// The cosine of 0.4 rad.
const GENTLE: f64 = 0.921;
/// Facets around one facet that are looked at before it counts as not open: a bound of the time to prepare an object.
const MOST_AROUND: usize = 500;
/// Newton steps before a ball that grazes a facet counts as blocked.
const NEWTON_STEPS: usize = 40;
/// Distance (m) to the depth looked for at which Newton's method has arrived.
const ARRIVED: f64 = 1e-13;

/// For each facet whether a ball that touches it sinks into nothing, wherever on the facet: no facet around rises above its plane.
pub(crate) fn open_facets(polyhedron: &Polyhedron, closest: &ClosestPoints, radius: f64) -> Vec<bool> {
    let is_open = |facet: u32| {
        let corners = &polyhedron.corners[facet as usize];
        let n = polyhedron.mesh.normal(facet);
        let middle = corners.iter().sum::<Vec3>() / 3.0;
        let width = corners.iter().map(|corner| (corner - middle).norm()).fold(0.0, f64::max);
        let mut count = 0;
        !closest.any_box(&(middle + n * (SWELL * radius)), SWELL * radius + width, |other| {
            count += 1;
            count > MOST_AROUND || rises(polyhedron, other, &middle, &n)
        })
    };
    (0..polyhedron.corners.len() as u32).map(is_open).collect()
}

/// Whether a facet rises above the plane through `p` with the normal `n`.
fn rises(polyhedron: &Polyhedron, facet: u32, p: &Vec3, n: &Vec3) -> bool {
    polyhedron.corners[facet as usize].iter().any(|corner| n.dot(&(corner - p)) > SINK / 2.0)
}

/// Part of a path: the contact goes straight, or the ball turns about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub from: Contact,
    pub to: Contact,
    /// Length (m) of the way of the ball's centre.
    pub travel: f64,
}

impl Piece {
    fn is_straight(&self) -> bool {
        self.from.n_O == self.to.n_O
    }

    pub(super) fn at(&self, t: f64) -> Contact {
        between(&self.from, &self.to, t)
    }
}

impl Follower<'_> {
    /// The fractions of a piece at which the ball would begin to sink in, and at which it is out for good; `None` if it never
    /// sinks in by more than `sink` (m). 0 and 1 where the ends themselves are blocked.
    ///
    /// Exact on straight pieces: the distance from a facet is convex along a line, so Newton's method comes to the place
    /// without passing it. Turns are looked at every `step`.
    pub(super) fn blocked(&self, piece: &Piece, sink: f64, near: &mut Vec<u32>) -> Option<[f64; 2]> {
        if self.is_open(piece) {
            return None;
        }
        self.gather(piece, near);
        let (from, to) = (piece.from.tip_center(self.radius), piece.to.tip_center(self.radius));
        if !piece.is_straight() {
            return if near.is_empty() { None } else { self.blocked_turn(piece, sink, near) };
        }
        let mut all: Option<[f64; 2]> = None;
        for &facet in near.iter() {
            if let Some(enter) = self.advance_to(facet, sink, &from, &(to - from)) {
                let leave = 1.0 - self.advance_to(facet, sink, &to, &(from - to)).unwrap_or(1.0);
                let [first, last] = all.unwrap_or([1.0, 0.0]);
                all = Some([enter.min(first), leave.max(last)]);
            }
        }
        all.map(|[enter, leave]| [enter, leave.max(enter)])
    }

    /// Whether no facet can be in the way of a piece, by what is known of its facets.
    fn is_open(&self, piece: &Piece) -> bool {
        let is_open = |contact: &Contact| self.open[contact.facet as usize];
        let is_flat = |contact: &Contact| contact.n_O == self.polyhedron.mesh.normal(contact.facet);
        let (from, to) = (&piece.from, &piece.to);
        let gentle = from.facet == to.facet || from.n_O.dot(&to.n_O) > GENTLE;
        is_open(from) && is_open(to) && is_flat(from) && is_flat(to) && gentle
    }

    /// Collects the facets that the ball may sink into on a piece.
    ///
    /// A point x inside the ball that touches p with the normal n has |x - p|² < 2 r n·(x - p): it lies above n's plane, and on a
    /// turn above the plane of one of the ends.
    fn gather(&self, piece: &Piece, near: &mut Vec<u32>) {
        near.clear();
        let (from, to) = (&piece.from, &piece.to);
        let middle = piece.at(0.5).tip_center(self.radius);
        self.closest.any_box(&middle, self.radius + piece.travel / 2.0, |facet| {
            let over = |contact: &Contact| rises(self.polyhedron, facet, &contact.p_OC, &contact.n_O);
            if over(from) || (!piece.is_straight() && over(to)) {
                near.push(facet);
            }
            false
        });
    }

    /// The fraction of the way `along` (m) from a place at which the ball touches a facet; `None` if it does not reach it.
    fn advance_to(&self, facet: u32, sink: f64, start: &Vec3, along: &Vec3) -> Option<f64> {
        let mut t = 0.0;
        for _ in 0..NEWTON_STEPS {
            let center = start + along * t;
            let Projection { contact, distance } = closest_of_facet(self.polyhedron, &center, facet);
            let gap = distance - (self.radius - sink);
            if gap <= ARRIVED {
                return Some(t);
            }
            let descent = -along.dot(&contact.n_O);
            if descent * (1.0 - t) <= gap {
                return None;
            }
            t += gap / descent;
        }
        Some(t)
    }

    fn blocked_turn(&self, piece: &Piece, sink: f64, near: &[u32]) -> Option<[f64; 2]> {
        let steps = (piece.travel / self.step).ceil().max(1.0);
        let is_blocked = |&step: &usize| {
            let center = piece.at(step as f64 / steps).tip_center(self.radius);
            self.deepest(&center, near).distance < self.radius - sink
        };
        let mut places = 0..=steps as usize;
        let first = places.find(is_blocked)?;
        let last = places.rfind(is_blocked).unwrap_or(first);
        let enter = if first == 0 { 0.0 } else { self.edge_of_free(piece, near, first - 1, first, steps) };
        let leave =
            if last as f64 == steps { 1.0 } else { self.edge_of_free(piece, near, last + 1, last, steps) };
        Some([enter, leave.max(enter)])
    }

    /// The contact with that one of some facets which is closest.
    fn deepest(&self, p_OF: &Vec3, near: &[u32]) -> Projection {
        let tip = |&facet: &u32| closest_of_facet(self.polyhedron, p_OF, facet);
        near.iter().map(tip).min_by(|a, b| a.distance.total_cmp(&b.distance)).expect("some facet is near")
    }

    /// The free place nearest to a blocked one, both given as steps of a turn; as a fraction of the turn.
    ///
    /// Each guess is where the ball just touches the plane of what it last sank into, and in between bisection.
    fn edge_of_free(&self, piece: &Piece, near: &[u32], free: usize, blocked: usize, steps: f64) -> f64 {
        let (mut low, mut high) = (free as f64 / steps, blocked as f64 / steps);
        let center = |t: f64| piece.at(t).tip_center(self.radius);
        let mut wall = self.deepest(&center(high), near).contact;
        while (high - low).abs() * piece.travel > SAME / 4.0 {
            let gap = |t: f64| wall.n_O.dot(&(center(t) - wall.p_OC)) - self.radius;
            let (before, after) = (gap(low), gap(high));
            let certain = before > 0.0 && after < 0.0;
            let t = if certain { low + (high - low) * before / (before - after) } else { (low + high) / 2.0 };
            let tip = self.deepest(&center(t), near);
            if tip.distance < self.radius - SINK {
                (high, wall) = (t, tip.contact);
                continue;
            }
            low = t;
            if certain {
                break;
            }
        }
        low
    }
}
