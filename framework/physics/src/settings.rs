//! What a simulation assumes.

use crate::PhysicsError;

/// Motors, contacts and time of a simulation. Every field is public; [`SimulationSettings::validate`] checks
/// the ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulationSettings {
    /// Stiffness of a revolute joint's motor (N·m/rad), in 0.1 to 1e4.
    pub stiffness: f64,
    /// Stiffness of a prismatic joint's motor (N/m), in 10 to 1e6.
    pub linear_stiffness: f64,
    /// Damping of every motor as a time (s): a motor's damping is its stiffness times this, in 1e-4 to 1.
    pub damping_time: f64,
    /// Coefficient of friction between fingertips and object in the simulation; the object's own where
    /// `None`. 0 to 10.
    pub friction: Option<f64>,
    /// Mass of the simulated object (kg), its inertia in proportion; the object's own where `None`. 1e-6 to
    /// 1e6.
    pub mass: Option<f64>,
    /// Time step (s), in 1e-5 to 0.02.
    pub time_step: f64,
    /// Most normal force of one contact (N), in 0.01 to 1e4; where `None`, what the joints can.
    pub grip: Option<f64>,
    /// What part of its effort limit a joint may use for the grasp, in 0.01 to 1.
    pub effort_share: f64,
    /// The share of the friction that forces rely on at most, where they can; 0.01 to 1.
    pub relied: f64,
}

impl Default for SimulationSettings {
    fn default() -> Self {
        Self {
            stiffness: 10.0,
            linear_stiffness: 1000.0,
            damping_time: 5e-3,
            friction: None,
            mass: None,
            time_step: 5e-4,
            grip: None,
            effort_share: 0.8,
            relied: 1.0,
        }
    }
}

impl SimulationSettings {
    /// Refuses the first value outside its range.
    pub fn validate(&self) -> Result<(), PhysicsError> {
        check("stiffness", self.stiffness, 0.1, 1e4)?;
        check("linear_stiffness", self.linear_stiffness, 10.0, 1e6)?;
        check("damping_time", self.damping_time, 1e-4, 1.0)?;
        self.friction.map_or(Ok(()), |mu| check("friction", mu, 0.0, 10.0))?;
        self.mass.map_or(Ok(()), |mass| check("mass", mass, 1e-6, 1e6))?;
        check("time_step", self.time_step, 1e-5, 0.02)?;
        self.grip.map_or(Ok(()), |grip| check("grip", grip, 0.01, 1e4))?;
        check("effort_share", self.effort_share, 0.01, 1.0)?;
        check("relied", self.relied, 0.01, 1.0)
    }
}

pub(crate) fn check(key: &'static str, value: f64, low: f64, high: f64) -> Result<(), PhysicsError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(PhysicsError::Range { key, value, low, high })
}
