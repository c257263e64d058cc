//! The forces that hold the object, written into a plan's states.

use crate::Setup;
use regrasp_api::{Criterion, Problem, Rotation, Vec3};
use regrasp_physics::{Friction, Held, SimulationSettings, Stage, grasp_forces};
use regrasp_plan::{Claims, Motion, SegmentKind, SegmentRecord};

impl Setup<'_> {
    /// Writes into each state the forces that hold the object there, without torques about the contacts'
    /// normals; leaves out states that only such torques, or no forces at all, could hold.
    pub(crate) fn write_forces(
        &self,
        problem: &Problem,
        claims: &Claims,
        motion: &Motion,
        records: &mut [SegmentRecord],
    ) {
        let Some(cone) = claims.contact.cone.filter(|cone| cone.most() > 1e-6 && cone.most() <= 10.0) else {
            return;
        };
        let Some(friction) = Friction::of(&cone.cone().without_torsion()) else { return };
        let stages: Vec<Stage<'_>> = motion
            .segments
            .iter()
            .map(|segment| {
                let moving = match segment.kind {
                    SegmentKind::Transfer => None,
                    SegmentKind::Regrasp(finger) => Some(finger),
                };
                Stage { states: &segment.states, times: &segment.times, moving, forces: &[] }
            })
            .collect();
        let parts = (self.hand(), &self.scenario.object, Vec3::from(problem.gravity));
        let settings = settings(claims);
        // The friction is within its range, and so are the settings.
        let Ok(held) = grasp_forces(parts, friction, &stages, &settings) else { return };
        for ((record, segment), held) in records.iter_mut().zip(&motion.segments).zip(&held) {
            for ((state, q), held) in record.states.iter_mut().zip(&segment.states).zip(held) {
                // Soft fingers may hold by torques instead, which a plan does not record.
                let enough = |held: &&Held| cone.gamma == 0.0 || held.share <= settings.relied;
                let held = held.as_ref().filter(enough);
                state.forces = held.map(|held| forces_O(held, &q.X_HO.rotation));
            }
        }
    }
}

/// The bounds that the plan's claim gives; the default ones where it claims none.
fn settings(claims: &Claims) -> SimulationSettings {
    let mut settings = SimulationSettings::default();
    if let Criterion::Holding(load) = &claims.criterion {
        settings.grip = load.max_normal_force;
        settings.relied = load.friction_factor;
    }
    settings
}

/// Each finger's force on the object, in O (N).
fn forces_O(held: &Held, R_HO: &Rotation) -> Vec<Option<[f64; 3]>> {
    held.forces.iter().map(|(_, exerted)| exerted.map(|e| (R_HO.inverse() * e.force).into())).collect()
}
