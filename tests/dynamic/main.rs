//! Plugins loaded at run time: real libraries, built out of the tree, loaded by the program.
//!
//! The libraries are built once, in a folder and with a target folder of their own that stay from run to run,
//! without a network.

mod compare;
mod new_plugin;
mod panics;
mod refusals;
mod workshop;
