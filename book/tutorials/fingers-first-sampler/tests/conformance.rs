//! The plugin keeps the laws of its role.
#![allow(missing_docs)]

use fingers_first_sampler as _; // a dependency alone registers nothing

regrasp_conformance::registered_plugins_conform!();
