//! Every plugin of this crate keeps the laws of its role.
use regrasp_local_planners as _; // a dependency alone registers nothing

regrasp_conformance::registered_plugins_conform!();
