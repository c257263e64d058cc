//! Whether a contact jumps, as it does where the fingertip leaves one facet of a concave edge for the other.

use super::step::Roller;
use crate::common::{Second, longest_jump, second_touch};
use regrasp_api::{Contact, Mesh, Vec3};

/// Halvings of a step after which a jump would be shorter than what the closure bound lets pass.
const MOST_HALVINGS: usize = 8;

/// Whether a mesh bounds a convex solid: no concave edge, and one surface of the kind of a sphere (V - E + F
/// = 2).
pub(super) fn is_convex(mesh: &Mesh) -> bool {
    2 * mesh.vertices().len() == mesh.facets().len() + 4 && mesh.is_locally_convex()
}

impl Roller<'_> {
    /// Whether the contact point jumps farther than a plan allows between two contacts of one rolling
    /// fingertip.
    pub fn jumps(&self, a: &Contact, b: &Contact) -> bool {
        let project = |p_OF: &Vec3, near: u32| self.task.surface.project(p_OF, Some(near)).contact;
        let longest = longest_jump(self.radius, self.closure);
        let watch = Watch { project: &project, radius: self.radius, longest };
        !self.is_convex && watch.jumps(a, b, MOST_HALVINGS)
    }

    /// What the fingertip touches beside the contact; between two states it may stray to it.
    pub fn second(&self, contact: &Contact) -> Second {
        match self.is_convex {
            true => Second::None,
            false => second_touch(self.task.surface, contact, self.radius, self.task.tolerances.closure),
        }
    }
}

/// Looks for jumps of the contact of a ball.
struct Watch<'a> {
    /// The contact at the surface's point closest to a place, with a facet nearby.
    project: &'a dyn Fn(&Vec3, u32) -> Contact,
    /// The ball's radius (m).
    radius: f64,
    /// The longest jump (m) that passes.
    longest: f64,
}

impl Watch<'_> {
    /// The closest point of a convex piece of the surface never moves farther than the fingertip's centre
    /// (projection onto a convex set is nonexpansive); what is beyond that is a jump.
    ///
    /// While the ball turns about a convex edge its centre moves and the contact rests, so that a jump in
    /// between may hide: the way is halved until the contacts are on one facet, or so close together that
    /// nothing can hide. Contacts on one facet need no more: a facet is convex.
    fn jumps(&self, a: &Contact, b: &Contact, halvings: usize) -> bool {
        let moved = (b.p_OC - a.p_OC).norm();
        let (from, to) = (a.tip_center(self.radius), b.tip_center(self.radius));
        if moved <= self.longest {
            return false;
        }
        if moved - (to - from).norm() > self.longest {
            return true;
        }
        if a.facet == b.facet || halvings == 0 {
            return false;
        }
        let middle = (self.project)(&from.lerp(&to, 0.5), a.facet);
        self.jumps(a, &middle, halvings - 1) || self.jumps(&middle, b, halvings - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 0.01;
    const CLOSURE: f64 = 1e-5;
    /// Half the distance (m) of the two points, or of the ends of the rod.
    const HALF: f64 = 5e-5;

    /// Whether the contact of a ball jumps that turns by 0.1 rad about the y axis and passes the plane y = 0.
    fn jumps(foot: impl Fn(&Vec3) -> Vec3) -> bool {
        let project = |p_OF: &Vec3, _: u32| {
            let p_OC = foot(p_OF);
            Contact { facet: u32::from(p_OC.y > 0.0), p_OC, n_O: (p_OF - p_OC).normalize() }
        };
        let at = |angle: f64, y: f64| Vec3::new(RADIUS * angle.sin(), y, RADIUS * angle.cos());
        let (from, to) = (project(&at(-0.05, -HALF), 0), project(&at(0.05, HALF), 0));
        let watch = Watch { project: &project, radius: RADIUS, longest: CLOSURE };
        assert!((to.p_OC - from.p_OC).norm() < (to.tip_center(RADIUS) - from.tip_center(RADIUS)).norm());
        watch.jumps(&from, &to, MOST_HALVINGS)
    }

    /// Two points touched in turn: the contact jumps by 0.1 mm while the centre moves by 1 mm across.
    #[test]
    fn a_jump_does_not_hide_in_a_turn() {
        assert!(jumps(|p_OF| Vec3::y() * HALF.copysign(p_OF.y)));
    }

    /// A rod between the two points: the contact rolls along it as far.
    #[test]
    fn rolling_along_an_edge_is_no_jump() {
        assert!(!jumps(|p_OF| Vec3::y() * p_OF.y.clamp(-HALF, HALF)));
    }
}
