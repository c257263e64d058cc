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
    #[schemars(extend("x-unit" = "m"))]
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
    #[schemars(extend("x-unit" = "degrees"))]
    pub angle_deg: Option<f64>,
}

/// Why a pose cannot be read.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PoseError {
    /// A coordinate that is not finite (m).
    #[error("`position` must be three finite numbers")]
    Position([f64; 3]),
    /// No quaternion.
    #[error("`orientation` must be a quaternion w, x, y, z that is finite and not zero")]
    Orientation([f64; 4]),
    /// No axis, or no angle (degrees).
    #[error("`axis` must be finite and not zero, `angle_deg` finite")]
    Turn([f64; 3], f64),
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
            Self::TwoWays => refusal.remedy(self),
        }
    }
}

impl PoseDescription {
    /// The pose; `Err` says which key is wrong and why.
    pub fn pose(&self) -> Result<Pose, PoseError> {
        if !self.position.iter().all(|x| x.is_finite()) {
            return Err(PoseError::Position(self.position));
        }
        let rotation = match (self.orientation, self.axis, self.angle_deg) {
            (None, None, None) => Rotation::identity(),
            (Some([w, x, y, z]), None, None) => {
                let q = nalgebra::Quaternion::new(w, x, y, z);
                if !(q.norm().is_finite() && q.norm() > 1e-9) {
                    return Err(PoseError::Orientation([w, x, y, z]));
                }
                Rotation::from_quaternion(q)
            }
            (None, Some(axis), Some(angle)) => {
                let direction = Vec3::from(axis);
                if !(direction.norm().is_finite() && direction.norm() > 1e-9 && angle.is_finite()) {
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
