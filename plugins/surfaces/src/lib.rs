//! Built-in surfaces: points, shortest paths and projections on the object.

mod bvh;
mod closest;
pub mod geodesic;
pub mod heat;
mod hollows;
mod lift;
pub mod parametric;
mod polyhedron;
mod rolling;
mod sharp;
pub mod steiner;
mod strip;
mod walk;
