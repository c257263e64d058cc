//! Grasps in bulk: distinct, verified, free of collisions, by the hundred thousand.
//!
//! A [`GraspSource`] draws them for one hand and object, in chunks that are pure functions of their number:
//! poses of the object spread evenly over where the fingers reach it, at each pose contacts of every finger,
//! and combinations of these that are stable. Each is given forces that hold the object where there are any,
//! and is judged by the independent verifier. [`collect`] computes chunks on threads, takes them in order,
//! and keeps what is not too like an earlier grasp ([`Twins`]). So the result is the same on any number of
//! threads, and that of a smaller count is the beginning of that of a larger one. A [`Journal`] keeps on disk
//! what was found, so that a search that was killed goes on; [`write`](mod@write) makes files of it.

mod chunk;
mod collect;
mod combine;
mod counts;
mod error;
mod graph;
mod grasp;
mod hold;
mod journal;
mod layout;
mod pools;
mod pose;
mod quota;
mod source;
mod spread;
mod wish;
pub mod write;

pub use collect::{Ending, Kept, Progress, Search, Sink, Stopped, collect};
pub use counts::Counts;
pub use error::GraspsError;
pub use graph::Edge;
pub use grasp::{BulkGrasp, HeldBy};
pub use journal::Journal;
pub use layout::Layout;
pub use source::GraspSource;
pub use spread::Twins;
pub use wish::Wish;
