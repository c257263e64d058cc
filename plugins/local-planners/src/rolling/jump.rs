//! Whether a contact jumps, as it does where the fingertip leaves one facet of a concave edge for the other.

use super::step::Roller;
use regrasp_api::{Contact, Mesh};

/// Halvings of a step after which a jump would be shorter than what the closure bound lets pass.
const MOST_HALVINGS: usize = 8;

/// Whether a mesh bounds a convex solid: no concave edge, and one surface of the kind of a sphere (V - E + F = 2).
pub(super) fn is_convex(mesh: &Mesh) -> bool {
    2 * mesh.vertices().len() == mesh.facets().len() + 4 && mesh.is_locally_convex()
}

impl Roller<'_> {
    /// Whether the contact point jumps by more than the closure bound between two contacts of one rolling fingertip.
    pub fn jumps(&self, a: &Contact, b: &Contact) -> bool {
        !self.is_convex && self.jumps_between(a, b, MOST_HALVINGS)
    }

    /// The closest point of a convex piece of the surface never moves farther than the fingertip's centre (projection onto a
    /// convex set is nonexpansive); what is beyond that is a jump.
    ///
    /// While the ball turns about a convex edge its centre moves and the contact rests, so that a jump in between may hide:
    /// the way is halved until the contacts are on one facet, or so close together that nothing can hide. Contacts on one facet
    /// need no more: a facet is convex.
    fn jumps_between(&self, a: &Contact, b: &Contact, halvings: usize) -> bool {
        let moved = (b.p_OC - a.p_OC).norm();
        let (from, to) = (a.tip_center(self.radius), b.tip_center(self.radius));
        if moved <= self.closure {
            return false;
        }
        if moved - (to - from).norm() > self.closure {
            return true;
        }
        if a.facet == b.facet || halvings == 0 {
            return false;
        }
        let middle = self.task.surface.project(&from.lerp(&to, 0.5), Some(a.facet)).contact;
        self.jumps_between(a, &middle, halvings - 1) || self.jumps_between(&middle, b, halvings - 1)
    }
}
