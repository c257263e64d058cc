//! Places where a ball touches: pushed out to the surface, in the corner of two facets, at a facet's edge.

use super::{Follower, PARALLEL, SAME, SINK};
use crate::closest::closest_of_facet;
use regrasp_api::{Contact, Vec3};

/// Corrections before a place counts as unreachable.
const SETTLE_STEPS: usize = 60;
/// Corrections before the contact's jump is looked for by bisection.
const CORNER_STEPS: usize = 6;

/// A ball that touches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub p_OF: Vec3,
    pub contact: Contact,
}

impl Follower<'_> {
    pub(super) fn touch(&self, contact: Contact) -> Touch {
        Touch { p_OF: contact.tip_center(self.radius), contact }
    }

    /// Moves a ball's centre to the offset surface; `None` where it comes to no rest.
    ///
    /// Each step puts the centre on the offset planes of the last few closest points at once (least change),
    /// so that a corner of two or three facets is met in a few steps.
    pub(super) fn settle(&self, p_OF: &Vec3) -> Option<Touch> {
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

    /// How far (m) to move along the normals of two contacts to the offset planes of both, if they are not
    /// parallel.
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

    /// The place between two where the ball touches the facets of both at once: there the contact jumps.
    pub(super) fn corner(&self, from: &Touch, to: &Touch, gap: f64) -> Option<(Touch, Touch)> {
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
                let clear = near && self.is_free(&a.contact, SINK);
                let touch = |contact| Touch { p_OF, contact };
                return clear.then(|| (touch(a.contact), touch(b.contact)));
            }
            let [along_a, along_b] = self.moves(&p_OF, &a.contact, &b.contact)?;
            p_OF += a.contact.n_O * along_a + b.contact.n_O * along_b;
        }
        None
    }

    /// The place between two at which the contact leaves a facet over an edge, or comes in over one: there
    /// the ball begins to turn, or ends.
    pub(super) fn knee(&self, from: &Touch, to: &Touch) -> Option<Touch> {
        self.way_out(from, to).or_else(|| self.way_out(to, from))
    }

    /// Where the contact of a ball on its straight way from inside a facet comes to the facet's edge.
    fn way_out(&self, inside: &Touch, outside: &Touch) -> Option<Touch> {
        let Contact { facet, p_OC, n_O } = inside.contact;
        let n = self.polyhedron.mesh.normal(facet);
        if (n_O - n).norm() > PARALLEL {
            return None;
        }
        let to = outside.p_OF - inside.p_OF;
        let flat = to - n * n.dot(&to);
        let mut first: f64 = 1.0;
        for edge in &self.polyhedron.half_edges[3 * facet as usize..3 * facet as usize + 3] {
            let outward = edge.along_O.cross(&n);
            let speed = outward.dot(&flat);
            if speed > 0.0 {
                first = first.min(outward.dot(&(edge.p_OE - p_OC)).max(0.0) / speed);
            }
        }
        let knee = self.touch(Contact { facet, p_OC: p_OC + flat * first, n_O: n });
        let is_new = |end: &Touch| (knee.p_OF - end.p_OF).norm() > SAME;
        let is_free = || self.is_free(&knee.contact, SINK);
        (first < 1.0 && is_new(inside) && is_new(outside) && is_free()).then_some(knee)
    }

    /// The same place with the contact on the facet that was touched before, if the ball touches it still.
    ///
    /// In a concave edge the ball touches both sides: without a preference rounding would choose.
    pub(super) fn keep(&self, before: &Touch, here: &Touch) -> Touch {
        let tip = closest_of_facet(self.polyhedron, &here.p_OF, before.contact.facet);
        let touches = (tip.distance - self.radius).abs() < 3.0 * SINK;
        if touches { Touch { p_OF: here.p_OF, contact: tip.contact } } else { *here }
    }
}
