//! The planner: manipulation graph, Algorithms 1 to 3, query, decomposition, smoothing, parallel solving.
//!
//! Implements A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous manipulation
//! planning", SSD 2007, over the six roles of `regrasp-api`; it names no plugin. Data flows one way:
//! [`solve`] makes a `run`, which finds grasps at start and goals (`endpoints`), makes one search a goal
//! (first by a `relay`; then Algorithm 1 in `search`, 2 in `explore`, 3 in `connect` and `meet`; on `graph`),
//! whose `query` is decomposed (`decompose`, `steps`, `order`), smooths the whole (`smooth`) and times it.
//! A [`roadmap`] is the same graph without start and goal, kept for many queries.
//! The one way back: an edge that cannot be decomposed leaves the graph.
//!
//! The result is that of the sequential algorithm for any number of threads: every expensive call is a pure
//! function of its key, threads only compute results ahead, and these are consumed in order (`session`).

mod admissible;
mod connect;
mod decompose;
mod draft;
mod endpoints;
mod ends;
mod error;
mod explore;
mod finish;
mod foresight;
mod glide;
mod graph;
mod history;
mod joined;
mod meet;
mod order;
mod query;
mod record;
mod relay;
mod relayed;
mod report;
mod request;
pub mod roadmap;
mod run;
mod search;
mod segments;
mod session;
mod share;
mod shortest_path;
mod smooth;
mod solve;
mod steps;
mod tail;
mod view;

pub use admissible::{Holdable, Leavable, Stable, admission};
pub use error::{End, PlanError};
pub use record::{EdgeRecord, Fate, GraphRecord};
pub use report::{Clock, Outcome, Progress, Silent, Status, Stuck};
pub use request::Request;
pub use solve::{solve, solve_through};
