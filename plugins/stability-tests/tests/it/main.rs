//! The tests of grasps, seen from outside: one program, since each more is linked anew.
#![allow(missing_docs)]

mod conformance;
mod degenerate;
mod equilibrium;
mod grained;
mod holding;
mod laws;
mod linearised;
mod oracle;
mod registry;
mod support;
mod wrench_ball;
