//! A twin of a rough mesh that is smooth at the scale of a fingertip, for contacts to live on.
//!
//! A ball of a fingertip's radius R bridges dents that are narrower than it, and rolls over what is convex.
//! So a twin is judged by what that ball feels: wherever it touches the twin it must be at most the bound
//! from touching the mesh, and enter it at most as deep (`touch`). Candidates, the simplest first: the convex
//! hull through few vertices (`hull`), then the mesh with fewer facets (`collapse`: Garland and Heckbert,
//! "Surface simplification using quadric error metrics", SIGGRAPH 1997) whose mild dents are filled by
//! turning concave edges over (`fill`).

mod collapse;
mod editable;
mod fill;
mod hull;
mod near;
mod places;
mod quadric;
mod roughness;
mod touch;

pub use roughness::roughness;

use regrasp_api::{Mesh, Twin};
use touch::Touch;

/// Tolerance (m) that is tried first, for a fingertip's radius of 1 m: a tenth of a millimetre for one of 10
/// mm.
const NEAR: f64 = 0.01;
/// The largest tolerance (m) that is chosen unasked.
const FARTHEST: f64 = 3e-4;
/// A surface is smooth enough if at most this share of the places where a fingertip can be lies close to a
/// concave edge ...
const ROUGH: f64 = 0.5;
/// ... and a twin helps if it lowers that share to this part of the mesh's, or has half as many facets.
const HELPS: f64 = 0.8;
/// Fingertips smaller than this (m) feel every facet.
const SMALLEST_TIP: f64 = 1e-4;

/// The twin of `mesh` that is chosen unasked for fingertips of a radius (m); `None` where the mesh itself is
/// smooth enough, or no twin is smoother.
///
/// Tried are a hundredth of the radius and three times as much as tolerance, neither above 0.3 mm: first the
/// hull within each, then what is not convex.
pub fn automatic_twin(mesh: &Mesh, radius: f64) -> Option<Twin> {
    if radius < SMALLEST_TIP || mesh.is_locally_convex() {
        return None;
    }
    let rough = roughness(mesh, radius);
    if rough <= ROUGH {
        return None;
    }
    let touch = Touch::new(mesh, radius);
    let tolerances = [(NEAR * radius).min(FARTHEST), (3.0 * NEAR * radius).min(FARTHEST)];
    let convex = tolerances.iter().find_map(|&tolerance| hull::within(mesh, &touch, tolerance));
    convex.or_else(|| {
        dented(mesh, &touch, tolerances[1]).filter(|twin| {
            2 * twin.mesh.facets().len() <= mesh.facets().len()
                || roughness(&twin.mesh, radius) <= HELPS * rough
        })
    })
}

/// The coarsest twin of `mesh` within a tolerance (m) for fingertips of a radius (m); `None` where there is
/// none but the mesh.
pub fn twin_within(mesh: &Mesh, radius: f64, tolerance: f64) -> Option<Twin> {
    if radius < SMALLEST_TIP {
        return None;
    }
    let touch = Touch::new(mesh, radius);
    hull::within(mesh, &touch, tolerance).or_else(|| dented(mesh, &touch, tolerance))
}

/// The same surface by fewer facets, within a tolerance (m); `None` where that is no closed surface.
pub(crate) fn coarser(mesh: &Mesh, tolerance: f64) -> Option<Mesh> {
    let mut surface = editable::Editable::new(mesh);
    let touch = Touch::new(mesh, mesh.radius() / 6.0);
    collapse::collapse(&mut surface, mesh, &touch, tolerance);
    surface.mesh()
}

/// A twin that keeps the wider dents.
fn dented(mesh: &Mesh, touch: &Touch, tolerance: f64) -> Option<Twin> {
    // The changes are judged one by one; where their sum goes too far, a smaller share of the tolerance is
    // used up.
    [0.8, 0.7, 0.55, 0.4].into_iter().find_map(|share| {
        let mut surface = editable::Editable::new(mesh);
        collapse::collapse(&mut surface, mesh, touch, 0.4 * share * tolerance);
        fill::fill(&mut surface, mesh, touch, share * tolerance);
        let candidate = surface.mesh()?;
        accepted(candidate, touch, tolerance)
    })
}

/// The candidate as a twin if it is as near as is wished.
fn accepted(candidate: Mesh, touch: &Touch, tolerance: f64) -> Option<Twin> {
    touch.bound(&candidate, tolerance).map(|bound| Twin { mesh: candidate, bound, tolerance })
}

#[cfg(test)]
mod tests;
