//! Roadmaps in files: what a roadmap is bound to, how it is read and written, and how good it is.
//!
//! The planner grows roadmaps and plans through them ([`regrasp_planner::roadmap`]); here they are kept. A
//! file is bound to hand, object and settings by digests, and refused by any other problem.

mod digest;
mod error;
mod file;
mod identity;
mod judge;

pub use error::*;
pub use file::{load, save};
pub use identity::{Identity, Named};
pub use judge::{Attempt, Standing, judge};
