//! The six roles, played by Python classes.
//!
//! A class is registered under an id; its entry's functions find it by a number that is part of their type,
//! for an entry holds bare function
//! pointers. An exception in a plugin becomes a fault of the call, and is raised again, as it was, where the
//! run ends.

mod contact_model;
mod convert;
mod data;
mod graph_strategy;
mod loan;
mod local_planner;
mod plugin;
mod pool;
mod sampler;
mod stability_test;
mod stash;
mod surface;
mod task;

pub use convert::{fits, to_pose};
pub use data::{Configuration, Contact, Context, Grasp};
pub use graph_strategy::Graph;
pub use local_planner::Target;
pub use pool::{entries, register, registered, role_schema};
pub use sampler::PoseRequest;
pub use stash::{Stash, with_stash};
pub use task::Task;
