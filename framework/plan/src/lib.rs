//! The plan file: format, reading, writing, timing.

mod motion;

pub use motion::*;
