//! Regrasp: planning of dexterous manipulation with continuous grasps, every component of the algorithm a plugin.
//!
//! Given a multi-fingered hand, a rigid object, a start and goals, it finds the transfers (the object moves, the fingertips roll without
//! slip) and regrasps (the object rests, one finger moves) that take the object there, the grasp being stable at every instant. The default
//! plugins are those of A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous manipulation planning", SSD 2007.
//!
//! This crate gathers what a user of the library needs and links the built-in plugins. A run in four steps:
//!
//! ```
//! use regrasp::planner::{Clock, Silent};
//! use regrasp::study::{NeverStops, RunOptions, Setup, scenario};
//!
//! struct NoClock; // a program that wants the times gives a real one
//! impl Clock for NoClock {
//!     fn seconds(&self) -> f64 {
//!         0.0
//!     }
//! }
//!
//! let registry = regrasp::host::Registry::linked()?;
//! let scenario = scenario::load("sphere", &registry)?;
//! let setup = Setup::new(&scenario, &scenario.choices, &registry)?;
//! let run = setup.run(&RunOptions { seed: 1, threads: 1, stop: &NeverStops, clock: &NoClock, progress: &Silent })?;
//! assert!(run.is_verified());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use regrasp_api as api;
pub use regrasp_export as export;
pub use regrasp_host as host;
pub use regrasp_physics as physics;
pub use regrasp_plan as plan;
pub use regrasp_planner as planner;
pub use regrasp_study as study;
pub use regrasp_verify as verify;
pub use regrasp_view as view;
pub use regrasp_world as world;

// A dependency alone registers nothing: naming the crates links them, and with them their entries.
use regrasp_contact_models as _;
use regrasp_graph_strategies as _;
use regrasp_local_planners as _;
use regrasp_samplers as _;
use regrasp_stability_tests as _;
use regrasp_surfaces as _;
