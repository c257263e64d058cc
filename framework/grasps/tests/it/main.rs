//! Grasps in bulk, seen from outside: one program, since each more is linked anew.
#![allow(missing_docs)]

mod grasps;
mod judge;
mod support;
