//! The laws, as functions of plain data: what was asked for, what was answered.
//!
//! Names are those of the conformance kit where it has the same law.

mod chain;
mod cone;
mod contact;
mod grasp;
mod lift;
mod motion;
mod slip;
mod strategy;

pub use chain::{Chain, chain_kept, pose_kept};
pub use cone::{cone_inside, cone_valid, cone_within_friction, directions, support};
pub(crate) use contact::is_looked_at;
pub use contact::{Ground, contact_on_surface, path_kept, projection_kept, walk_kept};
pub use grasp::{assessment_kept, certificate_kept};
pub use lift::lift_kept;
pub use motion::{
    Motion, ends_kept, fraction_kept, reached_kept, refusal_counted, states_kept, step_kept, target_kept,
};

pub use strategy::vicinity_kept;

/// A law, and how it was broken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Broken {
    /// The law's name, in kebab case.
    pub law: &'static str,
    /// What was found, with numbers.
    pub what: String,
}

/// What became of a law.
pub type Kept = Result<(), Broken>;

/// The law is broken.
pub fn broken<T>(law: &'static str, what: impl Into<String>) -> Result<T, Broken> {
    Err(Broken { law, what: what.into() })
}

/// Breaks the law unless `holds`.
pub fn ensure(law: &'static str, holds: bool, what: impl FnOnce() -> String) -> Kept {
    if holds { Ok(()) } else { broken(law, what()) }
}

/// A length in mm or µm, for messages.
pub fn length(metres: f64) -> String {
    let size = metres.abs();
    match size {
        s if !s.is_finite() => format!("{metres} m"),
        s if s >= 1e-3 => format!("{:.3} mm", metres * 1e3),
        _ => format!("{:.3} µm", metres * 1e6),
    }
}
