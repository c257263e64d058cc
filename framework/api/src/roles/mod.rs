//! The six roles: traits that a researcher implements to replace one part of the algorithm.

mod closed_chain_sampler;
mod contact_model;
mod graph_strategy;
mod local_planner;
mod search_policy;
mod stability_test;
mod surface_param;

pub use closed_chain_sampler::*;
pub use contact_model::*;
pub use graph_strategy::*;
pub use local_planner::*;
pub use search_policy::*;
pub use stability_test::*;
pub use surface_param::*;
