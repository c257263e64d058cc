//! What a local planner made of one problem.

use super::case::Case;
use regrasp_api::{Path, Reached, Tally};

/// What the plugin made of one problem.
pub(crate) struct Journey {
    pub case: &'static Case,
    pub reached: Reached,
    pub path: Path,
    /// What the call counted.
    pub tally: Tally,
}
