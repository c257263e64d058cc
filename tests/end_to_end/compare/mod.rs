//! `regrasp compare`: studies that are made in one go, killed, resumed, made in parts.

mod kill;
mod parts;
mod rows;
mod shelf;
mod words;
