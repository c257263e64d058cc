//! What grasps must bear besides being closed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the grasps of a plan must hold in the world: `[hold]` in a scenario. With it plans are made for the
/// object's weight and the joints' efforts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HoldDescription {
    /// Whether the object's weight must be held.
    pub weight: bool,
    /// Plan as if friction were this share (0.05 to 1) of what is given, in place of
    /// `limits.resolution.friction_margin`; `"most"` plans with 0.8, then with less and less, and keeps the
    /// plan that needs least.
    pub friction_factor: FrictionFactor,
    /// Largest disturbing force (N) and torque (N·m) at the centre of mass, in any direction, which must be
    /// held beside the weight.
    #[schemars(inner(range(min = 0.0, max = 1e4)), extend("x-unit" = "N"))]
    pub disturbance: [f64; 2],
    /// The share (0 to 1) of its torsional friction with which a soft finger drags while it spins, as it does
    /// whenever the object moves: grasps must hold whichever way each finger drags. By default 1 where
    /// contacts carry torsion; 0 for fingertips that spin freely.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    #[schemars(example = 1.0)]
    pub drag: Option<f64>,
    /// Largest normal force of one contact (N), for fragile objects; where absent the joints' efforts alone
    /// bound it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-2, max = 1e4), extend("x-unit" = "N"))]
    #[schemars(example = 10.0)]
    pub max_normal_force: Option<f64>,
}

impl Default for HoldDescription {
    fn default() -> Self {
        Self {
            weight: true,
            friction_factor: FrictionFactor::Share(0.8),
            disturbance: [0.0; 2],
            drag: None,
            max_normal_force: None,
        }
    }
}

/// The share of the friction that a plan relies on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum FrictionFactor {
    /// This share.
    Share(f64),
    /// As little as a plan can be made with.
    Most(Most),
}

/// The word `most`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Most {
    /// As little friction as a plan can be made with.
    Most,
}

impl FrictionFactor {
    /// The shares to plan with, one after the other, each less than the one before: a plan for less friction
    /// replaces one for more.
    pub fn shares(&self) -> &[f64] {
        match self {
            Self::Share(share) => std::slice::from_ref(share),
            Self::Most(_) => &[0.8, 0.7, 0.6, 0.5],
        }
    }
}
