//! The native half of the Python package `regrasp`: the planner's façade as Python classes and functions.
//!
//! What crosses the border is numpy arrays, and JSON text for trees; `package/regrasp` makes of it what a
//! user sees. The module is private:
//! its form may change with any version.

mod answer;
mod bench;
mod compare;
mod conformance;
mod errors;
mod grasps;
mod hand;
mod holding;
mod pieces;
mod plan;
mod roles;
mod run;
mod scenario;
mod table;
mod template;
mod urdf;
mod watch;

/// The native module of the package `regrasp`.
#[pyo3::pymodule(gil_used = true)]
mod _regrasp {
    #[pymodule_export]
    use super::bench::Bench;
    #[pymodule_export]
    use super::compare::{digest, merge_studies, run_study};
    #[pymodule_export]
    use super::conformance::{conformance, plugins};
    #[pymodule_export]
    use super::grasps::grasps;
    #[pymodule_export]
    use super::hand::Hand;
    #[pymodule_export]
    use super::pieces::{closure_margins, force_closure, internal_forces};
    #[pymodule_export]
    use super::plan::Plan;
    #[pymodule_export]
    use super::roles::{
        Configuration, Contact, Context, Graph, Grasp, PoseRequest, Target, Task, register, registered,
        role_schema,
    };
    #[pymodule_export]
    use super::run::{Solved, solve};
    #[pymodule_export]
    use super::scenario::{Scenario, scenarios};
    #[pymodule_export]
    use super::template::plugin_package;
}
