//! The built-in local planners: `linear` inside GS_n, `rolling` for transfers, `rrt` for regrasps.
//!
//! Each connects two configurations inside one kind of subspace (Sahbani, Saut, Perdereau, "An efficient algorithm for
//! dexterous manipulation planning", SSD 2007, section IV).

mod common;
pub mod linear;
pub mod rolling;
pub mod rrt;

pub use linear::{Linear, LinearSettings};
pub use rolling::{Rolling, RollingSettings};
pub use rrt::{Rrt, RrtSettings};
