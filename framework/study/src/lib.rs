//! Scenario files, and what is done with many of them.

pub mod scenario;
