//! What a simulation found.

use regrasp_api::{FingerIndex, PerFinger};
use std::fmt;

/// What a simulation allows before it counts as failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Largest distance of the object's origin from where the plan has it (m).
    pub distance: f64,
    /// Largest angle of the object from the planned orientation (rad).
    pub angle: f64,
    /// Largest net slip of a contact in one transfer or regrasp (m).
    pub slip: f64,
    /// Largest gap between a holding fingertip and the object (m), below 1 mm.
    pub gap: f64,
}

/// What must not happen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Happening {
    /// No forces within the contacts' cones and the joints' efforts hold the object.
    NoGrip,
    /// The object strayed from its path, or was dropped.
    Stray,
    /// This finger's contact slipped.
    Slip(FingerIndex),
    /// This finger lost the object.
    Lift(FingerIndex),
}

impl fmt::Display for Happening {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoGrip => write!(f, "no forces within cones and efforts hold the object"),
            Self::Stray => write!(f, "the object strayed"),
            Self::Slip(finger) => write!(f, "finger {} slipped", finger.0 + 1),
            Self::Lift(finger) => write!(f, "finger {} lost the object", finger.0 + 1),
        }
    }
}

/// The first thing that happened and must not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    /// What.
    pub what: Happening,
    /// When, from the start of the simulation (s).
    pub time: f64,
    /// The last state that was passed before.
    pub state: usize,
}

/// What a simulation found: worst values up to its end or its failure.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Largest distance of the object's origin from where the plan has it (m).
    pub distance: f64,
    /// Largest angle of the object from the planned orientation (rad).
    pub angle: f64,
    /// Largest net slip of each contact (m).
    pub slip: PerFinger<f64>,
    /// Largest gap of each contact (m): 0 where it never lost the object.
    pub gap: PerFinger<f64>,
    /// What ended the simulation early.
    pub failure: Option<Failure>,
}

impl Outcome {
    /// Before anything happened.
    pub(crate) fn new(fingers: usize) -> Self {
        Self {
            distance: 0.0,
            angle: 0.0,
            slip: PerFinger::filled(fingers, 0.0),
            gap: PerFinger::filled(fingers, 0.0),
            failure: None,
        }
    }

    /// Whether nothing happened that must not.
    pub fn is_good(&self) -> bool {
        self.failure.is_none()
    }
}
