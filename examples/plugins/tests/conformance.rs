//! The example plugins keep the laws of their roles.
use regrasp_example_plugins as _;
regrasp_conformance::registered_plugins_conform!();
