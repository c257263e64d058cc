//! `summary.csv`, `summary.md` and `comparisons.csv`: a row for each scenario and variant, and what may be
//! said of it.

mod comparisons;
mod finding;
mod markdown;
mod number;
mod table;
mod words;

pub use comparisons::comparisons_csv;
pub use finding::{Finding, finding};
pub use markdown::markdown;
pub(super) use markdown::{aligned, code, plain};
pub(super) use number::three_digits;
pub use table::csv;
pub use words::{cell, clause, family_text, line, signed, subject};

#[cfg(test)]
mod tests;
