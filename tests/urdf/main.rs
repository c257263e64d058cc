//! Hands from URDF files, through the real binary: files of the tests' own making, good and bad.

mod bad;
#[path = "../end_to_end/desk.rs"]
#[allow(dead_code)] // other tests use more of it
mod desk;
mod generator;
mod good;
mod kinds;
