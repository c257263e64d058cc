//! Meshes and slow, independent references for the tests of surfaces.
#![allow(dead_code, missing_docs)]

pub mod meshes;
pub mod reference;

use regrasp_api::{Contact, Context, Mesh, Random, SurfaceParam, SurfacePath, Uninterrupted};

/// The path between two contacts, which must exist.
pub fn path(surface: &dyn SurfaceParam, from: &Contact, to: &Contact) -> SurfacePath {
    let mut path = SurfacePath::default();
    let mut context = Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted);
    assert!(surface.geodesic(from, to, &mut path, &mut context).unwrap(), "no path from {from:?} to {to:?}");
    path
}

/// The length of the path of the contact point (m).
pub fn length(surface: &dyn SurfaceParam, from: &Contact, to: &Contact) -> f64 {
    path(surface, from, to).length
}

/// A random point of the mesh: inside a facet, on an edge or at a vertex.
pub fn anywhere(mesh: &Mesh, random: &mut Random) -> Contact {
    let facet = random.index(mesh.facets().len()) as u32;
    let [a, b, c] = mesh.corners(facet);
    let (t, kind) = (random.unit(), random.index(6));
    let s = if kind > 1 { random.unit() * (1.0 - t) } else { 0.0 };
    let p_OC = if kind == 0 { a } else { a * (1.0 - s - t) + b * t + c * s };
    Contact { facet, p_OC, n_O: mesh.normal(facet) }
}
