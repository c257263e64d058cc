//! The forces that hold the object, written into a plan's states.

use crate::Setup;
use regrasp_api::{Cone, Criterion, Problem, Rotation, Vec3};
use regrasp_physics::{
    EdgeForces, Friction, Held, SimulationSettings, Stage, StageCones, edge_forces, grasp_forces,
};
use regrasp_plan::{Claims, ConeRecord, Motion, Segment, SegmentKind, SegmentRecord};

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
        let stages = stages(motion);
        let parts = (self.hand(), &self.scenario.object, Vec3::from(problem.gravity));
        let settings = settings(claims);
        if claims.contact.cone.is_none() {
            let Some(cones) = cones(claims, records) else { return };
            let Ok(found) = edge_forces(parts, &stages, &cones, &settings) else { return };
            return write_edge_forces(records, found, claims, settings.relied);
        }
        let Some(cone) = claims.contact.cone.filter(|cone| cone.most() > 1e-6 && cone.most() <= 10.0) else {
            return;
        };
        let Some(friction) = Friction::of(&cone.cone().without_torsion()) else { return };
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

fn stages<'m>(motion: &'m Motion) -> Vec<Stage<'m>> {
    let stage = |segment: &'m Segment| {
        let moving = match segment.kind {
            SegmentKind::Transfer => None,
            SegmentKind::Regrasp(finger) => Some(finger),
        };
        Stage { states: &segment.states, times: &segment.times, moving, forces: &[] }
    };
    motion.segments.iter().map(stage).collect()
}

/// The recorded cones of each state; `None` where some contact has no friction in some direction of an
/// ellipse, of which the verifier takes no forces.
fn cones(claims: &Claims, records: &[SegmentRecord]) -> Option<Vec<StageCones>> {
    let cones = &claims.contact.cones;
    let slides = |cone: &ConeRecord| matches!(cone, ConeRecord::Elliptic(cone) if cone.least() <= 0.0);
    if cones.is_empty() || cones.iter().any(slides) {
        return None;
    }
    let cones: Vec<Cone<'static>> = cones.iter().map(ConeRecord::cone).collect();
    let of_state = |numbers: &Vec<Option<usize>>| {
        let of = |number: Option<usize>| cones.get(number?).cloned();
        numbers.iter().map(|number| of(*number)).collect()
    };
    let of_segment = |record: &SegmentRecord| -> Option<StageCones> {
        record.states.iter().map(|state| state.cones.as_ref().map(of_state)).collect()
    };
    records.iter().map(of_segment).collect()
}

/// As with elliptic cones: contacts with torsion may hold by that instead.
fn write_edge_forces(
    records: &mut [SegmentRecord],
    found: Vec<Vec<Option<EdgeForces>>>,
    claims: &Claims,
    relied: f64,
) {
    let twists = claims.contact.cones.iter().any(|cone| cone.cone().carries_torsion());
    for (record, found) in records.iter_mut().zip(found) {
        for (state, found) in record.states.iter_mut().zip(found) {
            let found = found.filter(|found| !twists || found.share <= relied);
            state.forces = found.map(|found| found.forces.iter().map(|(_, f)| f.map(Into::into)).collect());
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
