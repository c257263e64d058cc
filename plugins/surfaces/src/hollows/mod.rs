//! The fingertip's path on a solid that is not convex: where its ball would sink in, it slides over the
//! hollow.
//!
//! The path that rolls over the facets one by one is followed as long as the ball touches nothing else
//! (`blocked`). Where it would sink in, the ball leaves the path at the last free place and goes to the next
//! free place along the offset surface: straight, pushed out (or back) wherever the straight way does not
//! touch (`touch`). In a concave edge both places are the same, and the contact jumps from one facet to the
//! other.

mod above;
mod blocked;
mod touch;

use crate::closest::{ClosestPoints, closest_of_facet};
use crate::lift::angle;
use crate::polyhedron::Polyhedron;
pub(crate) use above::Above;
use blocked::Piece;
use regrasp_api::{Contact, SurfacePath, Waypoint, slerp_normals};
use touch::Touch;

/// Depth (m) to which the ball may sink into the facets: rounding, far below every tolerance of a plan.
const SINK: f64 = 1e-10;
/// The same (m) between two places in a hollow, each of which may sink in to [`SINK`].
const SLACK: f64 = 5.0 * SINK;
/// How far (m) a way between two waypoints may stray from the offset surface.
const STRAY: f64 = 5e-7;
/// How far (m), in fingertip radii, the contact of a waypoint may lie from the point that the ball touches:
/// so far the normals differ (rad).
const ASIDE: f64 = 1e-4;
/// Directions (unit vectors) that differ by less are one.
const PARALLEL: f64 = 1e-9;
/// Two centres this close (m) are one place.
const SAME: f64 = 2e-10;
/// Places looked at in one hollow before the fingertip counts as stuck.
const MOST_PLACES: usize = 2000;

/// Memory of a path's making, kept between calls; nothing of one call shows in the next.
#[derive(Debug, Default)]
pub(crate) struct Room {
    rolled: Vec<Waypoint>,
    /// Facets near one piece of the path.
    near: Vec<u32>,
}

/// Follows a path with a ball of one radius.
pub(crate) struct Follower<'a> {
    pub polyhedron: &'a Polyhedron,
    pub closest: &'a ClosestPoints,
    pub above: &'a Above,
    pub radius: f64,
    /// Largest distance (m) between two places that are looked at on turns and in hollows.
    pub step: f64,
}

