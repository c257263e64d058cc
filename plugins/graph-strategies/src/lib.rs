//! Built-in graph strategies.
//!
//! - [`interleaved`]: explores GS_n and connects its components in turn, with the paper's biased α.

pub mod interleaved;
