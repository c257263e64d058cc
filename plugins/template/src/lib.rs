//! One small plugin of each role, as a start for an own one.
//!
//! `regrasp new-plugin ROLE NAME` writes a crate of its own with the module of one role in it. Each module is
//! a real plugin: it is correct, passes the conformance kit and plans, but is simpler or slower than the
//! built-in plugins of its role.

pub mod contact_model;
pub mod graph_strategy;
pub mod local_planner;
pub mod python;
pub mod sampler;
pub mod stability_test;
pub mod surface;
pub mod text;
