//! The services' methods, which guards and meters pass on; and the guard of a service.
//!
//! A plugin that asks for finger 9 makes the framework panic while the plugin calls it. Were the plugin in a
//! library of its own, the panic could not cross it, and the process would be aborted. So the framework
//! catches it on its own side: the call gets a harmless value, and the panic becomes the thread's fault
//! ([`regrasp_api::report_fault`]).

use crate::guard::Caught;
use crate::wrapped::{Wrapped, passed_on};
use regrasp_api::{
    Admissible, Body, BodyPair, CallError, Clearance, ComponentId, Configuration, Context, EdgeId, EdgeKind,
    EdgeView, FingerIndex, FingerJoints, FingerModel, FingerSet, Fingertip, GraphView, Hand, LoneFinger,
    NodeId, Origin, PairDistance, PastAction, Pose, Reason, Rotation, Task, TipJacobian, TipKinematics,
    TipRule, Vec3,
};

/// A service behind a guard: what a plugin from a library is to be handed.
pub type GuardedService<'a, S> = Wrapped<Caught, &'a S>;

impl<'a, S: ?Sized> GuardedService<'a, S> {
    /// `service` behind a guard; panics name it as `service/NAME`, which `name` is.
    pub fn guarding(name: &'static str, service: &'a S) -> Self {
        Self::new(Caught(name), service)
    }
}

/// What two bodies are said to collide where clearance is not known.
const UNKNOWN: BodyPair = (Body::Palm, Body::Object);

/// A fingertip nobody knows where.
fn nowhere() -> TipKinematics {
    TipKinematics {
        p_HF: Vec3::zeros(),
        R_HF: Rotation::identity(),
        J_v: TipJacobian::zeros(),
        J_w: TipJacobian::zeros(),
    }
}

passed_on!(Hand: [+ Send + Sync] {
    fn finger_count(&self) -> usize as constant(0);
    fn finger(&self, finger: FingerIndex) -> &FingerModel as value(self.object.finger(FingerIndex(0)));
    fn fingertip_radius(&self) -> f64 as constant(0.0);
    fn fingertip(&self) -> Fingertip as constant(Fingertip::default());
    fn tip_center(&self, finger: FingerIndex, joints: &FingerJoints) -> Vec3 as value(Vec3::zeros());
    fn tip_kinematics(&self, finger: FingerIndex, joints: &FingerJoints) -> TipKinematics as value(nowhere());
    fn inverse(&self, finger: FingerIndex, p_HF: &Vec3, near: &FingerJoints) -> Option<FingerJoints>
        as value(None);
    fn settle(&self, finger: FingerIndex, joints: &mut FingerJoints) -> () as value(());
    fn within_limits(&self, finger: FingerIndex, joints: &FingerJoints) -> bool as value(false);
});

/// Never free.
struct Blocked;

impl LoneFinger for Blocked {
    fn free(&self, _: &FingerJoints, _: TipRule) -> Result<(), BodyPair> {
        Err(UNKNOWN)
    }
}

passed_on!(LoneFinger: [] {
    fn free(&self, joints: &FingerJoints, tip: TipRule) -> Result<(), BodyPair> as value(Err(UNKNOWN));
});

passed_on!(Clearance: [+ Send + Sync] {
    fn object_free(&self, X_HO: &Pose) -> Result<(), BodyPair> as value(Err(UNKNOWN));
    fn finger_free(&self, finger: FingerIndex, joints: &FingerJoints, X_HO: &Pose, tip: TipRule)
        -> Result<(), BodyPair> as value(Err(UNKNOWN));
    fn fingers_free(&self, a: (FingerIndex, &FingerJoints), b: (FingerIndex, &FingerJoints))
        -> Result<(), BodyPair> as value(Err(UNKNOWN));
    fn configuration_free(&self, q: &Configuration, moved: FingerSet, object_moved: bool)
        -> Result<(), BodyPair> as value(Err(UNKNOWN));
    fn distances(&self, q: &Configuration, limit: f64) -> Vec<PairDistance> as value(Vec::new());
} {
    fn lone_finger<'a>(
        &'a self,
        finger: FingerIndex,
        resting: &'a Configuration,
        among: FingerSet,
    ) -> Box<dyn LoneFinger + 'a> {
        let lone = || self.around.lone_finger(self.object.lone_finger(finger, resting, among));
        self.around.value(lone, || Box::new(Blocked))
    }
});

passed_on!(Admissible: [+ Send + Sync] {
    fn admit_finger(
        &self, task: &Task<'_>, q: &Configuration, finger: FingerIndex, placed: FingerSet,
        context: &mut Context<'_>
    ) -> Result<Option<Reason>, CallError> as call;
    fn admit_grasp(&self, task: &Task<'_>, q: &Configuration, context: &mut Context<'_>)
        -> Result<Option<Reason>, CallError> as call;
    fn admit(&self, task: &Task<'_>, q: &Configuration, context: &mut Context<'_>)
        -> Result<Option<Reason>, CallError> as call;
});

passed_on!(GraphView: [] {
    fn node_count(&self) -> usize as constant(0);
    fn samples(&self) -> (usize, usize) as constant((0, 0));
    fn start(&self) -> NodeId as constant(NodeId(0));
    fn configuration(&self, node: NodeId) -> &Configuration
        as value(self.object.configuration(self.object.start()));
    fn origin(&self, node: NodeId) -> Origin as value(Origin::Start);
    fn history(&self) -> &[PastAction] as constant(&[]);
    fn goals(&self) -> &[NodeId] as constant(&[]);
    fn component(&self, node: NodeId) -> ComponentId as value(ComponentId(0));
    fn components(&self) -> &[ComponentId] as constant(&[]);
    fn joined(&self) -> bool as constant(false);
    fn distance(&self, a: NodeId, b: NodeId) -> f64 as value(f64::INFINITY);
    fn attempted(&self, a: NodeId, b: NodeId, kind: EdgeKind) -> bool as value(true);
    fn edges(&self) -> &[EdgeView] as constant(&[]);
    fn shortest_path(&self) -> Vec<EdgeId> as value(Vec::new());
});
