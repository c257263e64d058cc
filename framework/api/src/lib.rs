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
//! A call is handed the immutable [`Task`] and a mutable [`Context`] (random stream, budget, counts);
//! [`Hand`] and [`Clearance`] are services that it may ask. All quantities are in SI units; `X_HO` is the
//! pose of frame O in frame H (see [`Pose`]).
//!
//! A plugin is a type that implements its role, and an [`Entry`] that says how it is called, which settings
//! it takes and how it is built. This is a whole one:
//!
//! ```
//! use regrasp_api::{
//!     Build, Cone, Contact, ContactModel, Entry, FingerIndex, NoSettings, Settings, Slot, check_settings,
//! };
//!
//! /// Point contact with friction, of which only 70 % are relied on.
//! struct Cautious;
//!
//! impl ContactModel for Cautious {
//!     fn cone(&self, _finger: FingerIndex, _contact: &Contact, mu: f64) -> Cone<'_> {
//!         Cone::Elliptic { mu: 0.7 * mu, gamma: 0.0 }
//!     }
//!
//!     fn fewest_contacts(&self) -> usize {
//!         3
//!     }
//! }
//!
//! regrasp_api::inventory::submit! {
//!     Entry {
//!         id: "contact-model/cautious",
//!         slots: &[Slot::ContactModel],
//!         summary: "point contact with 70 % of the friction",
//!         references: &[],
//!         schema: NoSettings::schema,
//!         check: check_settings::<NoSettings>,
//!         build: Build::ContactModel(|_settings, _parts| Ok(Box::new(Cautious))),
//!     }
//! }
//! assert!(regrasp_api::inventory::iter::<Entry>().any(|entry| entry.id == "contact-model/cautious"));
//! ```
//!
//! `regrasp new-plugin ROLE NAME` writes such a crate with its tests; the `regrasp` package plans with it.

mod configuration;
mod context;
mod digest;
mod effort;
mod error;
mod fault;
mod figure;
mod finger;
mod grasp;
mod memo;
mod mesh;
mod object;
mod parts;
mod plugin;
mod random;
mod read;
mod reason;
mod refusal;
mod roles;
mod scene;
mod schema;
mod services;
mod settings;
mod slots;
mod spatial;
mod task;
mod total;

pub use configuration::*;
pub use context::*;
pub use digest::mesh_digest;
pub use effort::*;
pub use error::*;
pub use fault::*;
pub use figure::*;
pub use finger::*;
pub use grasp::*;
pub use inventory;
pub use memo::*;
pub use mesh::*;
pub use object::*;
pub use parts::*;
pub use plugin::*;
pub use random::*;
pub use read::*;
pub use reason::*;
pub use refusal::*;
pub use roles::*;
pub use scene::*;
pub use schema::*;
pub use services::*;
pub use settings::*;
pub use slots::*;
pub use spatial::*;
pub use task::*;
pub use total::*;
