//! The roles behind the meter.

use super::Timed;
use regrasp_api::{
    Action, Assessment, CallError, ClosedChainSampler, Cone, Configuration, Contact, ContactModel, Context,
    Criterion, FingerIndex, FingerSet, GraphStrategy, GraphView, Grasp, Hint, LocalPlanner, Path, PerFinger,
    Pose, PoseRequest, Projection, Random, Reached, SearchPolicy, Stability, StabilityTest, SurfaceParam,
    SurfacePath, Target, Task, Vec3,
};

impl ContactModel for Timed<'_, dyn ContactModel + '_> {
    fn cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        self.leaf(|model| model.cone(finger, contact, mu))
    }

    fn spinning_cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        self.leaf(|model| model.spinning_cone(finger, contact, mu))
    }

    fn fewest_contacts(&self) -> usize {
        self.inner.fewest_contacts()
    }
}

impl StabilityTest for Timed<'_, dyn StabilityTest + '_> {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        self.leaf(|test| test.test(grasp, hint, context))
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        self.leaf(|test| test.assess(grasp, length, center_O, context))
    }

    fn liftable(
        &self,
        grasp: &Grasp<'_>,
        enough: usize,
        context: &mut Context<'_>,
    ) -> Result<FingerSet, CallError> {
        self.leaf(|test| test.liftable(grasp, enough, context))
    }

    fn criterion(&self) -> Criterion {
        self.inner.criterion()
    }

    fn uses_efforts(&self) -> bool {
        self.inner.uses_efforts()
    }

    fn stable_without(
        &self,
        grasp: &Grasp<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        self.leaf(|test| test.stable_without(grasp, finger, context))
    }
}

impl SurfaceParam for Timed<'_, dyn SurfaceParam + '_> {
    fn sample(&self, random: &mut Random) -> Contact {
        self.leaf(|surface| surface.sample(random))
    }

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        self.leaf(|surface| surface.geodesic(from, to, path, context))
    }

    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        self.leaf(|surface| surface.project(p_OF, hint))
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.leaf(|surface| surface.walk(from, direction_O, distance))
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        self.leaf(|surface| surface.edge_distance(contact))
    }
}

impl ClosedChainSampler for Timed<'_, dyn ClosedChainSampler + '_> {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        self.outer(|sampler| sampler.sample(task, pose, holding, context))
    }

    fn close(
        &self,
        task: &Task<'_>,
        X_HO: &Pose,
        contacts: &PerFinger<Option<Contact>>,
        near: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        self.outer(|sampler| sampler.close(task, X_HO, contacts, near, context))
    }
}

impl LocalPlanner for Timed<'_, dyn LocalPlanner + '_> {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        self.outer(|planner| planner.connect(task, from, to, path, context))
    }
}

impl GraphStrategy for Timed<'_, dyn GraphStrategy + '_> {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        self.outer(|strategy| strategy.next(graph, context))
    }

    fn policy(&self) -> SearchPolicy {
        self.outer(|strategy| strategy.policy())
    }
}
