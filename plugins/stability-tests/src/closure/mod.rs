//! Force closure by Newton's method to the analytic centre of the polar body.

mod margin;
mod newton;
mod polar;
mod symmetric;
mod triangle;

pub(crate) use margin::{Frame, bracket, floor, glance};
pub(crate) use newton::{Outcome, Search};
pub(crate) use polar::PolarBody;
pub(crate) use symmetric::{Factor, Symmetric6};
pub(crate) use triangle::three_points;
