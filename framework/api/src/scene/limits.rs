//! Tolerances, resolutions and budgets of a planning problem.

use crate::{Pose, angle_between};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How far (radii of the fingertip) a contact may jump in a transfer: in a dent, where the fingertip touches
/// both sides at once and rolls on upon the other. Its normal turns by about as much (rad).
pub const LONGEST_JUMP: f64 = 0.4;

/// What a plan must keep; the verifier holds it to these.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Tolerances {
    /// Largest distance between a holding fingertip and the surface (m).
    #[schemars(range(min = 1e-7, max = 1e-2), extend("x-unit" = "m"))]
    pub closure: f64,
    /// Largest net slip of a contact from its finger's touch-down to its lift (m).
    #[schemars(range(min = 1e-7, max = 1e-2), extend("x-unit" = "m"))]
    pub slip: f64,
    /// Largest angle between a contact's normal and the surface's (rad).
    #[schemars(range(min = 1e-6, max = 0.5), extend("x-unit" = "rad"))]
    pub normal: f64,
    /// Least distance between bodies that may not touch (m).
    #[schemars(range(min = 0.0, max = 0.1), extend("x-unit" = "m"))]
    pub clearance: f64,
    /// Largest distance of the object from a goal's position (m).
    #[schemars(range(min = 1e-9, max = 0.1), extend("x-unit" = "m"))]
    pub goal_position: f64,
    /// Largest angle of the object from a goal's orientation (rad).
    #[schemars(range(min = 1e-9, max = 1.0), extend("x-unit" = "rad"))]
    pub goal_angle: f64,
}

impl Tolerances {
    /// Whether an object at one pose is where it is to be at the other.
    pub fn coincide(&self, X_HA: &Pose, X_HB: &Pose) -> bool {
        let apart = (X_HA.translation.vector - X_HB.translation.vector).norm();
        apart <= self.goal_position && angle_between(&X_HA.rotation, &X_HB.rotation) <= self.goal_angle
    }
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
    #[schemars(range(min = 1e-5, max = 0.1), extend("x-unit" = "m"))]
    pub grasp_step: f64,
    /// Largest turn of the object in one step on a path in GS_n (rad); by default 2 degrees.
    #[schemars(range(min = 1e-4, max = 1.0), extend("x-unit" = "rad"))]
    pub grasp_turn: f64,
    /// Largest step of the object or a contact in a transfer (m).
    #[schemars(range(min = 1e-5, max = 0.1), extend("x-unit" = "m"))]
    pub transfer_step: f64,
    /// Largest turn of the object in one step of a transfer (rad); by default 1.5 degrees.
    #[schemars(range(min = 1e-4, max = 1.0), extend("x-unit" = "rad"))]
    pub transfer_turn: f64,
    /// Largest step of a fingertip in a regrasp (m).
    #[schemars(range(min = 1e-5, max = 0.1), extend("x-unit" = "m"))]
    pub regrasp_step: f64,
    /// Height above the surface at which a finger moves to its new contact (m).
    #[schemars(range(min = 1e-4, max = 0.2), extend("x-unit" = "m"))]
    pub lift: f64,
    /// Heights to which every holding finger must be able to retreat along its normal (m).
    #[schemars(inner(range(min = 0.0, max = 0.2)), extend("x-unit" = "m"))]
    pub retreat: [f64; 2],
    /// Distance that the planner keeps between bodies that may not touch (m), beyond the tolerance.
    #[schemars(range(min = 0.0, max = 0.05), extend("x-unit" = "m"))]
    pub clearance: f64,
    /// Distance that contacts keep from a sharp edge when they are chosen (m).
    #[schemars(range(min = 0.0, max = 0.1), extend("x-unit" = "m"))]
    pub edge_margin: f64,
    /// What the friction coefficient is multiplied with while planning (no unit), so that grasps keep a
    /// margin.
    ///
    /// The paper counts with all of it. A grasp that closes by the last of the friction alone needs large
    /// forces in exact directions, and plans are to be carried out: simulated, 47 of 50 plans of `cubic`
    /// arrive with 0.8, 36 with 0.95.
    #[schemars(range(min = 0.01, max = 1.0), extend("x-unit" = "1"))]
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
            friction_margin: 0.8,
        }
    }
}

/// When the search gives up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Budget {
    /// Most nodes to generate for one goal. The default is five times what the hardest built-in scenario
    /// needs, and tens of seconds where there is no way.
    #[schemars(range(min = 1, max = 10_000_000))]
    pub max_nodes: usize,
    /// Most time for the whole run (s); no limit where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 1e7), extend("x-unit" = "s"))]
    #[schemars(example = 60.0)]
    pub time_limit: Option<f64>,
    /// Tries of the smoother, per segment of the raw plan.
    #[schemars(range(min = 0, max = 1_000_000))]
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
