//! The plugin registry: which plugins there are, which of them a run chose, and the eight objects that they
//! become.
//!
//! A plugin crate submits its [`Entry`](regrasp_api::Entry) with `inventory`; the registry collects what the
//! binary links, sorts it by id and refuses duplicates. Further plugins come from libraries that are loaded
//! at run time ([`load`]). The default choice of each slot, the paper's, lives here: the planner names no
//! plugin.

mod choice;
mod error;
mod load;
mod plugin_set;
mod preset;
mod registry;
mod shelf;
#[cfg(test)]
mod test_plugins;

pub use choice::*;
pub use error::*;
pub use load::*;
pub use plugin_set::*;
pub use preset::*;
pub use registry::*;
