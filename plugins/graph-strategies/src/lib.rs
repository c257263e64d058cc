//! Built-in graph strategies. Their only memory is the graph.
//!
//! - [`interleaved`]: explores GS_n and connects its components in turn, with the paper's biased α;
//! - [`explore_first`]: explores up to a size of the graph, then connects;
//! - [`connect_first`]: explores only when nothing is left to connect;
//! - [`lazy`]: enters edges unchecked, and checks those that a path from start to goal uses;
//! - [`bidirectional`]: grows a tree from the start and one from the goals.

pub mod bidirectional;
pub mod connect_first;
pub mod explore_first;
pub mod interleaved;
pub mod lazy;
mod nearest;

pub use bidirectional::{Bidirectional, BidirectionalSettings};
pub use connect_first::{ConnectFirst, ConnectFirstSettings};
pub use explore_first::{ExploreFirst, ExploreFirstSettings};
pub use interleaved::{Interleaved, InterleavedSettings};
pub use lazy::{Lazy, LazySettings};
