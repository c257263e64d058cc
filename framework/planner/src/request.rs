//! What a run is asked for.

use crate::report::{Clock, Progress};
use crate::session::Drivers;
use regrasp_api::{
    Clearance, ContactModel, Hand, Interrupt, ObjectModel, Problem, StabilityTest, SurfaceParam,
};

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
    /// Which wrenches contacts transmit.
    pub contact_model: &'a dyn ContactModel,
    /// Which grasps are stable.
    pub stability: &'a dyn StabilityTest,
    /// The object's surface.
    pub surface: &'a dyn SurfaceParam,
    /// The plugins that drive the search.
    pub drivers: Drivers<'a>,
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
