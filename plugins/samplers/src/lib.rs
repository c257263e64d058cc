//! Built-in samplers of closed chains.
//!
//! - [`rlg`]: the random loop generator, the paper's choice;
//! - [`projection`]: a random start brought onto the closure manifold by Newton's method;
//! - [`grasp_first`]: a stable grasp of the object first, then a pose at which the hand reaches it.

mod chains;
pub mod grasp_first;
mod pools;
mod pose;
pub mod projection;
pub mod rlg;

pub use grasp_first::{GraspFirst, GraspFirstSettings};
pub use projection::{ProjectionSampler, ProjectionSettings};
pub use rlg::{Rlg, RlgSettings};
