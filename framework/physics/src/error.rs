//! Why there is no simulation.

use thiserror::Error;

/// Why a simulation could not be set up.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PhysicsError {
    /// A setting outside its range.
    #[error("`{key}` = {value} is outside {low}..={high}")]
    Range {
        /// The setting's key.
        key: &'static str,
        /// Its value.
        value: f64,
        /// Lowest allowed value.
        low: f64,
        /// Highest allowed value.
        high: f64,
    },
    /// The object's shape.
    #[error("the object's shape cannot be simulated: {0}")]
    Shape(String),
    /// The problem does not make a world.
    #[error("{0}")]
    Problem(String),
    /// The plan relies on torsional friction.
    #[error(
        "rapier's contacts carry no torsional friction, but the contact model relies on it; use \
            `contact-model/pcwf`, or a simulator that has it"
    )]
    Torsion,
    /// The hand declares point fingertips.
    #[error(
        "simulated fingertips are balls, which roll, but the hand declares point fingertips, which stay \
            where they are set down; plan with balls"
    )]
    PointFingertips,
}
