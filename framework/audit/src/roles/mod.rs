//! The roles under audit.

mod contact_model;
mod graph_strategy;
mod local_planner;
mod sampler;
mod stability_test;
mod surface;
