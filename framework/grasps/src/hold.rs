//! The forces of a grasp, and what the verifier says of both.

use crate::GraspsError;
use crate::grasp::{BulkGrasp, HeldBy};
use regrasp_api::{Configuration, Criterion, FingerSet, PerFinger, Task};
use regrasp_physics::{Friction, Held, SimulationSettings, grasp_forces_at};
use regrasp_plan::{Plan, StateRecord, state_record};
use regrasp_verify::{Check, GraspJudge};

/// The share of the friction (of what may be relied on) that forces take where they can: what perturbations
/// of friction, mass and pose eat up is the rest.
const EASY: f64 = 0.5;

/// How forces are chosen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Holding {
    /// What contacts have; `None` where they share no cone with friction.
    friction: Option<Friction>,
    settings: SimulationSettings,
}

impl Holding {
    /// As the plan file of the grasps claims.
    pub fn new(plan: &Plan) -> Self {
        let cone = plan.claims.contact.cone.filter(|cone| cone.most() > 1e-6 && cone.most() <= 10.0);
        let mut settings = SimulationSettings::default();
        if let Criterion::Holding(load) = &plan.claims.criterion {
            (settings.grip, settings.relied) = (load.max_normal_force, load.friction_factor);
        }
        Self { friction: cone.and_then(|cone| Friction::of(&cone.cone().without_torsion())), settings }
    }

    /// Forces that hold the object's weight within what may be relied on, if there are any.
    pub fn forces(&self, task: &Task<'_>, q: &Configuration) -> Result<Option<Held>, GraspsError> {
        let Some(friction) = self.friction else { return Ok(None) };
        let (parts, relied) = ((task.hand, task.object, task.g_H), self.settings.relied);
        let held = grasp_forces_at(parts, friction, q, (EASY * relied).max(0.01), &self.settings)?;
        Ok(held.filter(|held| held.share <= relied && held.effort_share <= 1.0))
    }
}

/// A grasp before it is judged.
pub(crate) struct Candidate {
    pub q: Configuration,
    pub pose: u64,
    pub liftable: FingerSet,
    pub held: Option<Held>,
}

impl Candidate {
    /// Asks the verifier; a refusal is a fault of the program.
    pub fn judged(self, task: &Task<'_>, judge: &mut GraspJudge<'_>) -> Result<BulkGrasp, Box<Check>> {
        let forces_O = self.held.as_ref().map(|held| forces_O(held, &self.q));
        let rows = forces_O.as_ref().map(|all| all.iter().map(|(_, f)| f.map(Into::into)).collect());
        let record = StateRecord { forces: rows, ..state_record(&self.q, 0.0, task.hand) };
        let figures = judge.judge(&record)?;
        let held = self.held.zip(forces_O).map(|(held, forces_O)| {
            let (friction, effort_share) = figures.forces.unwrap_or((f64::NAN, held.effort_share));
            HeldBy { forces_O, efforts: held.efforts, friction, effort_share }
        });
        Ok(BulkGrasp {
            q: self.q,
            pose: self.pose,
            margin: figures.margin.unwrap_or(f64::NAN),
            clearance: figures.clearance.map_or(f64::INFINITY, |(distance, _)| distance),
            liftable: self.liftable,
            held,
        })
    }
}

fn forces_O(held: &Held, q: &Configuration) -> PerFinger<Option<regrasp_api::Vec3>> {
    let to_O = q.X_HO.rotation.inverse();
    PerFinger::from_fn(q.joints.len(), |finger| held.forces[finger].map(|exerted| to_O * exerted.force))
}
