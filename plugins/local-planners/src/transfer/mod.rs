//! What transfer planners share: the object's straight motion, the length of steps, what fingertips they are
//! for.

mod motion;
mod pace;

pub(crate) use motion::Motion;
pub(crate) use pace::Pace;
use regrasp_api::{BuildError, Fingertip, Hand};

/// Refuses a hand whose fingertips are not what a plugin moves, and says what to use.
pub(crate) fn demand_fingertip(wanted: Fingertip, hand: &dyn Hand) -> Result<(), BuildError> {
    let refusal = match (wanted, hand.fingertip()) {
        (Fingertip::Ball, Fingertip::Point) => {
            "it rolls balls, and the hand declares point fingertips, which stay where they are set down; use \
             `local-planner/fixed-point`, or take `fingertip = \"point\"` out of the hand's file"
        }
        (Fingertip::Point, Fingertip::Ball) => {
            "it keeps contact points where they are, and the hand's fingertips are balls, which roll; use \
             `local-planner/rolling`, or declare `fingertip = \"point\"` in the hand's file"
        }
        _ => return Ok(()),
    };
    Err(BuildError::Unsupported(refusal.into()))
}
