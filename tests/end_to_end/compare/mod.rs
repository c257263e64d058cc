//! `regrasp compare`: studies that are made in one go, killed, resumed, made in parts.

mod family;
mod kill;
mod parts;
mod presets;
mod rows;
mod shelf;
mod words;
