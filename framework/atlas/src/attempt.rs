//! What was found for one member.

use crate::Member;
use serde::{Deserialize, Serialize};

/// How an attempt ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Found {
    /// A plan leads there, and the verifier accepts it.
    Reached,
    /// No grasp was found in that orientation, at none of the positions.
    NoGrasp,
    /// There are grasps, and no way to them was found within the budget.
    NoWay,
    /// The verifier refuses the plans that were found.
    Unverified,
}

impl Found {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Reached, Self::NoGrasp, Self::NoWay, Self::Unverified];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::NoGrasp => "no-grasp",
            Self::NoWay => "no-way",
            Self::Unverified => "unverified",
        }
    }
}

/// One orientation that was to be reached.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attempt {
    /// Where the object began (m), in H.
    pub start: [f64; 3],
    /// The axis of the turn, in H.
    pub axis: [f64; 3],
    /// The angle of the turn, 0 to 180 (degrees).
    pub angle_deg: f64,
    /// How it ended.
    pub found: Found,
    /// Positions that were tried.
    pub tries: usize,
    /// Regrasps of the plan; absent where there is none.
    pub regrasps: Option<usize>,
}

/// All attempts of one member.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// Its number in the family, from 0.
    pub number: usize,
    /// The member.
    pub member: Member,
    /// Start grasps that were found.
    pub grasps: u64,
    /// Poses that were drawn for them.
    pub poses: u64,
    /// Why there are no attempts; absent where there are some.
    pub cause: Option<String>,
    /// The attempts, in turn.
    pub attempts: Vec<Attempt>,
}
