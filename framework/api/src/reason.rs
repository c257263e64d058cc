//! Why something was refused: one small enum, so that every failure can be counted and explained.

use serde::{Deserialize, Serialize};

/// Why a sample, a motion or a grasp was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Reason {
    /// No joint positions bring the fingertip there.
    Reach,
    /// A joint left its limits.
    Limits,
    /// Bodies that may not touch came closer than the clearance.
    Collision,
    /// A contact could not be kept: the loop hand-object did not close, or the contact point jumped.
    Closure,
    /// The grasp is not stable.
    Stability,
    /// Too few of the grasp's fingers can be lifted with the rest still stable.
    Liftable,
    /// A holding finger cannot retreat from the object.
    Retreat,
    /// A contact lies too close to a sharp edge.
    Edge,
    /// No path on the surface joins two points, or a fingertip cannot follow it.
    Surface,
    /// A fingertip slipped by more than the bound.
    Slip,
    /// The object strayed from its path (simulation).
    Stray,
    /// The call's own budget of tries is used up.
    Budget,
    /// A cause of the plugin's own, which it counts under a word of its own ([`crate::Context::reject_for`]).
    Other,
}

impl Reason {
    /// Every reason, in the order of their numbers.
    pub const ALL: [Self; 13] = [
        Self::Reach,
        Self::Limits,
        Self::Collision,
        Self::Closure,
        Self::Stability,
        Self::Liftable,
        Self::Retreat,
        Self::Edge,
        Self::Surface,
        Self::Slip,
        Self::Stray,
        Self::Budget,
        Self::Other,
    ];

    /// The name used in files and tables, in kebab case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reach => "reach",
            Self::Limits => "limits",
            Self::Collision => "collision",
            Self::Closure => "closure",
            Self::Stability => "stability",
            Self::Liftable => "liftable",
            Self::Retreat => "retreat",
            Self::Edge => "edge",
            Self::Surface => "surface",
            Self::Slip => "slip",
            Self::Stray => "stray",
            Self::Budget => "budget",
            Self::Other => "other",
        }
    }
}
