//! What holds the object in grasps: forces, efforts, and how much more they would carry.

use regrasp::api::{CallError, Configuration, FingerIndex, ObjectModel, Task};
use regrasp::physics::{Friction, Held, SimulationSettings, grasp_forces_at};

/// The mass that is told is at most this much below the largest one.
const NEAR: f64 = 1.01;
/// The smallest and the largest mass that are looked for (kg).
const MASSES: (f64, f64) = (1e-6, 1e3);

/// Columns of numbers, a row a grasp; NaN where no forces hold the object.
#[derive(Default)]
pub struct Columns {
    /// For each finger the force on the object in O (N); NaN where it does not hold.
    pub forces: Vec<f64>,
    /// For each joint what it gives (N·m; N).
    pub efforts: Vec<f64>,
    /// The largest share of the friction that a force relies on.
    pub friction: Vec<f64>,
    /// The largest share of its effort limit that a joint gives.
    pub effort: Vec<f64>,
    /// The largest mass (kg) that the grasp carries; 0 where it carries none.
    pub mass: Vec<f64>,
}

/// Asks what holds the object in some grasps at rest.
pub struct Asker<'a> {
    task: Task<'a>,
    settings: SimulationSettings,
    /// The object, of another mass each time.
    other: ObjectModel,
}

impl<'a> Asker<'a> {
    /// Of a task, with all of the friction and of the efforts.
    pub fn new(task: Task<'a>) -> Self {
        let settings =
            SimulationSettings { grip: None, effort_share: 1.0, relied: 1.0, ..Default::default() };
        Self { other: task.object.clone(), task, settings }
    }

    /// Adds a grasp's row: forces that need at most `share` of the friction, or else the least.
    pub fn add(&mut self, q: &Configuration, share: f64, columns: &mut Columns) -> Result<(), CallError> {
        let friction = self.friction(q)?;
        let held = self.held(q, friction, share, self.task.object)?;
        let R_OH = q.X_HO.rotation.inverse();
        for finger in (0..q.joints.len() as u8).map(FingerIndex) {
            let count = self.task.hand.finger(finger).joints.len();
            match &held {
                Some(held) => columns.efforts.extend(held.efforts[finger].iter()),
                None => columns.efforts.extend([f64::NAN].repeat(count)),
            }
            let force = held.as_ref().and_then(|held| held.forces[finger]);
            let f_O = force.map_or([f64::NAN; 3], |force| (R_OH * force.force).into());
            columns.forces.extend(f_O);
        }
        columns.friction.push(held.as_ref().map_or(f64::NAN, |held| held.share));
        columns.effort.push(held.as_ref().map_or(f64::NAN, |held| held.effort_share));
        let mass = self.largest_mass(q, friction)?;
        columns.mass.push(mass);
        Ok(())
    }

    /// The friction of all contacts; an error where they have no elliptic cone, or not one and the same.
    fn friction(&self, q: &Configuration) -> Result<Friction, CallError> {
        let grasp = self.task.grasp_with_friction(q, q.holding(), self.task.object.friction);
        let mut all = grasp.contacts().iter().map(|contact| Friction::of(&contact.cone));
        let first = all.next().flatten();
        first.filter(|first| all.all(|other| other.as_ref() == Some(first))).ok_or_else(|| {
            CallError::Unsupported {
                plugin: "what a grasp holds".into(),
                reason: "it takes one elliptic cone for all contacts; use such a contact model, and \
                         configurations whose fingers touch"
                    .into(),
            }
        })
    }

    fn held(
        &self,
        q: &Configuration,
        friction: Friction,
        share: f64,
        object: &ObjectModel,
    ) -> Result<Option<Held>, CallError> {
        let parts = (self.task.hand, object, self.task.g_H);
        grasp_forces_at(parts, friction, q, share, &self.settings).map_err(|error| CallError::Unsupported {
            plugin: "what a grasp holds".into(),
            reason: error.to_string(),
        })
    }

    /// By bisection: what carries a mass carries a smaller one, since no force at all carries none.
    fn largest_mass(&mut self, q: &Configuration, friction: Friction) -> Result<f64, CallError> {
        let (mut low, mut high) = MASSES;
        if !self.carries(q, friction, low)? {
            return Ok(0.0);
        }
        while high > low * NEAR {
            let middle = (low * high).sqrt();
            if self.carries(q, friction, middle)? {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(low)
    }

    fn carries(&mut self, q: &Configuration, friction: Friction, mass: f64) -> Result<bool, CallError> {
        self.other.mass = mass;
        let held = self.held(q, friction, 1.0, &self.other)?;
        Ok(held.is_some_and(|held| held.share <= 1.0 && held.effort_share <= 1.0))
    }
}
