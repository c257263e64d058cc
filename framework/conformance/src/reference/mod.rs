//! Small, slow implementations of the roles, independent of the built-in plugins.
//!
//! They stand in for the other roles while one is tested, and they are the honest part of the kit's own liars.

mod closure;
mod nonnegative;

pub(crate) use closure::center_and_length;
pub use closure::{Closure, EdgeClosure, closure};
