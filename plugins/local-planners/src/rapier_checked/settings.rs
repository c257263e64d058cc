//! The settings of `local-planner/rapier-checked`.

use crate::rolling::RollingSettings;
use regrasp_api::{Settings, SettingsError, check_count, check_range};
use regrasp_physics::{Bounds, Pace, SimulationSettings};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Settings of [`super::RapierChecked`]; the defaults are our choices.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RapierCheckedSettings {
    /// How the motion is found that is then simulated: the settings of `local-planner/rolling`.
    pub rolling: RollingSettings,
    /// Largest distance of the object from where the plan has it (m), 1e-5 to 1.
    #[schemars(range(min = 1e-5, max = 1.0))]
    pub max_distance: f64,
    /// Largest angle of the object from the planned orientation (rad), 1e-4 to 3.
    #[schemars(range(min = 1e-4, max = 3.0))]
    pub max_angle: f64,
    /// Largest net slip of a contact in one transfer (m), 1e-5 to 1. Friction in the simulation is a little soft: a contact that sticks creeps by up to
    /// 0.1 mm at the default time step, in proportion to it.
    #[schemars(range(min = 1e-5, max = 1.0))]
    pub max_slip: f64,
    /// Largest gap between a holding fingertip and the object (m), 1e-6 to 9e-4.
    #[schemars(range(min = 1e-6, max = 9e-4))]
    pub max_gap: f64,
    /// Stiffness of the motors of revolute joints (N·m/rad), 0.1 to 1e4.
    #[schemars(range(min = 0.1, max = 1e4))]
    pub stiffness: f64,
    /// Stiffness of the motors of prismatic joints (N/m), 10 to 1e6.
    #[schemars(range(min = 10.0, max = 1e6))]
    pub linear_stiffness: f64,
    /// Damping of the motors per stiffness (s), 1e-4 to 1.
    #[schemars(range(min = 1e-4, max = 1.0))]
    pub damping_time: f64,
    /// Friction coefficient in the simulation, 0 to 10; the object's own where absent. The forces are planned for the object's own.
    #[schemars(range(min = 0.0, max = 10.0))]
    #[schemars(example = 0.8)]
    pub friction: Option<f64>,
    /// Mass of the simulated object (kg), 1e-6 to 1e6; its own where absent. The forces are planned for its own.
    #[schemars(range(min = 1e-6, max = 1e6))]
    #[schemars(example = 0.1)]
    pub mass: Option<f64>,
    /// Most normal force of one contact (N), 0.01 to 1e4; where absent the greater of 2 N and three times the object's weight.
    #[schemars(range(min = 0.01, max = 1e4))]
    #[schemars(example = 5.0)]
    pub grip: Option<f64>,
    /// What part of its effort limit a joint may use to hold the object, 0.01 to 1; the rest is for motion and correction.
    #[schemars(range(min = 0.01, max = 1.0))]
    pub effort_share: f64,
    /// What part of the joints' velocity limits the motion uses, 0.01 to 1.
    #[schemars(range(min = 0.01, max = 1.0))]
    pub speed: f64,
    /// Time (s) in which the motion starts, and in which it stops, 0 to 10.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub ramp: f64,
    /// Time step of the simulation (s), 1e-5 to 0.005.
    #[schemars(range(min = 1e-5, max = 0.005))]
    pub time_step: f64,
    /// How often a motion that fails is cut to half of what went well and simulated again, 0 to 20.
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

impl Settings for RapierCheckedSettings {
    fn validate(&self) -> Result<(), SettingsError> {
        self.rolling.validate()?;
        check_range("max_distance", self.max_distance, 1e-5, 1.0)?;
        check_range("max_angle", self.max_angle, 1e-4, 3.0)?;
        check_range("max_slip", self.max_slip, 1e-5, 1.0)?;
        check_range("max_gap", self.max_gap, 1e-6, 9e-4)?;
        check_range("stiffness", self.stiffness, 0.1, 1e4)?;
        check_range("linear_stiffness", self.linear_stiffness, 10.0, 1e6)?;
        check_range("damping_time", self.damping_time, 1e-4, 1.0)?;
        self.friction.map_or(Ok(()), |mu| check_range("friction", mu, 0.0, 10.0))?;
        self.mass.map_or(Ok(()), |mass| check_range("mass", mass, 1e-6, 1e6))?;
        self.grip.map_or(Ok(()), |grip| check_range("grip", grip, 0.01, 1e4))?;
        check_range("effort_share", self.effort_share, 0.01, 1.0)?;
        check_range("speed", self.speed, 0.01, 1.0)?;
        check_range("ramp", self.ramp, 0.0, 10.0)?;
        check_range("time_step", self.time_step, 1e-5, 0.005)?;
        check_count("retries", self.retries, 0, 20)
    }
}

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
        }
    }

    pub(super) fn bounds(&self) -> Bounds {
        Bounds { distance: self.max_distance, angle: self.max_angle, slip: self.max_slip, gap: self.max_gap }
    }

    pub(super) fn pace(&self) -> Pace {
        Pace { speed: self.speed, ramp: self.ramp }
    }
}
