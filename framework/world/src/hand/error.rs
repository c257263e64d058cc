//! Why a hand's description is refused.

use crate::shape::ShapeFault;
use regrasp_api::{Departure, PoseError, Refusal, Refuse};
use thiserror::Error;

/// Why a hand's description is refused; each message names the key, the value, the allowed range and the
/// likely fix.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum HandError {
    /// A number outside its range, or not finite.
    #[error("`{key}` = {value} is outside {range}{hint}")]
    Range {
        /// Path of the key, such as `finger[1].joint[2].lower`.
        key: String,
        /// The value given.
        value: f64,
        /// The allowed range, such as `0.0001..=0.2`.
        range: String,
        /// What is probably wrong, with its leading `; `, or nothing.
        hint: &'static str,
    },
    /// Data that depart from their schema.
    #[error("{departure}{hint}")]
    Departs {
        /// Where, and how.
        departure: Box<Departure>,
        /// What is probably wrong, with its leading `; `, or nothing.
        hint: &'static str,
    },
    /// A shape, or an axis.
    #[error(transparent)]
    Shape(#[from] ShapeFault),
    /// A vector with a coordinate that is NaN or infinite.
    #[error("`{key}` = {value:?} must be three finite numbers (m)")]
    NotFinite {
        /// Path of the key, such as `finger[1].tip`.
        key: String,
        /// The vector given.
        value: [f64; 3],
    },
    /// A pose that cannot be read.
    #[error("`{key}`: {error}")]
    Pose {
        /// Path of the key, such as `finger[1].base`.
        key: String,
        /// What is wrong with it.
        error: PoseError,
    },
    /// Lower limit not below the upper one.
    #[error(
        "`{key}.lower` = {lower} must be less than `{key}.upper` = {upper}; a joint that does not move \
            belongs into the next `origin`"
    )]
    EmptyLimits {
        /// Path of the joint, such as `finger[1].joint[2]`.
        key: String,
        /// The lower limit.
        lower: f64,
        /// The upper limit.
        upper: f64,
    },
    /// The rest posture has the wrong number of joints.
    #[error(
        "`{key}` has {given} positions, but the finger has {wanted} joints; give one position for each joint"
    )]
    RestCount {
        /// Path of the key, such as `finger[1].rest`.
        key: String,
        /// How many positions are given.
        given: usize,
        /// How many joints the finger has.
        wanted: usize,
    },
    /// The hand has no finger, or too many; or a finger has too many joints.
    #[error("`{key}` has {given} entries, allowed are {range}")]
    Count {
        /// Path of the list, such as `finger` or `finger[1].joint`.
        key: String,
        /// How many entries it has.
        given: usize,
        /// How many it may have, such as `1..=8`.
        range: String,
    },
    /// A name is missing.
    #[error("`{key}` is empty; give it a name")]
    EmptyName {
        /// Path of the key, such as `finger[1].name`.
        key: String,
    },
    /// A name that was taken before.
    #[error("`{key}` = \"{name}\" is the name of `{first}` too; names must differ")]
    DuplicateName {
        /// Path of the key, such as `finger[1].name`.
        key: String,
        /// The name.
        name: String,
        /// Path of the key that has the name already.
        first: String,
    },
    /// A `mimic` names no joint that could drive.
    #[error(
        "`{key}` = \"{name}\" must name another joint of the same finger, one without a `mimic` of its own"
    )]
    Driver {
        /// Path of the key, such as `finger[1].joint[2].mimic.joint`.
        key: String,
        /// The name given.
        name: String,
    },
    /// A driver takes its driven joint beyond the limits.
    #[error(
        "`{key}.mimic`: at the {end} limit of \"{driver}\" the joint stands at {driven}, outside its own \
            limits {}..={}; narrow the limits of \"{driver}\"",
        limits.0, limits.1
    )]
    DrivenTooFar {
        /// Path of the driven joint, such as `finger[1].joint[2]`.
        key: String,
        /// The driver's name.
        driver: String,
        /// `lower` or `upper`.
        end: &'static str,
        /// Where the driven joint would stand.
        driven: f64,
        /// Its limits.
        limits: (f64, f64),
    },
    /// `touching` names a body that there is not, or that is not the only one of that name.
    #[error(
        "`{key}` = \"{name}\" must be `palm`, a joint (for the link behind it) or a finger (for its tip), \
            and no two of these"
    )]
    NoSuchBody {
        /// Path of the key, such as `touching[0][1]`.
        key: String,
        /// The name given.
        name: String,
    },
    /// A finger that cannot place its tip freely in space.
    #[error(
        "finger \"{finger}\" (`{key}`) has {independent} independent joints, at least three are needed: its \
            tip must be able to move in all directions; add a joint or change an axis"
    )]
    TooFewIndependentJoints {
        /// The finger's name.
        finger: String,
        /// Path of the finger, such as `finger[1]`.
        key: String,
        /// In how many independent directions its joints can move the tip.
        independent: usize,
    },
}

impl Refuse for HandError {
    fn refusal(&self) -> Refusal {
        let value = |key: &str| Refusal::new("value", self).key(key);
        match self {
            Self::Range { key, value, range, hint } => Refusal::new("out-of-range", self)
                .key(key)
                .value(value)
                .range(range)
                .remedy(hint.trim_start_matches("; ")),
            Self::Departs { departure, hint } => {
                departure.refusal().told(self).remedy(hint.trim_start_matches("; "))
            }
            Self::Shape(fault) => fault.refusal(),
            Self::NotFinite { key, value: given } => value(key).value(format!("{given:?}")),
            Self::Pose { key, error } => error.refusal().told(self).below(key),
            Self::EmptyLimits { key, lower, upper } => {
                value(&format!("{key}.lower")).value(lower).range(format!("..{upper}"))
            }
            Self::RestCount { key, given, wanted } => value(key).value(given).range(wanted),
            Self::Count { key, given, range } => {
                Refusal::new("out-of-range", self).key(key).value(given).range(range)
            }
            Self::EmptyName { key } => value(key).remedy("give it a name"),
            Self::DuplicateName { key, name, .. }
            | Self::Driver { key, name }
            | Self::NoSuchBody { key, name } => value(key).value(name),
            Self::DrivenTooFar { key, driver, driven, limits, .. } => value(&format!("{key}.mimic"))
                .value(driven)
                .range(format!("{}..={}", limits.0, limits.1))
                .remedy(format!("narrow the limits of \"{driver}\"")),
            Self::TooFewIndependentJoints { key, .. } => value(key).remedy("add a joint or change an axis"),
        }
    }
}
