//! How plugin objects cross the border of a library that is loaded at run time: the export macro, the
//! fingerprint, the guards.
//!
//! A plugin library says [`export_plugins!`]; the host compares its [`FINGERPRINT`] before it loads anything.
//! Whatever is called across the border stands behind a guard that turns panics into errors.

mod entry;
mod export;
mod fingerprint;
mod guard;
mod roles;
mod services;
#[cfg(test)]
mod tests;
mod wrapped;

pub use entry::*;
pub use export::*;
pub use fingerprint::*;
pub use guard::{Caught, Guardable, guarded};
#[doc(hidden)]
pub use regrasp_api as api;
pub use services::*;
pub use wrapped::{Around, Wrapped};
