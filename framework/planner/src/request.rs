//! What a run is asked for.

use crate::report::{Clock, Progress};
use regrasp_api::{Clearance, Hand, Interrupt, ObjectModel, Plugins, Problem};

/// Everything a run needs.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// Start, goals, gravity, workspace and limits; hand and object are taken from below.
    pub problem: &'a Problem,
    /// The hand.
    pub hand: &'a dyn Hand,
    /// Collision and distance, built with the planner's clearance.
    pub clearance: &'a dyn Clearance,
    /// The object.
    pub object: &'a ObjectModel,
    /// The plugins.
    pub plugins: Plugins<'a>,
    /// Seed of all random streams.
    pub seed: u64,
    /// How many threads compute; the result does not depend on it.
    pub threads: usize,
    /// Stops the run from outside.
    pub interrupt: &'a dyn Interrupt,
    /// Times the phases.
    pub clock: &'a dyn Clock,
    /// Told how far the run is.
    pub progress: &'a dyn Progress,
}
