//! Why a plan cannot be exported.

use regrasp_api::PoseError;
use regrasp_physics::PhysicsError;
use regrasp_plan::ConvertError;
use regrasp_world::{HandError, WorldError};
use thiserror::Error;

/// Why a plan cannot be exported.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The plan's hand.
    #[error(transparent)]
    Hand(#[from] HandError),
    /// The plan's object, or a mesh of its hand.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The plan's states.
    #[error(transparent)]
    Motion(#[from] ConvertError),
    /// A pose of hand or obstacles.
    #[error("`{key}`: {error}")]
    Pose {
        /// Where it is in the plan's problem.
        key: String,
        /// What is wrong.
        error: PoseError,
    },
    /// No motion.
    #[error("the plan has no motion to export")]
    Empty,
    /// The forces.
    #[error("no grasp forces: {0}")]
    Forces(#[from] PhysicsError),
    /// A half-space as a link's shape, or a degenerate shape.
    #[error("`{key}`: {reason}")]
    Shape {
        /// Which shape.
        key: String,
        /// What is wrong.
        reason: String,
    },
    /// Writing into memory failed, which only an archive of over 4 GiB does.
    #[error("the export is too large for its format: {0}")]
    TooLarge(#[from] std::io::Error),
    /// The archive of arrays.
    #[error("the arrays do not fit their archive: {0}")]
    Archive(#[from] zip::result::ZipError),
}
