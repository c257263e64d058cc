//! The local planners, seen from outside: one program, since each more is linked anew.
#![allow(missing_docs)]

mod conformance;
mod fixed_point;
mod linear;
#[cfg(feature = "rapier")]
mod rapier_checked;
mod regrasp;
mod rolling;
mod support;
