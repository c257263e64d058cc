//! The services that every role may use: hand and clearance.

mod clearance;
mod hand;

pub use clearance::*;
pub use hand::*;
