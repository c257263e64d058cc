//! Plugins from libraries that are loaded at run time.
//!
//! A library is read as a file first: it must be a shared library with the section that
//! `regrasp_abi::export_plugins!` writes, and the fingerprint in it must be this program's own. Only then is
//! it loaded, and never unloaded, since its objects, errors and entries may live as long as the program. Only
//! explicit paths are loaded; no other plugin is used in the place of one that is refused.
//!
//! What this cannot contain: a library that crashes (a segmentation fault, a stack overflow, an abort), or
//! one that was built on purpose to deceive. Loading a plugin means trusting its author.

mod error;
mod inspect;
mod open;

pub use error::*;
pub use inspect::*;

use regrasp_api::Entry;
use std::path::Path;

/// Reads the library at `path`, and loads it if it fits this program; its plugins, guarded against panics.
pub fn load(path: &Path) -> Result<Vec<&'static Entry>, LoadError> {
    open::open(&inspect(path)?)
}

pub(crate) use open::open;
