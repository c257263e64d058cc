//! Whether any grasp of the hand can carry the object: asked before a search that could only fail.

use crate::{RunError, Setup};
use regrasp_api::{
    Admissible, CallError, Configuration, Context, Criterion, FingerIndex, FingerSet, Hand, Hint, HoldLoad,
    PoseRequest, Reason, Refusal, Task,
};
use regrasp_physics::{HeldLoad, Press};
use regrasp_planner::Leavable;
use std::sync::Mutex;

/// A weight below this part of what the fingers can press with at rest, in any direction, is not looked at.
const LIGHT: f64 = 0.25;
/// Calls of the sampler that look for a grasp that carries the object; each weighs some thousand grasps.
const CALLS: u64 = 3;
/// A grasp that carries this part of the mass leaves the question to the search: others may carry more.
const NEARLY: f64 = 0.8;
/// How much more than the best a grasp must carry to be measured, and to how much its mass is measured.
const BETTER: f64 = 1.1;
/// The smallest part of the object's mass that is looked for.
const LEAST: f64 = 1e-3;

impl Setup<'_> {
    /// Refuses an object that is heavier than what any of many grasps at the start can carry.
    pub(crate) fn refuse_too_heavy(&self) -> Result<(), RunError> {
        let Criterion::Holding(load) = self.plugins.stability.criterion() else { return Ok(()) };
        let task = self.task();
        let weight = task.object.mass * task.g_H.norm();
        if !load.weight || weight <= LIGHT * strength(task.hand) {
            return Ok(());
        }
        let scales = Scales::new(&task, &load);
        let weighing = Task { admissible: &scales, ..task };
        let all = FingerSet::first(task.hand.finger_count());
        for call in 0..CALLS {
            let mut context = Context::seeded(call);
            let request = PoseRequest::At(self.poses[0]);
            let carried = self.plugins.sampler.sample(&weighing, request, all, &mut context);
            if carried.map_err(RunError::Call)?.is_some() {
                return Ok(());
            }
        }
        match scales.best() {
            // Where no grasp was weighed the search will tell why.
            best if best > 0.0 => Err(self.scenario.refuse(&too_heavy(task.object.mass, best)).into()),
            _ => Ok(()),
        }
    }
}

fn too_heavy(mass: f64, best: f64) -> Refusal {
    let fix = "lower `object.mass`, or raise the joints' efforts or the friction";
    let message = format!(
        "`object.mass` = {mass} kg is more than any grasp at the start carries within the joints' efforts; \
         the largest mass found is {best:.3} kg; {fix}"
    );
    Refusal::new("too-heavy", &message)
        .key("object.mass")
        .value(mass)
        .range(format!("..={best:.3} kg"))
        .remedy(fix)
}

/// What the fingertips can press with at rest, whatever the direction, in sum (N).
fn strength(hand: &dyn Hand) -> f64 {
    let one = |finger: FingerIndex| {
        let model = hand.finger(finger);
        let J = hand.tip_kinematics(finger, &model.rest).J_v;
        let joints = model.joints.iter().zip(J.column_iter());
        joints.map(|(joint, column)| joint.effort / column.norm()).fold(f64::INFINITY, f64::min)
    };
    (0..hand.finger_count() as u8).map(FingerIndex).map(one).sum()
}

/// Weighs what each grasp carries that a sampler proposes, and takes the first that carries nearly all.
struct Scales {
    load: HeldLoad,
    mass: f64,
    best: Mutex<f64>,
}

impl Scales {
    fn new(task: &Task<'_>, load: &HoldLoad) -> Self {
        let mass = task.object.mass;
        let load = HeldLoad {
            mass,
            p_OCm: task.object.p_OCm,
            length: task.object.mesh.radius().max(1e-6),
            disturbance: (load.disturbance_force, load.disturbance_torque),
            press: Press { max_normal_force: load.max_normal_force, effort_share: 1.0 },
        };
        Self { load, mass, best: Mutex::new(0.0) }
    }

    fn best(&self) -> f64 {
        *self.best.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    fn note(&self, mass: f64) {
        *self.best.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = mass;
    }

    /// Whether the grasp carries this mass (kg).
    fn carries(&self, task: &Task<'_>, q: &Configuration, mass: f64) -> bool {
        let grasp = task.grasp(q, FingerSet::first(q.contacts.len()));
        let load = HeldLoad { mass, ..self.load };
        match load.bearings(&grasp, None, (1.0, 1.0), |_| 0.0) {
            Some(all) => load.held(&all, &grasp.g_O, 1.0, &mut Hint::default()).holds,
            None => load.held_by_edges(&load.edged(&grasp, None, (1.0, 1.0)), &grasp.g_O, 1.0).holds,
        }
    }

    /// The largest mass that the grasp carries, where that is more than what the best did.
    fn weigh(&self, task: &Task<'_>, q: &Configuration) {
        let best = self.best();
        let first = if best > 0.0 { best * BETTER } else { self.mass * LEAST };
        if !self.carries(task, q, first) {
            return;
        }
        let (mut low, mut high) = (first, self.mass);
        while high > low * BETTER {
            let middle = (low * high).sqrt();
            if self.carries(task, q, middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.note(low);
    }
}

impl Admissible for Scales {
    fn admit_finger(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        Leavable.admit_finger(task, q, finger, placed, context)
    }

    fn admit_grasp(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        context.proceed()?;
        if self.carries(task, q, self.mass * NEARLY) {
            return Ok(None);
        }
        self.weigh(task, q);
        Ok(Some(Reason::Stability))
    }
}
