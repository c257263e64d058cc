//! The guard of the services: what plugins may ask of the framework.
//!
//! A plugin that asks for finger 9 makes the framework panic while the plugin calls it. Were the plugin in a
//! library of its own, the panic could not cross it, and the process would be aborted. So the framework
//! catches it on its own side: the call gets a harmless value, and the panic becomes the thread's fault
//! ([`regrasp_api::report_fault`]).

use crate::guard::{Guard, caught};
use regrasp_api::{
    Admissible, Body, BodyPair, CallError, Clearance, ComponentId, Configuration, Context, EdgeId, EdgeKind,
    EdgeView, FingerIndex, FingerJoints, FingerModel, FingerSet, Fingertip, GraphView, Hand, LoneFinger,
    NodeId, Origin, PairDistance, PastAction, Pose, Reason, Rotation, Task, TipJacobian, TipKinematics,
    TipRule, Vec3,
};

/// A service behind a guard: what a plugin from a library is to be handed.
#[derive(Clone, Copy)]
pub struct GuardedService<'a, S: ?Sized>(pub &'a S);

/// What two bodies are said to collide where clearance is not known.
const UNKNOWN: BodyPair = (Body::Palm, Body::Object);

fn served<R>(service: &str, call: impl FnOnce() -> R, harmless: impl FnOnce() -> R) -> R {
    caught(service, call).unwrap_or_else(|fault| {
        regrasp_api::report_fault(fault);
        harmless()
    })
}

impl Hand for GuardedService<'_, dyn Hand + '_> {
    fn finger_count(&self) -> usize {
        self.0.finger_count()
    }

    fn finger(&self, finger: FingerIndex) -> &FingerModel {
        served("service/hand", || self.0.finger(finger), || self.0.finger(FingerIndex(0)))
    }

    fn fingertip_radius(&self) -> f64 {
        self.0.fingertip_radius()
    }

    fn fingertip(&self) -> Fingertip {
        self.0.fingertip()
    }

    fn tip_center(&self, finger: FingerIndex, joints: &FingerJoints) -> Vec3 {
        served("service/hand", || self.0.tip_center(finger, joints), Vec3::zeros)
    }

    fn tip_kinematics(&self, finger: FingerIndex, joints: &FingerJoints) -> TipKinematics {
        let nowhere = || TipKinematics {
            p_HF: Vec3::zeros(),
            R_HF: Rotation::identity(),
            J_v: TipJacobian::zeros(),
            J_w: TipJacobian::zeros(),
        };
        served("service/hand", || self.0.tip_kinematics(finger, joints), nowhere)
    }

    fn inverse(&self, finger: FingerIndex, p_HF: &Vec3, near: &FingerJoints) -> Option<FingerJoints> {
        served("service/hand", || self.0.inverse(finger, p_HF, near), || None)
    }

    fn settle(&self, finger: FingerIndex, joints: &mut FingerJoints) {
        served("service/hand", || self.0.settle(finger, joints), || ())
    }

    fn within_limits(&self, finger: FingerIndex, joints: &FingerJoints) -> bool {
        served("service/hand", || self.0.within_limits(finger, joints), || false)
    }
}

/// Never free.
struct Blocked;

impl LoneFinger for Blocked {
    fn free(&self, _: &FingerJoints, _: TipRule) -> Result<(), BodyPair> {
        Err(UNKNOWN)
    }
}

/// A plugin owns the object that it is handed: its end, too, runs inside the plugin's library.
impl LoneFinger for Guard<dyn LoneFinger + '_> {
    fn free(&self, joints: &FingerJoints, tip: TipRule) -> Result<(), BodyPair> {
        self.value(|finger| finger.free(joints, tip), || Err(UNKNOWN))
    }
}

impl Clearance for GuardedService<'_, dyn Clearance + '_> {
    fn object_free(&self, X_HO: &Pose) -> Result<(), BodyPair> {
        served("service/clearance", || self.0.object_free(X_HO), || Err(UNKNOWN))
    }

    fn finger_free(
        &self,
        finger: FingerIndex,
        joints: &FingerJoints,
        X_HO: &Pose,
        tip: TipRule,
    ) -> Result<(), BodyPair> {
        served("service/clearance", || self.0.finger_free(finger, joints, X_HO, tip), || Err(UNKNOWN))
    }

    fn fingers_free(
        &self,
        a: (FingerIndex, &FingerJoints),
        b: (FingerIndex, &FingerJoints),
    ) -> Result<(), BodyPair> {
        served("service/clearance", || self.0.fingers_free(a, b), || Err(UNKNOWN))
    }

    fn configuration_free(
        &self,
        q: &Configuration,
        moved: FingerSet,
        object_moved: bool,
    ) -> Result<(), BodyPair> {
        served("service/clearance", || self.0.configuration_free(q, moved, object_moved), || Err(UNKNOWN))
    }

    fn lone_finger<'a>(
        &'a self,
        finger: FingerIndex,
        resting: &'a Configuration,
        among: FingerSet,
    ) -> Box<dyn LoneFinger + 'a> {
        let lone = || -> Box<dyn LoneFinger + 'a> {
            Box::new(Guard::new("service/clearance", self.0.lone_finger(finger, resting, among)))
        };
        served("service/clearance", lone, || Box::new(Blocked))
    }

    fn distances(&self, q: &Configuration, limit: f64) -> Vec<PairDistance> {
        served("service/clearance", || self.0.distances(q, limit), Vec::new)
    }
}

impl Admissible for GuardedService<'_, dyn Admissible + '_> {
    fn admit_finger(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        caught("service/admissible", || self.0.admit_finger(task, q, finger, placed, context))?
    }

    fn admit_grasp(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        caught("service/admissible", || self.0.admit_grasp(task, q, context))?
    }

    fn admit(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        caught("service/admissible", || self.0.admit(task, q, context))?
    }
}

impl GraphView for GuardedService<'_, dyn GraphView + '_> {
    fn node_count(&self) -> usize {
        self.0.node_count()
    }

    fn samples(&self) -> (usize, usize) {
        self.0.samples()
    }

    fn start(&self) -> NodeId {
        self.0.start()
    }

    fn configuration(&self, node: NodeId) -> &Configuration {
        served("service/graph", || self.0.configuration(node), || self.0.configuration(self.0.start()))
    }

    fn origin(&self, node: NodeId) -> Origin {
        served("service/graph", || self.0.origin(node), || Origin::Start)
    }

    fn history(&self) -> &[PastAction] {
        self.0.history()
    }

    fn goals(&self) -> &[NodeId] {
        self.0.goals()
    }

    fn component(&self, node: NodeId) -> ComponentId {
        served("service/graph", || self.0.component(node), || ComponentId(0))
    }

    fn components(&self) -> &[ComponentId] {
        self.0.components()
    }

    fn joined(&self) -> bool {
        self.0.joined()
    }

    fn distance(&self, a: NodeId, b: NodeId) -> f64 {
        served("service/graph", || self.0.distance(a, b), || f64::INFINITY)
    }

    fn attempted(&self, a: NodeId, b: NodeId, kind: EdgeKind) -> bool {
        served("service/graph", || self.0.attempted(a, b, kind), || true)
    }

    fn edges(&self) -> &[EdgeView] {
        self.0.edges()
    }

    fn shortest_path(&self) -> Vec<EdgeId> {
        self.0.shortest_path()
    }
}
