//! Why a plan cannot be shown.

use regrasp_api::PoseError;
use regrasp_world::{HandError, WorldError};
use thiserror::Error;

/// A plan cannot be shown.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The hand makes no sense.
    #[error("the plan's hand: {0}")]
    Hand(#[from] HandError),
    /// The object or an obstacle makes no sense.
    #[error("the plan's {0}")]
    World(#[from] WorldError),
    /// A pose of palm, link or obstacle cannot be read.
    #[error("`{key}`: {error}")]
    Pose {
        /// Where in the plan's problem.
        key: String,
        /// What is wrong with it.
        error: PoseError,
    },
    /// A segment or state does not fit the hand, or holds a number that is not finite.
    #[error("segment {}, state {}: {reason}; `regrasp verify` says more", .segment + 1, .state + 1)]
    State {
        /// The segment, counted from 0.
        segment: usize,
        /// The state within the segment, counted from 0.
        state: usize,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// One of the plans beside the first.
    #[error("`{label}` cannot be shown: {error}")]
    Beside {
        /// What tells it from the others.
        label: String,
        /// What is wrong with it.
        error: Box<ViewError>,
    },
    /// What is to be shown beside the plan does not belong to it.
    #[error("{0}")]
    Foreign(String),
}
