//! The main job as a library: a scenario file becomes a checked [`Scenario`](scenario::Scenario), that a
//! [`Setup`] with its plugins built, and that a plan which was verified.

mod again;
mod audit;
mod carry;
mod cones;
mod error;
mod forces;
mod improve;
mod plan_file;
pub mod scenario;
mod setup;
mod start;
mod task;
mod workbench;

pub use audit::*;
pub use error::*;
pub use improve::*;
pub use setup::*;
pub use start::start_at;
pub use workbench::Workbench;
