//! The kit against plugins that are right and plugins that are wrong: one program, since each more is linked anew.
#![allow(missing_docs)]

mod contact_model;
mod graph_strategy;
mod in_a_run;
mod local_planner;
mod mistakes;
mod sampler;
mod stability_test;
mod support;
mod surface;
