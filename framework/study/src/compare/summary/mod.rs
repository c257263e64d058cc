//! `summary.csv` and `summary.md`: a row for each scenario and variant, and what may be said of it.

mod finding;
mod markdown;
mod number;
mod table;

pub(super) use finding::finding;
pub use markdown::markdown;

pub use table::csv;

#[cfg(test)]
mod tests;
