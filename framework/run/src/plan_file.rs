//! The plan file of an outcome.

use crate::cones::Cones;
use crate::{RunError, Setup};
use regrasp_api::{
    Configuration, Criterion, FrictionFactor, HoldLoad, ObjectModel, PerFinger, Pose, Problem, Random, Twin,
    mesh_digest,
};
use regrasp_plan::{
    Claims, ContactClaim, ContactSurface, Facets, Format, MarginFrame, Motion, ObjectRecord, Plan,
    PluginChoice, ResolvedScenario, Segment, SegmentKind, StoppedBy, TransferLaw, VERSION,
};
use regrasp_planner::Outcome;
use serde_json::Value;

/// Contacts of each finger that are looked at to tell whether all have one cone.
const PROBES: usize = 64;

impl Setup<'_> {
    /// The plan file of an outcome of this problem, which is the scenario's up to the share of the friction
    /// that it was planned with; without a certificate; without segments where no goal was reached.
    pub fn plan_file(
        &self,
        problem: &Problem,
        outcome: &Outcome,
        seed: u64,
        stopped_by: Option<StoppedBy>,
    ) -> Result<Plan, RunError> {
        let cones =
            Cones::of(&outcome.motion, self.plugins.contact_model.as_ref(), self.scenario.object.friction);
        let mut segments = regrasp_plan::records(&outcome.motion, self.hand())?;
        let mut claims = self.claims(problem, &cones);
        claims.contact.cones = cones.record(&mut segments);
        self.write_forces(problem, &claims, &outcome.motion, &mut segments);
        Ok(Plan {
            notes: regrasp_plan::plugin_notes(&outcome.tally),
            goals_reached: outcome.goal_ends.clone(),
            stopped_by,
            statistics: outcome.statistics.clone(),
            segments,
            ..self.without_motion(problem, claims, seed)
        })
    }

    /// The plan file of this problem without any motion: what the verifier judges grasps by.
    ///
    /// Whether all contacts share an elliptic cone is found out by asking the contact model about some.
    pub fn grasp_file(&self, seed: u64) -> Result<Plan, RunError> {
        let problem = &self.scenario.problem;
        let cones =
            Cones::of(&self.probes(), self.plugins.contact_model.as_ref(), self.scenario.object.friction);
        Ok(self.without_motion(problem, self.claims(problem, &cones), seed))
    }

    fn without_motion(&self, problem: &Problem, claims: Claims, seed: u64) -> Plan {
        Plan {
            format: Format::RegraspPlan,
            version: VERSION,
            scenario: self.resolved_scenario(problem),
            seed,
            versions: [("regrasp".to_owned(), env!("CARGO_PKG_VERSION").to_owned())].into(),
            object: self.object_record(),
            notes: Default::default(),
            claims,
            goals_reached: Vec::new(),
            stopped_by: None,
            statistics: Default::default(),
            certificate: None,
            segments: Vec::new(),
        }
    }

    /// Contacts of all fingers all over the object.
    fn probes(&self) -> Motion {
        let (count, mut random) = (self.hand().finger_count(), Random::from_key(0, 0, 0, 0));
        let probe = |_| Configuration {
            X_HO: Pose::identity(),
            joints: PerFinger::from_fn(count, |finger| self.hand().finger(finger).rest),
            contacts: PerFinger::from_fn(count, |_| Some(self.plugins.surface.sample(&mut random))),
        };
        let states = (0..PROBES).map(probe).collect();
        Motion { segments: vec![Segment::new(SegmentKind::Transfer, states)] }
    }

    /// The facets of a primitive, a mesh standing in the scenario; and the surface that contacts live on,
    /// where that is not the object's own.
    fn object_record(&self) -> Option<ObjectRecord> {
        let object = &self.scenario.object;
        let surface = object.primitive.map(|_| Facets::from(&object.mesh));
        let contact_surface = object.twin.as_ref().map(|twin| contact_surface(object, twin));
        (surface.is_some() || contact_surface.is_some()).then_some(ObjectRecord { surface, contact_surface })
    }

    pub(super) fn resolved_scenario(&self, problem: &Problem) -> ResolvedScenario {
        let plugin = |choice: &regrasp_host::Choice| PluginChoice {
            id: choice.id.clone(),
            settings: Value::Object(choice.settings.clone()),
        };
        ResolvedScenario {
            name: self.scenario.name.clone(),
            problem: problem.clone(),
            plugins: self.choices().iter().map(|(slot, choice)| (slot, plugin(choice))).collect(),
        }
    }

    /// What the plan claims, but for the cones of contacts that share none.
    fn claims(&self, problem: &Problem, cones: &Cones) -> Claims {
        let model = self.choices().choice(regrasp_api::Slot::ContactModel).id.clone();
        Claims {
            contact: ContactClaim { model, cone: cones.shared(), cones: Vec::new() },
            criterion: criterion(self.plugins.stability.criterion(), problem),
            transfer_law: TransferLaw::of_fingertips(self.hand().fingertip()),
            margin: MarginFrame::of_object(&self.scenario.object),
        }
    }
}

/// The test's criterion, with the share of the friction that was planned with.
fn criterion(of_test: Criterion, problem: &Problem) -> Criterion {
    match (of_test, problem.hold.map(|hold| hold.friction_factor)) {
        (Criterion::Holding(load), Some(FrictionFactor::Share(friction_factor))) => {
            Criterion::Holding(HoldLoad { friction_factor, ..load })
        }
        (criterion, _) => criterion,
    }
}

fn contact_surface(object: &ObjectModel, twin: &Twin) -> ContactSurface {
    ContactSurface {
        vertices: twin.mesh.vertices().iter().map(|&v| v.into()).collect(),
        facets: twin.mesh.facets().to_vec(),
        digest: mesh_digest(&object.mesh),
        bound: twin.bound,
    }
}
