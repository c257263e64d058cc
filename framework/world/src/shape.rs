//! What a shape may be.

use regrasp_api::{Departure, Refusal, Refuse, Shape, Vec3, check_described};
use thiserror::Error;

/// Why a shape is refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ShapeFault {
    /// A number outside its range, or not finite.
    #[error(transparent)]
    Departs(Box<Departure>),
    /// A vector that must have a direction is zero or not finite.
    #[error("`{key}` = {value:?} has no direction; give three finite numbers that are not all zero")]
    NoDirection {
        /// Path of the key, such as `palm[0].shape.normal`.
        key: String,
        /// The vector given.
        value: [f64; 3],
    },
}

impl From<Departure> for ShapeFault {
    fn from(departure: Departure) -> Self {
        Self::Departs(Box::new(departure))
    }
}

impl Refuse for ShapeFault {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Departs(departure) => departure.refusal(),
            Self::NoDirection { key, value } => {
                Refusal::new("value", self).key(key).value(format!("{value:?}"))
            }
        }
    }
}

/// Refuses a shape, described at `key`, that makes no sense; a mesh is checked where it is read.
pub(crate) fn check_shape(shape: &Shape, key: &str) -> Result<(), ShapeFault> {
    match shape {
        Shape::Mesh(_) => return Ok(()),
        Shape::HalfSpace { normal, .. } => check_direction(normal, format!("{key}.normal"))?,
        _ => {}
    }
    Ok(check_described(shape, key)?)
}

/// Refuses a vector without a direction.
pub(crate) fn check_direction(value: &[f64; 3], key: String) -> Result<(), ShapeFault> {
    let length = Vec3::from(*value).norm();
    let has_direction = length.is_finite() && length > 1e-9;
    if has_direction { Ok(()) } else { Err(ShapeFault::NoDirection { key, value: *value }) }
}
