//! The contact models, seen from outside: one program, since each more is linked anew.
#![allow(missing_docs)]

mod conformance;
mod laws;
