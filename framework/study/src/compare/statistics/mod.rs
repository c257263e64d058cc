//! The statistics of a comparison: proportions, medians and paired tests, each with the interval that says
//! how sure it is.
//!
//! All functions are pure and deterministic; the bootstrap draws from a stream of fixed seed. Intervals hold
//! 95 %.

mod bootstrap;
mod contrast;
mod discordant;
mod holm;
mod newcombe;
mod normal;
mod order;
mod paired;
mod signed_rank;
mod walsh;
mod wilson;

pub use bootstrap::*;
pub use contrast::*;
pub use discordant::*;
pub use holm::*;
pub use newcombe::*;
pub use order::*;
pub use paired::*;
pub use signed_rank::*;
pub use walsh::*;
pub use wilson::*;

use serde::Serialize;

/// A value with the ends of its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The estimate itself.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

impl Estimate {
    /// The same estimate on another scale; `f` must be increasing.
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self { value: f(self.value), low: f(self.low), high: f(self.high) }
    }
}

/// The level that a difference must meet to be called one, and one less the confidence of all intervals.
pub const ALPHA: f64 = 0.05;

/// Depression scale factors of nine patients, before less after a treatment (M. Hollander, D. A. Wolfe,
/// "Nonparametric Statistical Methods", 1973, p. 29; also on R's help page of `wilcox.test`).
#[cfg(test)]
const DEPRESSION: [f64; 9] = [0.952, -0.147, 1.022, 0.43, 0.62, 0.59, 0.49, -0.08, 0.01];
