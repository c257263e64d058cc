//! Comparisons of plugin combinations: every scenario, planned by every variant, with every seed; every plan verified.

mod record;
pub mod statistics;
mod study;

pub use record::*;
pub use study::*;
