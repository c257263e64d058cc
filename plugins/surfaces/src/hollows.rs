//! The fingertip's path on a solid that is not convex: where its ball would penetrate, it slides over the hollow.
//!
//! The path that rolls over the facets one by one is followed as long as the ball touches nothing else. Where it would
//! penetrate, the ball leaves the path at the last free place and goes to the next free place along the offset surface:
//! straight, pushed out (or back) wherever the straight way does not touch. In a concave edge both places are the same, and
//! the contact jumps from one facet to the other.

use crate::closest::{ClosestPoints, closest_of_facet};
use crate::lift::angle;
use crate::polyhedron::Polyhedron;
use regrasp_api::{Contact, Projection, SurfacePath, Vec3, Waypoint, slerp_normals};

/// Depth (m) to which the ball may sink into the facets: rounding, far below every tolerance of a plan.
const SINK: f64 = 1e-10;
/// How far (m) a way between two waypoints may stray from the offset surface.
const STRAY: f64 = 5e-7;
/// Two centres this close (m) are one place.
const SAME: f64 = 2e-10;
/// Corrections before a place counts as unreachable.
const SETTLE_STEPS: usize = 60;
/// Corrections before the contact's jump is looked for by bisection.
const CORNER_STEPS: usize = 6;
/// Places looked at in one hollow before the fingertip counts as stuck.
const MOST_PLACES: usize = 2000;

/// A ball that touches.
#[derive(Clone, Copy, Debug)]
struct Touch {
    p_OF: Vec3,
    contact: Contact,
}

/// Follows a path with a ball of one radius.
pub(crate) struct Follower<'a> {
    pub polyhedron: &'a Polyhedron,
    pub closest: &'a ClosestPoints,
    pub radius: f64,
    /// Largest distance (m) between two places that are looked at.
    pub step: f64,
}

