//! Scenario files, and what is done with them: building hand, object and plugins, planning, verifying.

pub mod compare;
mod run;
pub mod scenario;

pub use run::*;
