//! Scenario files, and what is done with them: building hand, object and plugins, planning, verifying.

pub mod compare;
pub mod picture;
mod run;
pub mod scenario;

pub use run::*;
