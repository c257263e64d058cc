//! Plan files and their timing, seen from outside: one program, since each more is linked anew.
#![allow(missing_docs)]

mod common;
mod files;
mod timing;
