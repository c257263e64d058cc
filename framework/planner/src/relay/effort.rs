//! How hard a relay tries.

/// How hard a relay tries.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Stations that it may try.
    pub stations: usize,
    /// Points of the surface that are looked at for each finger of a station.
    pub points: usize,
    /// Touches of a finger that are kept there, the farthest reaching first.
    pub kept: usize,
    /// Random choices that are weighed for each number of fingers.
    pub draws: usize,
}

/// Enough for most of what can be done; what fails costs little.
pub(crate) const QUICK: Effort = Effort { stations: 10, points: 100, kept: 8, draws: 10 };
/// For hands in which little is within reach.
pub(crate) const THOROUGH: Effort = Effort { stations: 20, points: 300, kept: 20, draws: 40 };
