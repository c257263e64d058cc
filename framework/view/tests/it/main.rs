//! The pages, seen from outside: one program, since each more is linked anew.
#![allow(missing_docs)]

mod beside;
mod models;
mod page;
mod small;