impl Follower<'_> {
    /// Rewrites `path`, whose waypoints roll over the facets, so that the ball sinks into nothing; `false`
    /// where it cannot go.
    pub fn follow(&self, path: &mut SurfacePath, room: &mut Room) -> bool {
        let Room { rolled, near } = room;
        rolled.clear();
        rolled.append(&mut path.waypoints);
        let (first, last) = (rolled[0].contact, rolled[rolled.len() - 1].contact);
        path.waypoints.push(Waypoint { contact: first, lift_length: 0.0 });
        // The ends were given: they may be as inexact as the caller's arithmetic.
        if !self.is_free(&first, STRAY) || !self.is_free(&last, STRAY) {
            return false;
        }
        let mut left_at: Option<Touch> = None;
        let mut looked_ahead = None;
        for index in 1..rolled.len() {
            let piece = Piece::new(&rolled[index - 1], &rolled[index]);
            let next = rolled.get(index + 1).map(|after| Piece::new(&rolled[index], after));
            let blocked = match (looked_ahead.take(), next) {
                (Some(known), _) => known,
                (None, Some(next)) if piece.travel <= self.step && piece.is_between(&next) => {
                    let ahead = self.blocked(&next, SINK, near);
                    looked_ahead = Some(ahead);
                    self.blocked_before(&piece, ahead, left_at.is_some(), near)
                }
                (None, _) => self.blocked(&piece, SINK, near),
            };
            if !self.pass(path, &piece, blocked, &mut left_at, near) {
                return false;
            }
        }
        // An end that was given is free, whatever rounding says.
        left_at.is_none_or(|left| self.slide(path, &left, &self.touch(last), near))
    }

    /// What of a short turn is blocked: only its ends are looked at, and they are its neighbours' too.
    fn blocked_before(
        &self,
        turn: &Piece,
        ahead: Option<[f64; 2]>,
        is_away: bool,
        near: &mut Vec<u32>,
    ) -> Option<[f64; 2]> {
        match ahead {
            _ if is_away => Some([0.0, 1.0]),
            Some([0.0, _]) => self.blocked(turn, SINK, near),
            _ => None,
        }
    }

    /// Appends a piece of the rolled path of which a part may be blocked; `left_at` is where the ball left it
    /// for a hollow, before and after.
    fn pass(
        &self,
        path: &mut SurfacePath,
        piece: &Piece,
        blocked: Option<[f64; 2]>,
        left_at: &mut Option<Touch>,
        near: &mut Vec<u32>,
    ) -> bool {
        if let Some(left) = left_at.as_ref().filter(|_| blocked.is_none_or(|[enter, _]| enter > 0.0)) {
            if !self.slide(path, left, &self.touch(piece.from), near) {
                return false;
            }
            *left_at = None;
        }
        if let Some([enter, leave]) = blocked {
            let left = left_at.get_or_insert_with(|| {
                let contact = if enter > 0.0 { piece.at(enter) } else { piece.from };
                self.advance(path, contact);
                self.touch(contact)
            });
            if leave >= 1.0 {
                return true;
            }
            if !self.slide(path, left, &self.touch(piece.at(leave)), near) {
                return false;
            }
            *left_at = None;
        }
        self.advance(path, piece.to);
        true
    }

    /// Appends the way of the ball between two places along the offset surface.
    fn slide(&self, path: &mut SurfacePath, from: &Touch, to: &Touch, near: &mut Vec<u32>) -> bool {
        if self.go_straight(path, (from, to), near).is_some() {
            self.advance(path, to.contact);
            return true;
        }
        let mut budget = MOST_PLACES;
        let steps = ((to.p_OF - from.p_OF).norm() / (1.4 * self.step)).ceil().max(1.0);
        let mut before = *from;
        for step in 1..=steps as usize {
            let t = step as f64 / steps;
            let here = if t < 1.0 { self.settle(&from.p_OF.lerp(&to.p_OF, t)) } else { Some(*to) };
            match here.and_then(|here| self.join(path, (&before, &here), 0, &mut budget, near)) {
                Some(reached) => before = reached,
                None => return false,
            }
        }
        // At the same place the contact may have to jump once more.
        self.advance(path, to.contact);
        true
    }

    /// Appends waypoints until the ways between them stay on the offset surface; the touch at the end, or
    /// `None` if stuck.
    fn join(
        &self,
        path: &mut SurfacePath,
        (from, to): (&Touch, &Touch),
        depth: i32,
        budget: &mut usize,
        near: &mut Vec<u32>,
    ) -> Option<Touch> {
        let gap = (to.p_OF - from.p_OF).norm();
        if let Some(reached) = self.go_straight(path, (from, to), near) {
            return Some(reached);
        }
        // Halves of a continuous way get shorter and shorter; those of a leap do not.
        if *budget == 0 || gap > 16.0 * self.step * 0.7_f64.powi(depth) {
            return None;
        }
        *budget -= 1;
        if let Some((left, taken)) = self.corner(from, to, gap) {
            self.join(path, (from, &left), depth + 1, budget, near)?;
            self.advance(path, taken.contact);
            return self.join(path, (&taken, to), depth + 1, budget, near);
        }
        let middle = || self.settle(&from.p_OF.lerp(&to.p_OF, 0.5));
        let via = self.knee(from, to).or_else(middle)?;
        let via = self.join(path, (from, &via), depth + 1, budget, near)?;
        self.join(path, (&via, to), depth + 1, budget, near)
    }

    /// Appends the straight way between two places if it stays on the offset surface; the touch at its end.
    fn go_straight(
        &self,
        path: &mut SurfacePath,
        (from, to): (&Touch, &Touch),
        near: &mut Vec<u32>,
    ) -> Option<Touch> {
        let to = self.keep(from, to);
        let gap = (to.p_OF - from.p_OF).norm();
        if gap > SAME && !self.is_direct(from, &to, gap, near) {
            // The ball may touch what is ahead already.
            let ahead = self.keep(&to, from);
            if ahead.contact.facet == from.contact.facet || !self.is_direct(&ahead, &to, gap, near) {
                return None;
            }
            self.advance(path, ahead.contact);
        }
        self.advance(path, to.contact);
        Some(to)
    }

    /// Whether the contact may go straight from one place to the next.
    fn is_direct(&self, from: &Touch, to: &Touch, gap: f64, near: &mut Vec<u32>) -> bool {
        let (a, b) = (from.contact, to.contact);
        if a.facet == b.facet && (a.n_O - b.n_O).norm_squared() < 1e-20 {
            // A straight line between two points of a facet stays in it.
            let piece = Piece { from: a, to: Contact { n_O: a.n_O, ..b }, travel: gap };
            return self.blocked(&piece, SLACK, near).is_none();
        }
        if gap > 1.5 * self.step {
            return false;
        }
        let places: &[f64] = if gap > self.step / 2.0 { &[0.5, 0.25, 0.75] } else { &[0.5] };
        places.iter().all(|&t| {
            let contact = between(&a, &b, t);
            let p_OF = contact.tip_center(self.radius);
            // The ball touches one of the ends' facets where the contact says, and nothing else first; in a
            // concave edge it touches both, and either is right.
            let touched = [a.facet, b.facet].into_iter().filter_map(|facet| {
                let tip = closest_of_facet(self.polyhedron, &p_OF, facet);
                let is_there = (tip.contact.p_OC - contact.p_OC).norm() < ASIDE * self.radius;
                (is_there && (tip.distance - self.radius).abs() < STRAY).then_some(tip.distance)
            });
            let least = touched.fold(f64::INFINITY, f64::min);
            least.is_finite() && self.closest.is_clear(self.polyhedron, &p_OF, least - SLACK)
        })
    }

    /// Appends a contact, with the way of the ball's centre as its length.
    fn advance(&self, path: &mut SurfacePath, contact: Contact) {
        let last = path.waypoints[path.waypoints.len() - 1].contact;
        let gap = (contact.tip_center(self.radius) - last.tip_center(self.radius)).norm();
        if contact != last {
            path.push(contact, gap.max(self.arc(&last, &contact)));
        }
    }

    /// Length (m) of the centre's arc where the ball turns about its contact; 0 where the contact moves.
    fn arc(&self, from: &Contact, to: &Contact) -> f64 {
        if (to.p_OC - from.p_OC).norm() < SAME { self.radius * angle(&from.n_O, &to.n_O) } else { 0.0 }
    }
}

/// The contact between two neighbouring ones, as [`SurfacePath::at`] has it.
fn between(a: &Contact, b: &Contact, t: f64) -> Contact {
    if t >= 1.0 {
        return *b;
    }
    Contact { facet: a.facet, p_OC: a.p_OC.lerp(&b.p_OC, t), n_O: slerp_normals(&a.n_O, &b.n_O, t) }
}
