//! The settings of `local-planner/rapier-checked`.

use crate::rolling::RollingSettings;
use regrasp_api::Settings;
use regrasp_physics::{Bounds, Pace, SimulationSettings};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Settings of [`super::RapierChecked`]; the defaults are our choices.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RapierCheckedSettings {
    /// How the motion is found that is then simulated: the settings of `local-planner/rolling`.
    pub rolling: RollingSettings,
    /// Largest distance of the object from where the plan has it (m).
    #[schemars(range(min = 1e-5, max = 1.0), extend("x-unit" = "m"))]
    pub max_distance: f64,
    /// Largest angle of the object from the planned orientation (rad).
    #[schemars(range(min = 1e-4, max = 3.0), extend("x-unit" = "rad"))]
    pub max_angle: f64,
    /// Largest net slip of a contact in one transfer (m). Friction in the simulation is a little soft: a
    /// contact that sticks creeps by up to 0.1 mm at the default time step, in proportion to it.
    #[schemars(range(min = 1e-5, max = 1.0), extend("x-unit" = "m"))]
    pub max_slip: f64,
    /// Largest gap between a holding fingertip and the object (m).
    #[schemars(range(min = 1e-6, max = 9e-4), extend("x-unit" = "m"))]
    pub max_gap: f64,
    /// Stiffness of the motors of revolute joints (N·m/rad).
    #[schemars(range(min = 0.1, max = 1e4), extend("x-unit" = "N·m/rad"))]
    pub stiffness: f64,
    /// Stiffness of the motors of prismatic joints (N/m).
    #[schemars(range(min = 10.0, max = 1e6), extend("x-unit" = "N/m"))]
    pub linear_stiffness: f64,
    /// Damping of the motors per stiffness (s).
    #[schemars(range(min = 1e-4, max = 1.0), extend("x-unit" = "s"))]
    pub damping_time: f64,
    /// Friction coefficient in the simulation; the object's own where absent. The forces are planned for the
    /// object's own.
    #[schemars(range(min = 0.0, max = 10.0), extend("x-unit" = "1"))]
    #[schemars(example = 0.8)]
    pub friction: Option<f64>,
    /// Mass of the simulated object (kg); its own where absent. The forces are planned for its own.
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "kg"))]
    #[schemars(example = 0.1)]
    pub mass: Option<f64>,
    /// Most normal force of one contact (N); where absent the greater of 2 N and three times the object's
    /// weight.
    #[schemars(range(min = 0.01, max = 1e4), extend("x-unit" = "N"))]
    #[schemars(example = 5.0)]
    pub grip: Option<f64>,
    /// What part of its effort limit a joint may use to hold the object; the rest is for motion and
    /// correction.
    #[schemars(range(min = 0.01, max = 1.0), extend("x-unit" = "1"))]
    pub effort_share: f64,
    /// What part of the joints' velocity limits the motion uses.
    #[schemars(range(min = 0.01, max = 1.0), extend("x-unit" = "1"))]
    pub speed: f64,
    /// Time (s) in which the motion starts, and in which it stops.
    #[schemars(range(min = 0.0, max = 10.0), extend("x-unit" = "s"))]
    pub ramp: f64,
    /// Time step of the simulation (s).
    #[schemars(range(min = 1e-5, max = 0.005), extend("x-unit" = "s"))]
    pub time_step: f64,
    /// How often a motion that fails is cut to half of what went well and simulated again.
    #[schemars(range(min = 0, max = 20))]
    pub retries: usize,
}

impl Default for RapierCheckedSettings {
    fn default() -> Self {
        let SimulationSettings {
            stiffness,
            linear_stiffness,
            damping_time,
            friction,
            mass,
            time_step,
            grip,
            effort_share,
            ..
        } = SimulationSettings::default();
        Self {
            rolling: RollingSettings::default(),
            max_distance: 2e-3,
            max_angle: 0.05,
            max_slip: 5e-4,
            max_gap: 5e-4,
            stiffness,
            linear_stiffness,
            damping_time,
            friction,
            mass,
            grip,
            effort_share,
            speed: 0.25,
            ramp: 0.1,
            time_step,
            retries: 2,
        }
    }
}

impl Settings for RapierCheckedSettings {}

impl RapierCheckedSettings {
    pub(super) fn simulation(&self) -> SimulationSettings {
        SimulationSettings {
            stiffness: self.stiffness,
            linear_stiffness: self.linear_stiffness,
            damping_time: self.damping_time,
            friction: self.friction,
            mass: self.mass,
            time_step: self.time_step,
            grip: self.grip,
            effort_share: self.effort_share,
            ..SimulationSettings::default()
        }
    }

    pub(super) fn bounds(&self) -> Bounds {
        Bounds { distance: self.max_distance, angle: self.max_angle, slip: self.max_slip, gap: self.max_gap }
    }

    pub(super) fn pace(&self) -> Pace {
        Pace { speed: self.speed, ramp: self.ramp }
    }
}
