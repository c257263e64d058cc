//! Meshes and slow, independent references for the tests of surfaces.
#![allow(dead_code, missing_docs)]

pub mod meshes;
pub mod reference;

use regrasp_api::{Contact, Context, Random, SurfaceParam, SurfacePath, Uninterrupted};

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
