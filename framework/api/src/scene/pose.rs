//! A pose as plain data.

use crate::{Pose, Refusal, Refuse, Rotation, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A pose: a position, and an orientation as a quaternion or as axis and angle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PoseDescription {
    /// Position (m).
    #[serde(default)]
    #[schemars(inner(range(min = -1e3, max = 1e3)), extend("x-unit" = "m"))]
    pub position: [f64; 3],
    /// Orientation as a quaternion w, x, y, z (no unit); normalised when read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("examples" = [[0.707, 0.0, 0.0, 0.707]]))]
    #[schemars(extend("x-unit" = "1"))]
    pub orientation: Option<[f64; 4]>,
    /// Orientation as a turn about this axis (a direction, of any length), instead of a quaternion; needs
    /// `angle_deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1"))]
    pub axis: Option<[f64; 3]>,
    /// The angle of the turn about `axis` (degrees).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -36e3, max = 36e3), extend("x-unit" = "degrees"))]
    pub angle_deg: Option<f64>,
}

/// The farthest (m) that a pose may lie from its frame.
const FARTHEST: f64 = 1e3;
/// The largest angle (degrees) of a pose, a hundred turns: beyond, the digits of an angle mean nothing.
const LARGEST_ANGLE: f64 = 36_000.0;

/// Why a pose cannot be read.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PoseError {
    /// A coordinate that is not finite, or too large (m).
    #[error("`position` must be three finite numbers in -{FARTHEST}..={FARTHEST} m")]
    Position([f64; 3]),
    /// No quaternion.
    #[error("`orientation` must be a quaternion w, x, y, z that is finite and not zero")]
    Orientation([f64; 4]),
    /// No axis, or no angle (degrees).
    #[error("`axis` must be finite and not zero, `angle_deg` finite")]
    Turn([f64; 3], f64),
    /// An angle out of range (degrees).
    #[error("`angle_deg` = {0} is outside -{LARGEST_ANGLE}..={LARGEST_ANGLE} degrees")]
    Angle(f64),
    /// The orientation is given twice, or by half.
    #[error("give either `orientation`, or both `axis` and `angle_deg`")]
    TwoWays,
}

impl Refuse for PoseError {
    fn refusal(&self) -> Refusal {
        let refusal = Refusal::new("pose", self);
        match self {
            Self::Position(position) => refusal.key("position").value(format!("{position:?}")),
            Self::Orientation(quaternion) => refusal.key("orientation").value(format!("{quaternion:?}")),
            Self::Turn(axis, angle) => refusal.key("axis").value(format!("{axis:?}, {angle} degrees")),
            Self::Angle(angle) => refusal.key("angle_deg").value(angle.to_string()),
            Self::TwoWays => refusal.remedy(self),
        }
    }
}

impl PoseDescription {
    /// The pose; `Err` says which key is wrong and why.
    pub fn pose(&self) -> Result<Pose, PoseError> {
        if !self.position.iter().all(|x| (-FARTHEST..=FARTHEST).contains(x)) {
            return Err(PoseError::Position(self.position));
        }
        let rotation = match (self.orientation, self.axis, self.angle_deg) {
            (None, None, None) => Rotation::identity(),
            (Some([w, x, y, z]), None, None) => {
                let q = nalgebra::Quaternion::new(w, x, y, z);
                if !(1e-9..=1e9).contains(&q.norm()) {
                    return Err(PoseError::Orientation([w, x, y, z]));
                }
                Rotation::from_quaternion(q)
            }
            (None, Some(axis), Some(angle)) => {
                let direction = Vec3::from(axis);
                if !(-LARGEST_ANGLE..=LARGEST_ANGLE).contains(&angle) {
                    return Err(PoseError::Angle(angle));
                }
                if !(1e-9..=1e9).contains(&direction.norm()) {
                    return Err(PoseError::Turn(axis, angle));
                }
                Rotation::from_scaled_axis(direction.normalize() * angle.to_radians())
            }
            _ => return Err(PoseError::TwoWays),
        };
        Ok(Pose::from_parts(Vec3::from(self.position).into(), rotation))
    }
}

impl From<&Pose> for PoseDescription {
    fn from(pose: &Pose) -> Self {
        let q = pose.rotation.quaternion();
        Self {
            position: pose.translation.vector.into(),
            orientation: Some([q.w, q.i, q.j, q.k]),
            axis: None,
            angle_deg: None,
        }
    }
}
