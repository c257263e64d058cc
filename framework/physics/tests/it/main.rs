//! Forces and replays, seen from outside: one program, since each more is linked anew.
#![allow(missing_docs)]

mod forces;
#[cfg(feature = "rapier")]
mod hold;
mod support;
