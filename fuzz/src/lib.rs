//! Damaged inputs for everything that Regrasp reads.
//!
//! A [`Target`] takes any bytes whatever and must come back: with a result or an error, never with a panic,
//! and soon. The same targets are driven in two ways: by [`mutate`] on the stable compiler
//! (`cargo test -p regrasp-fuzz`), a bounded number of inputs from [`seeds`]; and by libFuzzer, which sees
//! the code's branches (`libfuzzer/`, see the README).

mod mutate;
pub mod seeds;
mod targets;

pub use mutate::mutate;
pub use targets::{TARGETS, Target};
