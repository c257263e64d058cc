//! Built-in samplers of closed chains.
//!
//! - [`rlg`]: the random loop generator, the paper's choice.

pub mod rlg;
