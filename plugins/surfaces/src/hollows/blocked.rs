//! Where a ball that rolls over the facets one by one would sink into others.

use super::above::{self, rises};
use super::{Follower, PARALLEL, SAME, SINK, between};
use crate::closest::closest_of_facet;
use regrasp_api::{Contact, Projection, Vec3, Waypoint};

/// Newton steps before a ball that grazes a facet counts as blocked.
const NEWTON_STEPS: usize = 40;
/// Distance (m) to the depth looked for at which Newton's method has arrived.
const ARRIVED: f64 = 1e-13;

/// Part of a path: the contact goes straight, or the ball turns about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub from: Contact,
    pub to: Contact,
    /// Length (m) of the way of the ball's centre.
    pub travel: f64,
}

impl Piece {
    pub(super) fn new(from: &Waypoint, to: &Waypoint) -> Self {
        Self { from: from.contact, to: to.contact, travel: to.lift_length - from.lift_length }
    }

    fn is_straight(&self) -> bool {
        self.from.n_O == self.to.n_O
    }

    /// Whether this is a turn with a straight piece ahead.
    pub(super) fn is_between(&self, next: &Self) -> bool {
        !self.is_straight() && next.is_straight()
    }

    pub(super) fn at(&self, t: f64) -> Contact {
        between(&self.from, &self.to, t)
    }
}

impl Follower<'_> {
    /// The fractions of a piece at which the ball would begin to sink in, and at which it is out for good;
    /// `None` if it never sinks in by more than `sink` (m). 0 and 1 where the ends themselves are blocked.
    ///
    /// Exact on straight pieces: the distance from a facet is convex along a line, so Newton's method comes
    /// to the place without passing it. Turns are looked at every `step`.
    pub(super) fn blocked(&self, piece: &Piece, sink: f64, near: &mut Vec<u32>) -> Option<[f64; 2]> {
        if self.turns_freely(piece) {
            return None;
        }
        self.obstacles(piece, near);
        if near.is_empty() {
            return None;
        }
        let (from, to) = (piece.from.tip_center(self.radius), piece.to.tip_center(self.radius));
        if !piece.is_straight() {
            return self.blocked_turn(piece, sink, near);
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

    /// Collects the facets that the ball may sink into on a piece.
    ///
    /// A point x inside the ball that touches p with the normal n has |x - p|² < 2 r n·(x - p): it lies above
    /// n's plane, and on a turn above the plane of one of the ends.
    fn obstacles(&self, piece: &Piece, near: &mut Vec<u32>) {
        near.clear();
        let (from, to) = (&piece.from, &piece.to);
        let middle = piece.at(0.5).tip_center(self.radius);
        let reach = self.radius + piece.travel / 2.0;
        if let Some([over_from, over_to]) = self.known(piece) {
            let is_near = |facet: &&u32| self.above.comes_within(**facet, &middle, reach);
            near.extend(over_from.iter().chain(over_to).filter(is_near));
            return;
        }
        self.closest.any_box(&middle, reach, |facet| {
            let over = |contact: &Contact| rises(self.polyhedron, facet, &contact.p_OC, &contact.n_O);
            if over(from) || (!piece.is_straight() && over(to)) {
                near.push(facet);
            }
            false
        });
    }

    /// The facets above those of a piece's ends, where they are known and nothing else can be in the way.
    fn known(&self, piece: &Piece) -> Option<[&[u32]; 2]> {
        let (from, to) = (&piece.from, &piece.to);
        if !self.is_flat(from) || !self.is_flat(to) {
            return None;
        }
        if from.facet == to.facet {
            return Some([self.above.facet(from.facet)?, &[]]);
        }
        let gentle = from.n_O.dot(&to.n_O) > above::GENTLE;
        gentle.then_some([self.above.facet(from.facet)?, self.above.facet(to.facet)?])
    }

    /// Whether balls at both ends of a turn, so large that together they hold every ball in between, sink
    /// into nothing.
    fn turns_freely(&self, piece: &Piece) -> bool {
        let (from, to) = (&piece.from, &piece.to);
        let cos = from.n_O.dot(&to.n_O);
        if piece.is_straight() || cos < above::GENTLE || !self.is_flat(from) || !self.is_flat(to) {
            return false;
        }
        let radius = self.radius / ((1.0 + cos) / 2.0).sqrt();
        [from, to].into_iter().all(|contact| {
            let p_OB = contact.tip_center(radius);
            self.above
                .facet(contact.facet)
                .is_some_and(|known| !self.is_hit(known, &p_OB, radius - SINK / 2.0))
        })
    }

    /// Whether one of some facets comes within `reach` (m) of a place.
    fn is_hit(&self, facets: &[u32], p_OF: &Vec3, reach: f64) -> bool {
        facets.iter().any(|&facet| {
            self.above.comes_within(facet, p_OF, reach)
                && closest_of_facet(self.polyhedron, p_OF, facet).distance < reach
        })
    }

    /// Whether a contact has its facet's normal.
    fn is_flat(&self, contact: &Contact) -> bool {
        (contact.n_O - self.polyhedron.mesh.normal(contact.facet)).norm_squared() < PARALLEL * PARALLEL
    }

    /// Whether the ball at a contact touches nothing but the contact point.
    pub fn is_free(&self, contact: &Contact, sink: f64) -> bool {
        let (p_OF, least) = (contact.tip_center(self.radius), self.radius - sink);
        let known = if self.is_flat(contact) { self.above.facet(contact.facet) } else { None };
        known.map_or_else(
            || self.closest.is_clear(self.polyhedron, &p_OF, least),
            |known| !self.is_hit(known, &p_OF, least),
        )
    }

    /// The fraction of the way `along` (m) from a place at which the ball touches a facet; `None` if it does
    /// not reach it.
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
            self.is_hit(near, &center, self.radius - sink)
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
    /// Each guess is where the ball just touches the plane of what it last sank into, and in between
    /// bisection.
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
