//! The path of the fingertip above a path of the contact point.

use crate::polyhedron::{Place, Polyhedron};
use regrasp_api::{Contact, SurfacePath, Vec3};

/// A point of a path over the facets and the facet in which the path leaves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Leg {
    pub p_OP: Vec3,
    pub facet: u32,
}

/// Angles (rad) and lengths (m) below this do not make a waypoint of their own.
const NEGLIGIBLE: f64 = 1e-12;

/// The angle between two unit vectors (rad).
pub(crate) fn angle(a: &Vec3, b: &Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

/// Rolls a ball of the given radius (m) over the facets of `legs`: straight over a facet, turning about its
/// contact at a convex edge. Exact on a convex solid.
pub(crate) fn lift(
    polyhedron: &Polyhedron,
    radius: f64,
    (from, start): (&Contact, Place),
    (to, end): (&Contact, Place),
    legs: &[Leg],
    path: &mut SurfacePath,
) {
    path.restart(*from);
    if from == to {
        return;
    }
    if stays_on_edge(polyhedron, start, end) {
        let turned = radius * angle(&from.n_O, &to.n_O);
        path.push(*to, (to.p_OC - from.p_OC).norm().hypot(turned));
        return;
    }
    for (index, leg) in legs.iter().enumerate() {
        let n_O = polyhedron.mesh.normal(leg.facet);
        let end = legs.get(index + 1).map_or(to.p_OC, |next| next.p_OP);
        advance(path, Contact { facet: leg.facet, p_OC: leg.p_OP, n_O }, radius);
        advance(path, Contact { facet: leg.facet, p_OC: end, n_O }, radius);
    }
    advance(path, *to, radius);
    // The end is exactly the contact that was asked for, also where it adds no length.
    match path.waypoints.len() {
        1 => path.push(*to, 0.0),
        count => path.waypoints[count - 1].contact = *to,
    }
}

/// Whether both contacts lie on one edge or at one vertex: the ball slides along it while it turns between
/// its facets.
fn stays_on_edge(polyhedron: &Polyhedron, start: Place, end: Place) -> bool {
    match (start, end) {
        (Place::Vertex(a), Place::Vertex(b)) => a == b,
        (Place::Edge(a), Place::Edge(b)) => a == b || polyhedron.half_edges[a as usize].twin == b,
        _ => false,
    }
}

/// Appends a contact that differs from the last in its point, its normal or its facet.
fn advance(path: &mut SurfacePath, contact: Contact, radius: f64) {
    let last = path.waypoints[path.waypoints.len() - 1].contact;
    let travelled = (contact.p_OC - last.p_OC).norm() + radius * angle(&last.n_O, &contact.n_O);
    if travelled > NEGLIGIBLE || contact.facet != last.facet {
        path.push(contact, travelled);
    }
}
