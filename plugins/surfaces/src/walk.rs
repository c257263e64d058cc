//! Straight ahead on a polyhedron.

use crate::polyhedron::{Place, Polyhedron, next, previous};
use regrasp_api::{Contact, Vec3};
use std::f64::consts::TAU;

/// Facets crossed before a walk ends where it is: a bound against rounding, far above what any distance on
/// the object needs.
const MOST_FACETS: usize = 100_000;

/// A point on its way across a facet.
#[derive(Clone, Copy, Debug)]
struct Heading {
    facet: u32,
    p_OP: Vec3,
    /// Unit vector in the facet's plane.
    along_O: Vec3,
}

/// The contact reached by a straightest geodesic: straight in every facet, unfolded across edges; at a vertex
/// with equal angles on both sides (Polthier & Schmies, "Straightest geodesics on polyhedral surfaces",
/// 1998).
pub(crate) fn walk(
    polyhedron: &Polyhedron,
    from: &Contact,
    place: Place,
    direction_O: &Vec3,
    distance: f64,
) -> Contact {
    let tangent = direction_O - from.n_O * from.n_O.dot(direction_O);
    let mut left = distance;
    if left.is_nan() || left <= 0.0 || tangent.norm() <= 1e-12 * direction_O.norm() || tangent.norm() == 0.0 {
        return *from;
    }
    let mut at = head_out(polyhedron, from, place, &tangent);
    for _ in 0..MOST_FACETS {
        let (edge, run) = way_out(polyhedron, &at);
        if run >= left {
            at.p_OP += at.along_O * left;
            break;
        }
        left -= run;
        at.p_OP += at.along_O * run;
        at = carry_over(polyhedron, &at, edge);
    }
    Contact { facet: at.facet, p_OC: at.p_OP, n_O: polyhedron.mesh.normal(at.facet) }
}

/// Chooses the facet into which a tangent direction leads.
fn head_out(polyhedron: &Polyhedron, from: &Contact, place: Place, tangent: &Vec3) -> Heading {
    let mut best = (f64::INFINITY, Heading { facet: from.facet, p_OP: from.p_OC, along_O: *tangent });
    polyhedron.facets_at(place, |facet| {
        let n = polyhedron.mesh.normal(facet);
        let flat = tangent - n * n.dot(tangent);
        let along_O = kept_inside(polyhedron, facet, &from.p_OC, &flat.normalize());
        let off = (along_O - tangent.normalize()).norm();
        if off < best.0 {
            best = (off, Heading { facet, p_OP: from.p_OC, along_O });
        }
    });
    best.1
}

/// The direction, turned into the facet's edge where it leads out over an edge that holds the point.
fn kept_inside(polyhedron: &Polyhedron, facet: u32, p_OP: &Vec3, along_O: &Vec3) -> Vec3 {
    let n = polyhedron.mesh.normal(facet);
    let mut kept = *along_O;
    for index in 3 * facet..3 * facet + 3 {
        let edge = &polyhedron.half_edges[index as usize];
        let inward = n.cross(&edge.along_O);
        if inward.dot(&(p_OP - edge.p_OE)) < polyhedron.snap && inward.dot(&kept) < 0.0 {
            kept = edge.along_O * edge.along_O.dot(&kept).signum();
        }
    }
    kept
}

/// The edge through which a heading leaves its facet, and the distance to it (m).
fn way_out(polyhedron: &Polyhedron, at: &Heading) -> (u32, f64) {
    let n = polyhedron.mesh.normal(at.facet);
    let mut best = (3 * at.facet, f64::INFINITY);
    for index in 3 * at.facet..3 * at.facet + 3 {
        let edge = &polyhedron.half_edges[index as usize];
        let outward = edge.along_O.cross(&n);
        let speed = outward.dot(&at.along_O);
        if speed > 1e-12 {
            let run = (outward.dot(&(edge.p_OE - at.p_OP)) / speed).max(0.0);
            if run < best.1 {
                best = (index, run);
            }
        }
    }
    best
}

/// Carries a heading over an edge, or over the vertex that it hits.
fn carry_over(polyhedron: &Polyhedron, at: &Heading, edge: u32) -> Heading {
    if let Place::Vertex(vertex) = polyhedron.place(at.facet, &at.p_OP) {
        return carry_over_vertex(polyhedron, at, vertex);
    }
    let frame = &polyhedron.half_edges[edge as usize];
    let outward = frame.along_O.cross(&polyhedron.mesh.normal(at.facet));
    let facet = frame.twin / 3;
    let beyond = polyhedron.mesh.normal(facet).cross(&-frame.along_O);
    let along_O = frame.along_O * frame.along_O.dot(&at.along_O) + beyond * outward.dot(&at.along_O);
    // On the edge's line exactly, so that rounding does not pile up.
    let x = (at.p_OP - frame.p_OE).dot(&frame.along_O).clamp(0.0, frame.length);
    Heading { facet, p_OP: frame.at(x), along_O: along_O.normalize() }
}

/// Goes on behind a vertex with half of its total angle on either side.
fn carry_over_vertex(polyhedron: &Polyhedron, at: &Heading, vertex: u32) -> Heading {
    let total = polyhedron.total_angle[vertex as usize];
    let corner = |edge: u32| {
        let [x, y] = polyhedron.half_edges[edge as usize].apex;
        y.atan2(x)
    };
    let local = |edge: u32, direction: &Vec3| {
        let along = &polyhedron.half_edges[edge as usize].along_O;
        let inward = polyhedron.mesh.normal(edge / 3).cross(along);
        inward.dot(direction).atan2(along.dot(direction))
    };
    let entry =
        polyhedron.star(vertex).find(|edge| edge / 3 == at.facet).unwrap_or(previous(next(edge_of(at))));
    let back = polyhedron.direction[entry as usize] + local(entry, &-at.along_O).clamp(0.0, corner(entry));
    let out = (back + total / 2.0).rem_euclid(total.min(TAU * 16.0));
    let holds = |&edge: &u32| {
        let first = polyhedron.direction[edge as usize];
        (first..first + corner(edge) + 1e-12).contains(&out)
    };
    let exit = polyhedron.star(vertex).find(holds).unwrap_or(entry);
    let angle = out - polyhedron.direction[exit as usize];
    let frame = &polyhedron.half_edges[exit as usize];
    let inward = polyhedron.mesh.normal(exit / 3).cross(&frame.along_O);
    let along_O = frame.along_O * angle.cos() + inward * angle.sin();
    Heading { facet: exit / 3, p_OP: frame.p_OE, along_O }
}

fn edge_of(at: &Heading) -> u32 {
    3 * at.facet
}