impl Follower<'_> {
    /// Whether the ball at a contact touches nothing but the contact point.
    pub fn is_free(&self, contact: &Contact, sink: f64) -> bool {
        self.closest.is_clear(self.polyhedron, &contact.tip_center(self.radius), self.radius - sink)
    }

    /// Rewrites `path`, whose waypoints roll over the facets, so that the ball penetrates nothing; `false` where it cannot go.
    pub fn follow(&self, path: &mut SurfacePath, rolled: &mut Vec<Waypoint>) -> bool {
        rolled.clear();
        rolled.append(&mut path.waypoints);
        let (first, last) = (rolled[0].contact, rolled[rolled.len() - 1].contact);
        path.waypoints.push(Waypoint { contact: first, lift_length: 0.0 });
        // The ends were given: they may be as inexact as the caller's arithmetic.
        if !self.is_free(&first, STRAY) || !self.is_free(&last, STRAY) {
            return false;
        }
        let mut left_at: Option<Touch> = None;
        let mut before = first;
        for index in 1..rolled.len() {
            let (from, to) = (rolled[index - 1], rolled[index]);
            let steps = ((to.lift_length - from.lift_length) / self.step).ceil().max(1.0);
            for step in 1..=steps as usize {
                let here = between(&from.contact, &to.contact, step as f64 / steps);
                let is_end = step as f64 == steps && index + 1 == rolled.len();
                let free = is_end || self.is_free(&here, SINK);
                match (free, &left_at) {
                    (true, None) if step as f64 == steps => self.advance(path, here),
                    (false, None) => left_at = Some(self.leave(path, &before, &here)),
                    (true, Some(left)) => {
                        let back = self.edge_of_free(&here, &before);
                        if !self.slide(path, left, &self.touch(back)) {
                            return false;
                        }
                        self.advance(path, here);
                        left_at = None;
                    }
                    _ => {}
                }
                before = here;
            }
        }
        true
    }

    /// Appends the last free contact before `blocked`.
    fn leave(&self, path: &mut SurfacePath, free: &Contact, blocked: &Contact) -> Touch {
        let last = self.edge_of_free(free, blocked);
        self.advance(path, last);
        self.touch(last)
    }

    /// The free contact nearest to a blocked one, between it and a free one.
    ///
    /// Each guess is where the ball just touches the plane of what it last sank into: exact at the second try between
    /// facets, and in between bisection.
    fn edge_of_free(&self, free: &Contact, blocked: &Contact) -> Contact {
        let center = |t: f64| between(free, blocked, t).tip_center(self.radius);
        let span = (center(0.0) - center(1.0)).norm();
        let (mut low, mut high, mut best) = (0.0, 1.0, *free);
        let mut wall = self.tip(&center(1.0), blocked.facet).contact;
        while (high - low) * span > SAME / 4.0 {
            let gap = |t: f64| wall.n_O.dot(&(center(t) - wall.p_OC)) - self.radius;
            let (before, after) = (gap(low), gap(high));
            let certain = before > 0.0 && after < 0.0;
            let t = if certain { low + (high - low) * before / (before - after) } else { (low + high) / 2.0 };
            let contact = between(free, blocked, t);
            let tip = self.tip(&contact.tip_center(self.radius), contact.facet);
            if tip.distance < self.radius - SINK {
                (high, wall) = (t, tip.contact);
                continue;
            }
            (low, best) = (t, contact);
            if certain {
                break;
            }
        }
        best
    }

    fn tip(&self, p_OF: &Vec3, hint: u32) -> Projection {
        self.closest.project(self.polyhedron, p_OF, Some(hint))
    }

    fn touch(&self, contact: Contact) -> Touch {
        Touch { p_OF: contact.tip_center(self.radius), contact }
    }

    /// Appends the way of the ball between two places along the offset surface.
    fn slide(&self, path: &mut SurfacePath, from: &Touch, to: &Touch) -> bool {
        let mut budget = MOST_PLACES;
        let steps = ((to.p_OF - from.p_OF).norm() / self.step).ceil().max(1.0);
        let mut before = *from;
        for step in 1..=steps as usize {
            let t = step as f64 / steps;
            let here = if t < 1.0 { self.settle(&from.p_OF.lerp(&to.p_OF, t)) } else { Some(*to) };
            match here.and_then(|here| self.join(path, &before, &here, 0, &mut budget)) {
                Some(reached) => before = reached,
                None => return false,
            }
        }
        // At the same place the contact may have to jump once more.
        self.advance(path, to.contact);
        true
    }

    /// Appends waypoints until the ways between them stay on the offset surface; the touch at the end, or `None` if stuck.
    fn join(
        &self,
        path: &mut SurfacePath,
        from: &Touch,
        to: &Touch,
        depth: i32,
        budget: &mut usize,
    ) -> Option<Touch> {
        let to = &self.keep(from, to);
        let gap = (to.p_OF - from.p_OF).norm();
        if gap < SAME || self.is_direct(from, to, gap) {
            self.advance(path, to.contact);
            return Some(*to);
        }
        // Halves of a continuous way get shorter and shorter; those of a leap do not.
        if *budget == 0 || gap > 16.0 * self.step * 0.7_f64.powi(depth) {
            return None;
        }
        *budget -= 1;
        if let Some((left, taken)) = self.corner(from, to, gap) {
            self.join(path, from, &left, depth + 1, budget)?;
            self.advance(path, taken.contact);
            return self.join(path, &taken, to, depth + 1, budget);
        }
        let via = self.settle(&from.p_OF.lerp(&to.p_OF, 0.5))?;
        let via = self.join(path, from, &via, depth + 1, budget)?;
        self.join(path, &via, to, depth + 1, budget)
    }

    /// The place between two where the ball touches the facets of both at once: there the contact jumps.
    fn corner(&self, from: &Touch, to: &Touch, gap: f64) -> Option<(Touch, Touch)> {
        let mut p_OF = from.p_OF.lerp(&to.p_OF, 0.5);
        if from.contact.facet == to.contact.facet {
            return None;
        }
        for _ in 0..CORNER_STEPS {
            let a = closest_of_facet(self.polyhedron, &p_OF, from.contact.facet);
            let b = closest_of_facet(self.polyhedron, &p_OF, to.contact.facet);
            let off = (a.distance - self.radius).abs().max((b.distance - self.radius).abs());
            if off < SINK {
                let near = (p_OF - from.p_OF).norm().max((p_OF - to.p_OF).norm()) < 1.5 * gap;
                let clear = near && self.closest.is_clear(self.polyhedron, &p_OF, self.radius - SINK);
                let touch = |contact| Touch { p_OF, contact };
                return clear.then(|| (touch(a.contact), touch(b.contact)));
            }
            let [along_a, along_b] = self.moves(&p_OF, &a.contact, &b.contact)?;
            p_OF += a.contact.n_O * along_a + b.contact.n_O * along_b;
        }
        None
    }

    /// The same place with the contact on the facet that was touched before, if the ball touches it still.
    ///
    /// In a concave edge the ball touches both sides: without a preference rounding would choose.
    fn keep(&self, before: &Touch, here: &Touch) -> Touch {
        let tip = closest_of_facet(self.polyhedron, &here.p_OF, before.contact.facet);
        let touches = (tip.distance - self.radius).abs() < 3.0 * SINK;
        if touches { Touch { p_OF: here.p_OF, contact: tip.contact } } else { *here }
    }

    /// Whether the contact may go straight from one place to the next.
    fn is_direct(&self, from: &Touch, to: &Touch, gap: f64) -> bool {
        let places: &[f64] = if gap > self.step / 2.0 { &[0.5, 0.25, 0.75] } else { &[0.5] };
        let same_facet = from.contact.facet == to.contact.facet;
        gap <= 1.5 * self.step
            && places.iter().all(|&t| {
                let contact = between(&from.contact, &to.contact, t);
                let off = |p: &Vec3| self.tip(p, contact.facet).distance;
                // A straight line between two points of a facet stays in it.
                (off(&contact.tip_center(self.radius)) - self.radius).abs() < STRAY
                    && (same_facet || off(&contact.p_OC).abs() < STRAY)
            })
    }

    /// Moves a ball's centre to the offset surface; `None` where it comes to no rest.
    ///
    /// Each step puts the centre on the offset planes of the last few closest points at once (least change), so that a
    /// corner of two or three facets is met in a few steps.
    fn settle(&self, p_OF: &Vec3) -> Option<Touch> {
        let mut center = *p_OF;
        let mut facet = None;
        let mut before: Option<Contact> = None;
        for _ in 0..SETTLE_STEPS {
            let tip = self.closest.project(self.polyhedron, &center, facet);
            if (tip.distance - self.radius).abs() < SINK {
                return Some(Touch { p_OF: center, contact: tip.contact });
            }
            facet = Some(tip.contact.facet);
            let pushed = center + tip.contact.n_O * (self.radius - tip.distance);
            let other = before.filter(|_| tip.distance < self.radius);
            let both = other.and_then(|other| Some((other, self.moves(&center, &tip.contact, &other)?)));
            center = match both {
                // A plane that would have to pull is not touched.
                Some((other, [along_a, along_b])) if along_a >= 0.0 && along_b >= 0.0 => {
                    center + tip.contact.n_O * along_a + other.n_O * along_b
                }
                _ => pushed,
            };
            before = Some(tip.contact);
        }
        None
    }

    /// How far (m) to move along the normals of two contacts to the offset planes of both, if they are not parallel.
    fn moves(&self, p_OF: &Vec3, a: &Contact, b: &Contact) -> Option<[f64; 2]> {
        let cos = a.n_O.dot(&b.n_O);
        let determinant = 1.0 - cos * cos;
        let need = |contact: &Contact| self.radius - contact.n_O.dot(&(p_OF - contact.p_OC));
        let (to_a, to_b) = (need(a), need(b));
        (determinant > 1e-8).then(|| [(to_a - cos * to_b) / determinant, (to_b - cos * to_a) / determinant])
    }

    /// The contact of a ball pushed out of (or back to) the surface from a contact where it sinks in.
    pub fn settled(&self, contact: Contact) -> Contact {
        if self.is_free(&contact, SINK) {
            return contact;
        }
        self.settle(&contact.tip_center(self.radius)).map_or(contact, |touch| touch.contact)
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
