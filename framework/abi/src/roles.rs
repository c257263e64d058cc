//! The roles' methods, which guards and meters pass on.

use crate::guard::{Guardable, owned};
use crate::wrapped::passed_on;
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
                Box::new(owned(plugin, object))
            }
        }
    )+};
}
with_roles!(guardable);

passed_on!(ContactModel: [+ Send + Sync] {
    fn cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> as value(Cone::FRICTIONLESS);
    fn spinning_cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_>
        as value(Cone::FRICTIONLESS);
    fn fewest_contacts(&self) -> usize as constant(MAX_FINGERS);
});

passed_on!(StabilityTest: [+ Send + Sync] {
    fn test(&self, grasp: &Grasp<'_>, hint: &mut Hint, context: &mut Context<'_>)
        -> Result<Stability, CallError> as call;
    fn assess(
        &self, grasp: &Grasp<'_>, length: Option<f64>, center_O: Option<Vec3>, context: &mut Context<'_>
    ) -> Result<Assessment, CallError> as call;
    fn liftable(&self, grasp: &Grasp<'_>, enough: usize, context: &mut Context<'_>)
        -> Result<FingerSet, CallError> as call;
    fn stable_without(&self, grasp: &Grasp<'_>, finger: FingerIndex, context: &mut Context<'_>)
        -> Result<bool, CallError> as call;
    fn criterion(&self) -> Criterion as constant(Criterion::default());
    fn uses_efforts(&self) -> bool as constant(false);
});

/// A contact that exists on every surface, for want of a true one.
fn nowhere() -> Contact {
    Contact { facet: 0, p_OC: Vec3::zeros(), n_O: Vec3::z() }
}

passed_on!(SurfaceParam: [+ Send + Sync] {
    fn sample(&self, random: &mut Random) -> Contact as value(nowhere());
    fn geodesic(&self, from: &Contact, to: &Contact, path: &mut SurfacePath, context: &mut Context<'_>)
        -> Result<bool, CallError> as call;
    // So far away that nothing counts as touching.
    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection
        as value(Projection { contact: nowhere(), distance: f64::MAX });
    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact as value(*from);
    fn edge_distance(&self, contact: &Contact) -> f64 as value(0.0);
});

passed_on!(ClosedChainSampler: [+ Send + Sync] {
    fn sample(&self, task: &Task<'_>, pose: PoseRequest<'_>, holding: FingerSet, context: &mut Context<'_>)
        -> Result<Option<Configuration>, CallError> as call;
    fn close(
        &self, task: &Task<'_>, X_HO: &Pose, contacts: &PerFinger<Option<Contact>>, near: &Configuration,
        context: &mut Context<'_>
    ) -> Result<Option<Configuration>, CallError> as call;
});

passed_on!(LocalPlanner: [+ Send + Sync] {
    fn connect(
        &self, task: &Task<'_>, from: &Configuration, to: &Target<'_>, path: Option<&mut Path>,
        context: &mut Context<'_>
    ) -> Result<Reached, CallError> as call;
});

passed_on!(GraphStrategy: [+ Send + Sync] {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> as call;
    fn policy(&self) -> SearchPolicy as value(SearchPolicy::default());
});
