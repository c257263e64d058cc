//! The plugins keep the laws of their roles.
#![allow(missing_docs)]

use regrasp_conformance::{Demands, Report, check_with, registered, registered_are_silent};
use regrasp_template::{contact_model, graph_strategy, local_planner, sampler, stability_test, surface};

// The template registers nothing: the program links it for its texts.
regrasp_api::inventory::submit! { contact_model::ENTRY }
regrasp_api::inventory::submit! { stability_test::ENTRY }
regrasp_api::inventory::submit! { surface::ENTRY }
regrasp_api::inventory::submit! { sampler::ENTRY }
regrasp_api::inventory::submit! { local_planner::ENTRY }
regrasp_api::inventory::submit! { graph_strategy::ENTRY }

/// Paths of `surface/template` may be this much longer than the shortest, relative.
const GEODESIC_TOLERANCE: f64 = 0.05;

#[test]
fn plugins_conform() {
    let demands = Demands { geodesic_tolerance: GEODESIC_TOLERANCE, ..Demands::default() };
    let reports: Vec<Report> = registered().into_iter().map(|entry| check_with(entry, &demands)).collect();
    assert_eq!(reports.len(), 6, "one plugin of each role");
    reports.iter().for_each(Report::assert_passes);
}

regrasp_conformance::registered_plugins_keep_the_laws_in_a_run!(Demands::default());

#[test]
fn plugins_print_nothing() {
    registered_are_silent(concat!(module_path!(), "::plugins_print_nothing"));
}
