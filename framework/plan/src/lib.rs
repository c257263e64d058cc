//! The plan file: format, reading, writing, timing.
//!
//! A [`Motion`] is what the planner makes; [`assign_times`] times it; [`records`] turns it into the segments
//! of a [`Plan`], which [`write()`] puts into a file and [`read`] gets back, every number exactly as it was.

mod certificate;
mod claims;
mod convert;
mod error;
mod file;
mod format;
mod journal;
mod json;
mod motion;
#[cfg(target_os = "linux")]
mod nameless;
mod statistics;
mod surface;
mod timing;
mod write;

pub use certificate::*;
pub use claims::*;
pub use convert::*;
pub use error::*;
pub use file::*;
pub use format::*;
pub use journal::*;
pub use json::*;
pub use motion::*;
pub use statistics::*;
pub use surface::*;
pub use timing::*;
pub use write::*;

/// How the names of files begin and end that are being written: those that a killed process left behind may
/// be deleted.
pub const TEMPORARY: (&str, &str) = (".regrasp-", ".tmp");
