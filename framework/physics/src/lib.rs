//! Chooses grasp forces within friction cones and the joints' efforts, and simulates transfers and whole
//! motions in rapier3d: the hand as jointed bodies driven by motors, the object free under gravity.
//!
//! [`grasp_forces`], [`edge_forces`], [`dragged_forces`] and [`creep`] need no simulator; everything else is
//! behind the feature `rapier`.
//!
//! What is simulated:
//! - each finger as a chain of bodies with the hand's joint axes, in reduced coordinates (no joint can come
//!   apart); each joint driven by a motor with a stiffness and damping whose effort saturates at the joint's
//!   limit;
//! - the fingertips as balls on the object's mesh, one contact each at the closest point, with Coulomb
//!   friction; the object with its mass, inertia and gravity;
//! - the control: positions and speeds of the plan, and fed forward the efforts of a grip (q* = q + K⁻¹ Jᵀ
//!   f). Nothing looks at where the object is: it stays on its path because the grip's stiffness keeps it
//!   there.
//!
//! What is left out: weight of the links (the motors are taken to hold it), true masses of the links (nominal
//! ones), shapes of the links (plans are free of collisions), torsional friction (rapier's contacts have
//! none), compliance of skin.
//!
//! Deterministic: fixed steps, one thread, no random numbers; the same binary and machine give the same bits.

#[cfg(feature = "rapier")]
mod border;
mod drag;
mod edge_forces;
mod error;
#[cfg(feature = "rapier")]
mod finger;
#[cfg(feature = "rapier")]
mod fixed;
mod force;
mod grasp_forces;
mod hold;
mod holding;
#[cfg(feature = "rapier")]
mod pace;
#[cfg(feature = "rapier")]
mod replay;
#[cfg(feature = "rapier")]
mod report;
mod settings;
#[cfg(feature = "rapier")]
mod simulator;
mod stage;
#[cfg(feature = "rapier")]
mod surface;
#[cfg(feature = "rapier")]
mod transfer;

pub use drag::creep;
pub use edge_forces::{EdgeForces, StageCones, edge_forces};
pub use error::PhysicsError;
pub use force::{Across, ContactForce, Friction};
pub use grasp_forces::{dragged_forces, grasp_forces, grasp_forces_at};
pub use hold::Held;
pub use holding::{
    Answer, Balanced, Bearing, Bearings, Edged, EdgesAnswer, EdgesBalanced, Exerted, Forces, HeldLoad, Press,
    Smallest, Weights, smallest_share,
};
#[cfg(feature = "rapier")]
pub use pace::Pace;
#[cfg(feature = "rapier")]
pub use replay::{Moment, ReplayReport, ReplaySettings, StageReport, replay};
#[cfg(feature = "rapier")]
pub use report::{Bounds, Failure, Happening, Outcome};
pub use settings::SimulationSettings;
pub use stage::Stage;
#[cfg(feature = "rapier")]
pub use transfer::TransferSimulator;
