//! Tolerances, resolutions and budgets of a planning problem.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a plan must keep; the verifier holds it to these.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Tolerances {
    /// Largest distance between a holding fingertip and the surface (m).
    pub closure: f64,
    /// Largest net slip of a contact over one transfer (m).
    pub slip: f64,
    /// Largest angle between a contact's normal and the surface's (rad).
    pub normal: f64,
    /// Least distance between bodies that may not touch (m).
    pub clearance: f64,
    /// Largest distance of the object from a goal's position (m).
    pub goal_position: f64,
    /// Largest angle of the object from a goal's orientation (rad).
    pub goal_angle: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self {
            closure: 20e-6,
            slip: 1e-4,
            normal: 1e-3,
            clearance: 0.0,
            goal_position: 1e-6,
            goal_angle: 1e-6,
        }
    }
}

/// How finely and how carefully the planner works.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Resolution {
    /// Largest step of the object or a contact on a path in GS_n (m).
    pub grasp_step: f64,
    /// Largest turn of the object in one step on a path in GS_n (rad).
    pub grasp_turn: f64,
    /// Largest step of the object or a contact in a transfer (m).
    pub transfer_step: f64,
    /// Largest turn of the object in one step of a transfer (rad).
    pub transfer_turn: f64,
    /// Largest step of a fingertip in a regrasp (m).
    pub regrasp_step: f64,
    /// Height above the surface at which a finger moves to its new contact (m).
    pub lift: f64,
    /// Heights to which every holding finger must be able to retreat along its normal (m).
    pub retreat: [f64; 2],
    /// Distance that the planner keeps between bodies that may not touch (m), beyond the tolerance.
    pub clearance: f64,
    /// Distance that contacts keep from a sharp edge when they are chosen (m).
    pub edge_margin: f64,
    /// What the friction coefficient is multiplied with while planning, in (0, 1], so that transfers keep a margin.
    pub friction_margin: f64,
}

impl Default for Resolution {
    fn default() -> Self {
        let degree = std::f64::consts::PI / 180.0;
        Self {
            grasp_step: 1.5e-3,
            grasp_turn: 2.0 * degree,
            transfer_step: 1e-3,
            transfer_turn: 1.5 * degree,
            regrasp_step: 1.5e-3,
            lift: 8e-3,
            retreat: [3e-3, 8e-3],
            clearance: 5e-4,
            edge_margin: 3e-3,
            friction_margin: 0.95,
        }
    }
}

/// When the search gives up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Budget {
    /// Most nodes to generate for one goal. The default is five times what the hardest built-in scenario needs, and tens of seconds where
    /// there is no way.
    pub max_nodes: usize,
    /// Most seconds for the whole run; none where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit: Option<f64>,
    /// Tries of the smoother, per segment of the raw plan.
    pub smoothing: usize,
}

impl Default for Budget {
    fn default() -> Self {
        Self { max_nodes: 1000, time_limit: None, smoothing: 2 }
    }
}

/// Everything under `[limits]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// What a plan must keep.
    pub tolerances: Tolerances,
    /// How finely the planner works.
    pub resolution: Resolution,
    /// When the search gives up.
    pub budget: Budget,
}
