//! The laws of each role, checked where a plugin is really called.
//!
//! The conformance kit tries a plugin on problems of its own. An *audit* holds it to the same laws in the
//! problem at hand: [`Audited`] stands in front of a plugin, passes every call on, and checks the answer. The
//! first breach is kept ([`Breach`]: plugin, law, call, input) and ends the call with
//! [`regrasp_api::CallError::Contract`]; where a call returns no `Result` it becomes the thread's fault, as a
//! panic does.
//!
//! [`laws`] holds the laws as functions of plain data, for the audit, the kit and anybody's own tests.
//!
//! A call that is looked at is made a second time, with the same random stream and without what was known
//! before: an answer that differs is impure. While a call is repeated, and while laws are checked, nothing
//! else is audited. All long calls are looked at and a share of the short ones ([`Depth`]): a run under audit
//! takes up to five times as long.

mod audited;
mod auditor;
mod geometry;
mod input;
pub mod laws;
mod roles;

pub use audited::Audited;
pub use auditor::{Auditor, Breach, Depth};
pub use geometry::{Closest, closest_on_facet, closest_on_mesh, closest_on_segment};
