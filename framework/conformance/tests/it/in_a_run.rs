//! Plugins that keep every law until the planner has called them for a while are caught in a run, by the law
//! that they break there; the call is kept, and can be made again.
use regrasp_api::*;
use regrasp_conformance::reference::{
    EdgeClosure, FacetSurface, FineRolling, GraspLine, Interleaving, LiftOver, RejectionSampler, RoundCones,
};
use regrasp_conformance::{Demands, Outcome, Trial, audit_in_a_run, replay};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A plugin that is right for its first calls.
struct Tired<T> {
    right: T,
    after: usize,
    calls: AtomicUsize,
}

impl<T> Tired<T> {
    fn new(right: T, after: usize) -> Self {
        Self { right, after, calls: AtomicUsize::new(0) }
    }

    fn is_tired(&self) -> bool {
        self.calls.fetch_add(1, Ordering::Relaxed) >= self.after
    }
}

impl ContactModel for Tired<RoundCones> {
    fn cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        let mu = if self.is_tired() { 2.0 * mu } else { mu };
        self.right.cone(finger, contact, mu)
    }
    fn spinning_cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        self.cone(finger, contact, mu)
    }
    fn fewest_contacts(&self) -> usize {
        self.right.fewest_contacts()
    }
}

impl StabilityTest for Tired<EdgeClosure> {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        if self.is_tired() {
            context.count_call(Slot::StabilityTest);
        }
        self.right.test(grasp, hint, context)
    }
    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        self.right.assess(grasp, length, center_O, context)
    }
}

impl SurfaceParam for Tired<FacetSurface> {
    fn sample(&self, random: &mut Random) -> Contact {
        self.right.sample(random)
    }
    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        self.right.geodesic(from, to, path, context)
    }
    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        let mut found = self.right.project(p_OF, hint);
        found.distance += if self.is_tired() { 1e-6 } else { 0.0 };
        found
    }
    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.right.walk(from, direction_O, distance)
    }
    fn edge_distance(&self, contact: &Contact) -> f64 {
        self.right.edge_distance(contact)
    }
}

impl ClosedChainSampler for Tired<RejectionSampler> {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        let mut found = self.right.sample(task, pose, holding, context)?;
        if self.is_tired() {
            found.iter_mut().for_each(|q| q.X_HO.translation.vector.x += 1e-3);
        }
        Ok(found)
    }
    fn close(
        &self,
        task: &Task<'_>,
        X_HO: &Pose,
        contacts: &PerFinger<Option<Contact>>,
        near: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        self.right.close(task, X_HO, contacts, near, context)
    }
}

impl<T: LocalPlanner> LocalPlanner for Tired<T> {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let mut reached = self.right.connect(task, from, to, path, context)?;
        if self.is_tired() {
            reached.fraction = 0.5;
        }
        Ok(reached)
    }
}

impl GraphStrategy for Tired<Interleaving> {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        let action = self.right.next(graph, context)?;
        let beyond = NodeId(graph.node_count() as u32);
        let tired = self.is_tired();
        Ok(if tired { Action::ConnectAll(beyond, EdgeKind::Grasp) } else { action })
    }
}

/// A plugin of this kind that is right for so many calls.
macro_rules! tired {
    ($role:ident, $slot:ident, $after:expr, $right:expr) => {
        Entry {
            id: "a-role/tired",
            slots: &[Slot::$slot],
            summary: "is right for its first calls",
            references: &["nobody"],
            schema: NoSettings::schema,
            check: check_settings::<NoSettings>,
            build: Build::$role(|json, parts| {
                NoSettings::from_json(json)?;
                let right = $right(parts);
                Ok(Box::new(Tired::new(right, $after)))
            }),
        }
    };
}

/// Every slot's plugin, right for so many calls.
macro_rules! every_slot {
    ($after:expr) => {
        [
            (tired!(ContactModel, ContactModel, 40 * $after, |_| RoundCones), "cone-within-friction|pure"),
            (tired!(StabilityTest, StabilityTest, 10 * $after, |_| EdgeClosure), "counted|pure"),
            (
                tired!(Surface, Surface, 100 * $after, |parts: &Parts<'_>| {
                    FacetSurface::new(&parts.object.mesh, parts.hand.fingertip_radius())
                }),
                "project-closest|project-hint",
            ),
            (tired!(Sampler, Sampler, $after, |_| RejectionSampler), "closed|sample-pose|pure"),
            (tired!(LocalPlanner, GraspPlanner, $after, |_| GraspLine), "reached|fraction|pure"),
            (tired!(LocalPlanner, TransferPlanner, $after, |_| FineRolling), "reached|fraction|pure"),
            (tired!(LocalPlanner, RegraspPlanner, $after, |_| LiftOver), "reached|fraction|pure"),
            (tired!(GraphStrategy, GraphStrategy, $after, |_| Interleaving), "strategy-sensible|pure"),
        ]
    };
}

fn trial(entry: &Entry) -> Trial {
    audit_in_a_run(entry, &Demands::default()).remove(0)
}

#[test]
fn what_breaks_in_a_run_alone_is_caught_there_and_kept() {
    for (entry, laws) in every_slot!(4) {
        let slot = entry.slots[0];
        let trial = trial(&entry);
        let Outcome::Failed(reason) = &trial.outcome else { panic!("{}: {trial:?}", slot.name()) };
        let case = trial.case.as_ref().unwrap_or_else(|| panic!("{}: {reason}", slot.name()));
        let law = case["breach"]["law"].as_str().unwrap();
        assert!(laws.split('|').any(|expected| expected == law), "{}: {reason}", slot.name());
        assert!(reason.contains("a-role/tired"), "{reason}");
        if slot != Slot::GraphStrategy {
            // Made once the plugin is not tired, the same call keeps the law.
            assert_eq!(replay(&entry, &case.to_string()), Ok(None), "{}", slot.name());
        }
    }
}

#[test]
fn a_kept_call_is_made_again_by_a_plugin_that_is_still_wrong() {
    let entry = tired!(ContactModel, ContactModel, 0, |_| RoundCones);
    let case = trial(&entry).case.unwrap();
    let breach = replay(&entry, &case.to_string()).unwrap().unwrap();
    assert_eq!(breach.broken.law, case["breach"]["law"].as_str().unwrap());
}

#[test]
fn the_references_keep_the_laws_in_a_run_and_every_slot_is_asked() {
    for (entry, _) in every_slot!(usize::MAX / 1000) {
        let trial = trial(&entry);
        assert_eq!(trial.outcome, Outcome::Passed, "{}: {trial:?}", trial.slot.name());
        assert!(trial.looks > 0 && trial.case.is_none(), "{trial:?}");
    }
}
