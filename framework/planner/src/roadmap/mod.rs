//! Roadmaps that are kept: a manipulation graph grown without start and goal, for many queries.
//!
//! The manipulation graph does not depend on start and goal (A. Sahbani, J.-P. Saut, V. Perdereau, SSD 2007,
//! section IV). Its nodes are grasps of GS_n at poses drawn evenly; its edges are those alone for which
//! transfers and regrasps were found, by the same calls that a query makes: they are pure functions of their
//! keys, so that an edge is kept as two numbers, and its steps are made again when a plan uses it.

mod graph;
mod grow;
mod learn;
mod map;
mod near;
mod nodes;
mod pairs;
mod query;
mod way;

pub use graph::RoadmapGraph;
pub use grow::{Grown, grow};
pub use learn::learn;
pub use map::{Roadmap, RoadmapParts};
pub use pairs::{Pair, pairs};

/// A roadmap to be planned through.
#[derive(Clone, Copy)]
pub struct Through<'a> {
    /// The roadmap.
    pub graph: &'a RoadmapGraph<'a>,
    /// Whether a leg for which the roadmap knows no way is given up; else it is searched as without roadmap.
    pub alone: bool,
}
