//! The real binary from outside.

mod again;
mod bad_input;
mod better;
mod command_line;
mod compare;
mod desk;
mod gallery;
mod golden;
mod grasps;
mod hold;
mod json_errors;
mod obstacles;
mod outputs;
mod pages;
mod roadmap;
mod rough;
mod search;
mod serve;
mod wording;
