//! Every plugin of this crate keeps the laws of its role.
#![allow(missing_docs)]

use regrasp_samplers as _; // a dependency alone registers nothing

regrasp_conformance::registered_plugins_conform!();
