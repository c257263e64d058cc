//! Why a description of a hand, an object or a scene is refused.

use crate::bodies::BodyFault;
use crate::hand::HandError;
use crate::shape::ShapeFault;
use regrasp_api::{Departure, EndsError, MeshError, MeshSourceError, PoseError, Refusal, Refuse};
use thiserror::Error;

/// Why a description is refused: each message names the key or the file, the value and what is allowed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum WorldError {
    /// A value outside its range.
    #[error("`{key}` = {value} is outside {range}")]
    Range {
        /// The path of the key, such as `object.shape.radius`.
        key: String,
        /// The value that was given.
        value: String,
        /// The allowed range, with its unit.
        range: String,
    },
    /// Data that depart from their schema.
    #[error(transparent)]
    Departs(Box<Departure>),
    /// Start or goals.
    #[error(transparent)]
    Ends(#[from] EndsError),
    /// A shape of an obstacle or of a link.
    #[error(transparent)]
    Shape(#[from] ShapeFault),
    /// A value that cannot be used; the text says why.
    #[error("`{key}`: {reason}")]
    Value {
        /// The path of the key.
        key: String,
        /// Why, and what to do.
        reason: String,
    },
    /// A pose that cannot be read.
    #[error("`{key}`: {error}")]
    Pose {
        /// The path of the key.
        key: String,
        /// What is wrong with it.
        error: PoseError,
    },
    /// The hand; its keys are below `hand`.
    #[error("in `hand`: {0}")]
    Hand(#[from] HandError),
    /// A mesh given in place that cannot be used.
    #[error("`{key}`: the mesh is refused: {source}")]
    Mesh {
        /// The path of the key.
        key: String,
        /// What is wrong with the mesh, and the fix.
        source: MeshError,
    },
    /// A mesh that is no rigid object.
    #[error("`{key}`: {fault}")]
    Body {
        /// The path of the key.
        key: String,
        /// Why, and the fix.
        fault: BodyFault,
    },
}

impl From<Departure> for WorldError {
    fn from(departure: Departure) -> Self {
        Self::Departs(Box::new(departure))
    }
}

impl Refuse for WorldError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Range { key, value, range } => {
                Refusal::new("out-of-range", self).key(key).value(value).range(range)
            }
            Self::Departs(departure) => departure.refusal(),
            Self::Ends(error) => error.refusal(),
            Self::Shape(fault) => fault.refusal(),
            Self::Value { key, .. } => Refusal::new("value", self).key(key),
            Self::Pose { key, error } => error.refusal().told(self).below(key),
            Self::Hand(error) => error.refusal().told(self).below("hand"),
            Self::Mesh { key, .. } | Self::Body { key, .. } => Refusal::new("mesh", self).key(key),
        }
    }
}

impl WorldError {
    /// A value outside its range.
    pub(crate) fn range(key: impl Into<String>, value: impl ToString, range: impl Into<String>) -> Self {
        Self::Range { key: key.into(), value: value.to_string(), range: range.into() }
    }

    /// A mesh source, at `key`, that gives no mesh.
    pub fn mesh(key: &str, error: MeshSourceError) -> Self {
        match error {
            MeshSourceError::Mesh(source) => Self::Mesh { key: key.into(), source },
            MeshSourceError::Scale(value) => Self::range(format!("{key}.scale"), value, "1e-9..=1e9"),
            MeshSourceError::TooMany(_) => Self::value(format!("{key}.facets"), error.to_string()),
            other => Self::value(key, other.to_string()),
        }
    }

    /// A value that cannot be used.
    pub(crate) fn value(key: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Value { key: key.into(), reason: reason.into() }
    }
}
