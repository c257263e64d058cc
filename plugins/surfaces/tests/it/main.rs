//! The surfaces, seen from outside: one program, since each more is linked anew.
#![allow(missing_docs)]

mod closed_forms;
mod common;
mod conformance;
mod geodesic;
mod heat;
mod lift;
mod parametric;
mod points;
mod steiner;
