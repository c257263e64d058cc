//! The independent verifier of plans: shares no checking code with planner and plugins.
//!
//! [`verify`] re-derives everything from the plan file alone: own forward kinematics, closure against the
//! object's mesh, slip, limits, stability with its own proofs, distances by parry. It works at ten times the
//! plan's resolution on the motion that the plan means (joints and position linear, orientation by slerp
//! between states), and reports for each check the worst value, the limit and the place.
//! [`GraspVerifier`] judges grasps by themselves, in which nothing moves.

mod border;
mod bounds;
mod claims;
mod clearance;
mod contact_checks;
mod controller;
mod ends;
mod grasp;
mod hand;
mod lift;
mod motion;
mod motion_checks;
mod object;
mod order;
mod outer;
mod rates;
mod scene;
mod series;
mod shape;
mod slip;
mod solid;
mod stability;
mod stretch;
mod supported;
mod surface;
mod touch;
mod track;
mod verdict;
mod walk;

pub use grasp::{GraspFigures, GraspJudge, GraspVerifier};
pub use series::{SeriesError, StateFigures, series};
pub use verdict::{Check, Side, Verdict};
pub use walk::{verify, verify_on};
