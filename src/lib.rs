//! Regrasp plans how a multi-fingered hand takes an object from one pose to another: by *transfers* (the
//! object moves, the fingertips roll without slip) and *regrasps* (the object rests, one finger moves), the
//! grasp being stable at every instant.
//!
//! ```
//! let scenario = regrasp::load("sphere")?; // a built-in scenario, or a file
//! let run = regrasp::solve(&scenario, 1)?; // plans with seed 1, and verifies
//! assert!(run.is_verified());
//! for segment in &run.outcome.motion.segments {
//!     println!("{:?}, {} states", segment.kind, segment.states.len());
//! }
//! # Ok::<(), regrasp::run::RunError>(())
//! ```
//!
//! Every component of the algorithm is a plugin of one of six roles, each a trait of [`api`]:
//!
//! | role | answers | by default |
//! |---|---|---|
//! | [`ContactModel`](api::ContactModel) | which wrenches can this contact transmit | [`pcwf`](plugins::contact_models::Pcwf) |
//! | [`StabilityTest`](api::StabilityTest) | is the grasp stable, by what margin | [`force-closure`](plugins::stability_tests::ForceClosure) |
//! | [`SurfaceParam`](api::SurfaceParam) | points, normals and shortest paths on the object | [`geodesic`](plugins::surfaces::geodesic) |
//! | [`ClosedChainSampler`](api::ClosedChainSampler) | a random configuration in which the fingers hold the object | [`rlg`](plugins::samplers::rlg) |
//! | [`LocalPlanner`](api::LocalPlanner) | connects two configurations by sliding, rolling or regrasping | [`linear`](plugins::local_planners::Linear), [`rolling`](plugins::local_planners::Rolling), [`rrt`](plugins::local_planners::Rrt) |
//! | [`GraphStrategy`](api::GraphStrategy) | what to do next with the manipulation graph | [`interleaved`](plugins::graph_strategies::Interleaved) |
//!
//! The defaults are those of A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous
//! manipulation planning", SSD 2007. Another plugin for a run is one line,
//! `scenario.choices.use_plugin(Slot::StabilityTest, "socp")`. A plugin of your own is a type that implements
//! its role and an [`Entry`](api::Entry) that registers it; [`api`]'s page shows a whole one.
//!
//! Where [`load`] and [`solve`] are too simple: [`setup`] builds the plugins once and lets you call them
//! ([`Setup::task`], [`Setup::plugins`]), [`Setup::run`] takes a time limit, threads and progress,
//! [`Registry::with_libraries`] loads plugins at run time, and [`study::compare`](mod@study::compare)
//! compares combinations of plugins. The package's `examples/` has one small program for each of these.

mod advice;
pub mod page;
mod stopwatch;

pub use advice::{Needed, advice, needed_friction};
pub use stopwatch::Stopwatch;

pub use regrasp_abi as abi;
pub use regrasp_api as api;
pub use regrasp_atlas as atlas;
pub use regrasp_export as export;
pub use regrasp_formats as formats;
pub use regrasp_grasps as grasps;
pub use regrasp_hands as hands;
pub use regrasp_host as host;
pub use regrasp_physics as physics;
pub use regrasp_plan as plan;
pub use regrasp_planner as planner;
pub use regrasp_roadmap as roadmap;
pub use regrasp_run as run;
pub use regrasp_study as study;
pub use regrasp_suite as suite;
pub use regrasp_verify as verify;
pub use regrasp_view as view;
pub use regrasp_world as world;

/// The built-in plugins, a module for each role.
///
/// Naming their crates here links them, and with them their entries: a dependency alone registers nothing.
pub mod plugins {
    pub use regrasp_contact_models as contact_models;
    pub use regrasp_graph_strategies as graph_strategies;
    pub use regrasp_local_planners as local_planners;
    pub use regrasp_samplers as samplers;
    pub use regrasp_stability_tests as stability_tests;
    pub use regrasp_surfaces as surfaces;
}

use host::Registry;
use run::scenario::{self, Scenario};
use run::{Run, RunError, Setup};
use std::time::Duration;

/// Loads the built-in scenario of this name, or else the file; it may use the plugins that are linked into
/// the program.
pub fn load(name: &str) -> Result<Scenario, RunError> {
    Ok(scenario::load(name, &Registry::linked()?)?)
}

/// Builds the scenario's plugins from those that are linked into the program.
pub fn setup(scenario: &Scenario) -> Result<Setup<'_>, RunError> {
    Setup::new(scenario, &scenario.choices, &Registry::linked()?)
}

/// Plans, and verifies the plan: on one thread, until the scenario's own limits end the search.
///
/// The same scenario and seed give the same plan. That none was found is no error: [`Run::why_not_solved`]
/// says why.
pub fn solve(scenario: &Scenario, seed: u64) -> Result<Run, RunError> {
    let limit = scenario.problem.limits.budget.time_limit.map(Duration::from_secs_f64);
    let watch = limit.map_or_else(Stopwatch::start, Stopwatch::limited);
    setup(scenario)?.run(&watch.options(seed))
}
