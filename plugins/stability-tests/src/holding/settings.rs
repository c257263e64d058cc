//! What `stability-test/holding` can be asked for.

use regrasp_api::Settings;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Settings of [`super::Holding`]; `[hold]` in a scenario gives them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HoldingSettings {
    /// Whether the object's weight must be held.
    pub weight: bool,
    /// The share of the friction that the plan claims to rely on (no unit); the planner hands the test cones
    /// of that friction. By default 0.8.
    #[schemars(range(min = 0.05, max = 1.0), extend("x-unit" = "1"))]
    pub friction_factor: f64,
    /// Largest disturbing force at the centre of mass, in any direction (N); 0 for none.
    #[schemars(range(min = 0.0, max = 1e4), extend("x-unit" = "N"))]
    pub disturbance_force: f64,
    /// Largest disturbing torque, about any axis (N·m); 0 for none.
    #[schemars(range(min = 0.0, max = 1e3), extend("x-unit" = "N·m"))]
    pub disturbance_torque: f64,
    /// The share of their torsional friction with which contacts drag while they spin, each one way or the
    /// other, and which the others must balance; `[hold]` sets it for soft fingers. By default none.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub drag: f64,
    /// Largest normal force of one contact (N); where absent the joints' efforts alone bound it.
    #[schemars(range(min = 1e-2, max = 1e4), extend("x-unit" = "N"))]
    #[schemars(example = 10.0)]
    pub max_normal_force: Option<f64>,
    /// The share of friction and efforts that is kept back (no unit), so that what holds at a plan's states
    /// holds between them too, and where the object has drifted by a degree or two. With 0.03 three of 28
    /// plans were dropped at the friction they were planned for; with 0.05 those three are carried out.
    #[schemars(range(min = 0.0, max = 0.5), extend("x-unit" = "1"))]
    pub reserve: f64,
}

impl Default for HoldingSettings {
    fn default() -> Self {
        Self {
            weight: true,
            friction_factor: 0.8,
            disturbance_force: 0.0,
            disturbance_torque: 0.0,
            drag: 0.0,
            max_normal_force: None,
            reserve: 0.05,
        }
    }
}

impl Settings for HoldingSettings {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_outside_their_range_are_refused() {
        for (json, key) in [
            (r#"{"friction_factor": 0.01}"#, "friction_factor"),
            (r#"{"disturbance_force": -1}"#, "disturbance_force"),
            (r#"{"disturbance_torque": -1}"#, "disturbance_torque"),
            (r#"{"drag": 1.5}"#, "drag"),
            (r#"{"max_normal_force": 0}"#, "max_normal_force"),
            (r#"{"reserve": 0.9}"#, "reserve"),
        ] {
            let error = HoldingSettings::from_json(json).unwrap_err().to_string();
            assert!(error.contains(key), "{error}");
        }
    }
}
