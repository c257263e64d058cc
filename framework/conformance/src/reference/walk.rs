//! Straight ahead over facets, unfolding each edge that is crossed.

use super::geometry::facets_at;
use regrasp_api::{Contact, Mesh, Vec3};

/// The contact `distance` (m) ahead of `from` along the tangential part of `direction_O`.
pub(super) fn walk(mesh: &Mesh, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
    let tangential = |n: &Vec3| direction_O - n * n.dot(direction_O);
    if distance <= 0.0 || tangential(&from.n_O).norm() <= 1e-12 * direction_O.norm() {
        return *from;
    }
    let mut facet = facet_ahead(mesh, from, direction_O);
    let mut p = from.p_OC;
    let mut ahead = tangential(&mesh.normal(facet)).normalize();
    let (mut left, mut entered) = (distance, None);
    // More crossings than any walk over the kit's objects needs.
    for _ in 0..10_000 {
        let Some((edge, run)) = way_out(mesh, facet, &p, &ahead, entered) else { break };
        if run >= left {
            break;
        }
        p += ahead * run;
        left -= run;
        let neighbor = mesh.neighbors(facet)[edge];
        let corners = mesh.corners(facet);
        let along = (corners[(edge + 1) % 3] - corners[edge]).normalize();
        let outward = along.cross(&mesh.normal(facet));
        let beyond = mesh.normal(neighbor.facet).cross(&-along);
        ahead = (along * along.dot(&ahead) + beyond * outward.dot(&ahead)).normalize();
        (facet, entered) = (neighbor.facet, Some(usize::from(neighbor.edge)));
    }
    Contact { facet, p_OC: p + ahead * left, n_O: mesh.normal(facet) }
}

/// The edge through which the way leads out of the facet, and the distance to it (m).
fn way_out(mesh: &Mesh, facet: u32, p: &Vec3, ahead: &Vec3, entered: Option<usize>) -> Option<(usize, f64)> {
    let (corners, n) = (mesh.corners(facet), mesh.normal(facet));
    let run = |edge: usize| {
        let outward = (corners[(edge + 1) % 3] - corners[edge]).normalize().cross(&n);
        let speed = outward.dot(ahead);
        let gap = outward.dot(&(corners[edge] - p));
        (speed > 1e-12).then(|| (edge, (gap / speed).max(0.0)))
    };
    let edges = (0..3).filter(|&edge| Some(edge) != entered).filter_map(run);
    edges.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Of the facets that hold the contact, the one that a short step along the direction stays on best.
fn facet_ahead(mesh: &Mesh, from: &Contact, direction_O: &Vec3) -> u32 {
    let step = direction_O.normalize() * 1e-6;
    let off = |facet: &u32| {
        let n = mesh.normal(*facet);
        let there = from.p_OC + step - n * n.dot(&step);
        (super::geometry::closest_on_facet(mesh, *facet, &there) - there).norm()
    };
    let facets = facets_at(mesh, &from.p_OC);
    facets.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(from.facet)
}
