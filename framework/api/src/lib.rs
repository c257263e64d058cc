//! The plugin contract of Regrasp: plain data, six role traits, two service traits.
//!
//! A researcher replaces one part of the planner by implementing one of the six roles:
//!
//! - [`ContactModel`]: which wrenches a contact can transmit;
//! - [`StabilityTest`]: whether a grasp holds the object;
//! - [`SurfaceParam`]: points, normals and shortest paths on the object's surface;
//! - [`ClosedChainSampler`]: random configurations in which fingers hold the object;
//! - [`LocalPlanner`]: connects two configurations by sliding, rolling or regrasping;
//! - [`GraphStrategy`]: what to do next with the manipulation graph.
//!
//! A call is handed the immutable [`Task`] and a mutable [`Context`] (random stream, budget, counts). All quantities are in SI
//! units; `X_HO` is the pose of frame O in frame H (see [`Pose`]).

mod configuration;
mod context;
mod error;
mod export;
mod finger;
mod grasp;
mod mesh;
mod object;
mod plugin;
mod random;
mod reason;
mod roles;
mod scene;
mod services;
mod settings;
mod spatial;
mod task;

pub use configuration::*;
pub use context::*;
pub use error::*;
pub use export::*;
pub use finger::*;
pub use grasp::*;
pub use inventory;
pub use mesh::*;
pub use object::*;
pub use plugin::*;
pub use random::*;
pub use reason::*;
pub use roles::*;
pub use scene::*;
pub use services::*;
pub use settings::*;
pub use spatial::*;
pub use task::*;
