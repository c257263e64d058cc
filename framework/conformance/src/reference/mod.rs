//! Small, slow implementations of the roles, independent of the built-in plugins.
//!
//! They stand in for the other roles while one is tested, and they are the honest part of the kit's own
//! liars.

mod admissible;
mod closure;
mod fine_rolling;
mod geometry;
mod graph_path;
mod grasp_line;
mod interleaving;
mod lift_over;
mod nonnegative;
mod plugins;
mod sampler;
mod steps;
mod surface;
mod walk;

pub use admissible::{Leavable, RoundCones, SoftCones};
pub use closure::{Closure, EdgeClosure, closure};
pub(crate) use closure::{center_and_length, may_give};
pub use fine_rolling::FineRolling;
pub use geometry::{Closest, closest_on_facet, closest_on_mesh, closest_on_primitive, closest_on_segment};
pub use grasp_line::GraspLine;
pub use interleaving::Interleaving;
pub use lift_over::LiftOver;
pub use plugins::ReferencePlugins;
pub use sampler::RejectionSampler;
pub use surface::FacetSurface;
