//! Built-in stability tests: exact force closure, and the conic program that it is checked against.

mod closure;
mod contacts;
mod force_closure;
mod socp;

pub use force_closure::{ForceClosure, ForceClosureSettings};
pub use socp::{Socp, SocpSettings};
