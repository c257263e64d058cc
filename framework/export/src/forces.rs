//! The forces that hold the object, state by state.
//!
//! S. Boyd, B. Wegbreit, "Fast computation of optimal contact forces", IEEE T-RO 2007; `regrasp-physics`
//! chooses them.

use crate::ExportError;
use regrasp_api::{Configuration, FingerIndex, FingerJoints, Hand, ObjectModel, PerFinger, Vec3};
use regrasp_physics::{
    ContactForce, Friction, Held, SimulationSettings, Stage, creep, dragged_forces, grasp_forces,
};
use regrasp_plan::{Criterion, Motion, Plan, Segment, SegmentKind};

/// The forces of a whole motion, state by state in the order of [`Scene::states`].
pub(crate) struct Forces {
    held: Vec<Option<Held>>,
    /// What motors must exert where contacts drag while they spin, and how far ahead of the plan their joints
    /// must be so that the object is on its way while they creep; empty where contacts carry no torsion.
    driven: Vec<(Option<Held>, PerFinger<FingerJoints>)>,
    /// What there is not, and why.
    missing: Option<String>,
    /// Whether the cones are known well enough for distances from them.
    measured: bool,
    settings: SimulationSettings,
}

impl Forces {
    /// The plan's own forces; where it brings none, or a `grip` is given, those that hold the object against
    /// gravity with the least share of the friction within the joints' efforts. `grip` is the most normal
    /// force of a contact (N), what the plan claims where `None`.
    pub fn new(
        plan: &Plan,
        motion: &Motion,
        (hand, object): (&dyn Hand, &ObjectModel),
        grip: Option<f64>,
    ) -> Result<Self, ExportError> {
        let settings = settings(plan, grip);
        // Another grip than the plan's asks for other forces.
        let stage = |segment| stage(segment, grip.is_none());
        let stages: Vec<Stage<'_>> = motion.segments.iter().map(stage).collect();
        let g_H = Vec3::from(plan.scenario.problem.gravity);
        let Some(cone) = plan.claims.contact.cone else {
            return Self::recorded(plan, &stages, (hand, object, g_H), settings);
        };
        let friction = Friction::of(&cone.cone()).unwrap_or(Friction::point(cone.mu));
        let held = grasp_forces((hand, object, g_H), friction, &stages, &settings)?;
        let mut driven = Vec::new();
        if friction.gamma > 0.0 {
            let dragged = dragged_forces((hand, object, g_H), friction, &stages, &settings)?;
            let ahead = creep(hand, friction, &stages, &dragged);
            driven = dragged.into_iter().flatten().zip(ahead.into_iter().flatten()).collect();
        }
        let held = held.into_iter().flatten().collect();
        Ok(Self { held, driven, missing: None, measured: true, settings })
    }

    /// The forces that the plan records where contacts share no elliptic cone: none are chosen then.
    fn recorded(
        plan: &Plan,
        stages: &[Stage<'_>],
        (hand, object, g_H): (&dyn Hand, &ObjectModel, Vec3),
        settings: SimulationSettings,
    ) -> Result<Self, ExportError> {
        let model = &plan.claims.contact.model;
        let whole = |stage: &Stage<'_>| {
            stage.forces.len() == stage.states.len() && stage.forces.iter().all(Option::is_some)
        };
        let (held, without) = if stages.iter().all(whole) {
            // No cone is wider than that of the object's friction; the efforts do not depend on it.
            let friction = Friction::point(object.friction.max(1e-6));
            let held = grasp_forces((hand, object, g_H), friction, stages, &settings)?;
            (held.into_iter().flatten().collect(), "`force_margin` is left out")
        } else {
            let count = stages.iter().map(|stage| stage.states.len()).sum();
            (vec![None; count], "no grasp forces are exported")
        };
        let missing = Some(format!("`{model}` claims no elliptic friction cone, so {without}"));
        Ok(Self { held, driven: Vec::new(), missing, measured: false, settings })
    }

    /// What a finger exerts on the object in a state (in H); `None` where it does not hold it.
    pub fn force(&self, state: usize, finger: FingerIndex) -> Option<ContactForce> {
        self.held[state].as_ref().and_then(|held| held.forces[finger])
    }

    /// The least distance of a force from its cone (N); not positive where no forces within cones and efforts
    /// hold the object; `None` too where contacts share no elliptic cone.
    pub fn margin(&self, state: usize) -> Option<f64> {
        self.exerted(state).map(|held| held.margin).filter(|_| self.measured)
    }

    /// What the motors exert in a state.
    fn exerted(&self, state: usize) -> Option<&Held> {
        self.driven.get(state).map_or(self.held[state].as_ref(), |(held, _)| held.as_ref())
    }

    /// Where a joint's motor must aim so that its spring exerts the joint's part of the forces: q + τ/k, and
    /// where contacts creep as far ahead.
    pub fn target(
        &self,
        state: usize,
        q: &Configuration,
        finger: FingerIndex,
        joint: usize,
        prismatic: bool,
    ) -> f64 {
        let effort = self.exerted(state).map_or(0.0, |held| held.efforts[finger][joint]);
        let ahead = self.driven.get(state).map_or(0.0, |(_, ahead)| ahead[finger][joint]);
        q.joints[finger][joint] + effort / self.stiffness(prismatic) + ahead
    }

    /// Stiffness of the motors (N·m/rad; N/m where prismatic).
    pub fn stiffness(&self, prismatic: bool) -> f64 {
        if prismatic { self.settings.linear_stiffness } else { self.settings.stiffness }
    }

    /// Damping of the motors (N·m·s/rad; N·s/m where prismatic).
    pub fn damping(&self, prismatic: bool) -> f64 {
        self.stiffness(prismatic) * self.settings.damping_time
    }

    /// What whoever exports should know.
    pub fn notes(&self) -> Vec<String> {
        let outside =
            self.held.iter().filter(|held| held.as_ref().is_none_or(|held| held.share > 1.0)).count();
        match (&self.missing, outside) {
            (Some(missing), _) => vec![missing.clone()],
            (None, 0) => Vec::new(),
            (None, outside) => vec![format!(
                "in {outside} of {} states no forces within the friction cones and the joints' efforts hold \
                 the object's weight; \
                 `force_margin` is not positive there, and the forces are the nearest",
                self.held.len()
            )],
        }
    }
}

/// The bounds of the forces: those that the plan claims to hold by, and the grip that was asked for.
fn settings(plan: &Plan, grip: Option<f64>) -> SimulationSettings {
    let mut settings = SimulationSettings { grip, ..SimulationSettings::default() };
    if let Criterion::Holding(load) = &plan.claims.criterion {
        settings.relied = load.friction_factor;
        settings.grip = grip.or(load.max_normal_force);
    }
    settings
}

/// The segment, with the forces that the plan brings where they are `wanted`.
fn stage(segment: &Segment, wanted: bool) -> Stage<'_> {
    let moving = match segment.kind {
        SegmentKind::Transfer => None,
        SegmentKind::Regrasp(finger) => Some(finger),
    };
    let forces = if wanted { &segment.forces[..] } else { &[] };
    Stage { states: &segment.states, times: &segment.times, moving, forces }
}
