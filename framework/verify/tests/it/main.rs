//! The verifier, seen from outside: one program, since each more is linked anew.
#![allow(missing_docs)]

mod attacks;
mod common;
mod damage;
mod edits;
mod fixed_point;
mod good;
mod load;
mod series;
mod thin;
mod threads;
