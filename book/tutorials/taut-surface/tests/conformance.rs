//! The plugin keeps the laws of its role.

use regrasp_conformance::{Demands, check_with, registered_are_silent};

/// Paths may be this much longer than the shortest, relative. A better surface needs no allowance.
const GEODESIC_TOLERANCE: f64 = 0.01;

#[test]
fn the_plugin_conforms() {
    let demands = Demands { geodesic_tolerance: GEODESIC_TOLERANCE, ..Demands::default() };
    check_with(&taut_surface::ENTRY, &demands).assert_passes();
}

#[test]
fn the_plugin_prints_nothing() {
    registered_are_silent(concat!(module_path!(), "::the_plugin_prints_nothing"));
}
