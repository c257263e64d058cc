//! The guard of each role.

use crate::guard::{Guard, Guardable};
use regrasp_api::{
    Action, Assessment, CallError, ClosedChainSampler, Cone, Configuration, Contact, ContactModel, Context,
    Criterion, FingerIndex, FingerSet, GraphStrategy, GraphView, Grasp, Hint, LocalPlanner, MAX_FINGERS,
    Path, PerFinger, Pose, PoseRequest, Projection, Random, Reached, SearchPolicy, Stability, StabilityTest,
    SurfaceParam, SurfacePath, Target, Task, Vec3, with_roles,
};

macro_rules! guardable {
    ($([$variant:ident $name:ident $role:ident] $row:tt)+) => {$(
        impl Guardable for dyn $role {
            fn guarded(object: Box<Self>, plugin: &'static str) -> Box<Self> {
                Box::new(Guard::new(plugin, object))
            }
        }
    )+};
}
with_roles!(guardable);

impl ContactModel for Guard<dyn ContactModel> {
    fn cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        self.value(|model| model.cone(finger, contact, mu), || Cone::FRICTIONLESS)
    }

    fn spinning_cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        self.value(|model| model.spinning_cone(finger, contact, mu), || Cone::FRICTIONLESS)
    }

    fn fewest_contacts(&self) -> usize {
        self.value(|model| model.fewest_contacts(), || MAX_FINGERS)
    }
}

impl StabilityTest for Guard<dyn StabilityTest> {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        self.call(|test| test.test(grasp, hint, context))
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        self.call(|test| test.assess(grasp, length, center_O, context))
    }

    fn liftable(
        &self,
        grasp: &Grasp<'_>,
        enough: usize,
        context: &mut Context<'_>,
    ) -> Result<FingerSet, CallError> {
        self.call(|test| test.liftable(grasp, enough, context))
    }

    fn stable_without(
        &self,
        grasp: &Grasp<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        self.call(|test| test.stable_without(grasp, finger, context))
    }

    fn criterion(&self) -> Criterion {
        self.value(|test| test.criterion(), Criterion::default)
    }

    fn uses_efforts(&self) -> bool {
        self.value(|test| test.uses_efforts(), || false)
    }
}

/// A contact that exists on every surface, for want of a true one.
fn nowhere() -> Contact {
    Contact { facet: 0, p_OC: Vec3::zeros(), n_O: Vec3::z() }
}

impl SurfaceParam for Guard<dyn SurfaceParam> {
    fn sample(&self, random: &mut Random) -> Contact {
        self.value(|surface| surface.sample(random), nowhere)
    }

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        self.call(|surface| surface.geodesic(from, to, path, context))
    }

    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        // So far away that nothing counts as touching.
        let far = || Projection { contact: nowhere(), distance: f64::MAX };
        self.value(|surface| surface.project(p_OF, hint), far)
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.value(|surface| surface.walk(from, direction_O, distance), || *from)
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        self.value(|surface| surface.edge_distance(contact), || 0.0)
    }
}

impl ClosedChainSampler for Guard<dyn ClosedChainSampler> {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        self.call(|sampler| sampler.sample(task, pose, holding, context))
    }

    fn close(
        &self,
        task: &Task<'_>,
        X_HO: &Pose,
        contacts: &PerFinger<Option<Contact>>,
        near: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        self.call(|sampler| sampler.close(task, X_HO, contacts, near, context))
    }
}

impl LocalPlanner for Guard<dyn LocalPlanner> {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        self.call(|planner| planner.connect(task, from, to, path, context))
    }
}

impl GraphStrategy for Guard<dyn GraphStrategy> {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        self.call(|strategy| strategy.next(graph, context))
    }

    fn policy(&self) -> SearchPolicy {
        self.value(|strategy| strategy.policy(), SearchPolicy::default)
    }
}
