//! The plan file of an outcome.

use crate::{RunError, Setup};
use regrasp_api::{Contact, FingerIndex};
use regrasp_plan::{
    Claims, ConeClaim, ContactClaim, Format, MarginFrame, Motion, Plan, PluginChoice, ResolvedScenario,
    StoppedBy, TransferLaw, VERSION,
};
use regrasp_planner::Outcome;
use serde_json::Value;

impl Setup<'_> {
    /// The plan file of an outcome, without a certificate; without segments where no goal was reached.
    pub fn plan_file(
        &self,
        outcome: &Outcome,
        seed: u64,
        stopped_by: Option<StoppedBy>,
    ) -> Result<Plan, RunError> {
        Ok(Plan {
            format: Format::RegraspPlan,
            version: VERSION,
            scenario: self.resolved_scenario(),
            seed,
            versions: [("regrasp".to_owned(), env!("CARGO_PKG_VERSION").to_owned())].into(),
            object: None,
            notes: Default::default(),
            claims: self.claims(&outcome.motion),
            goals_reached: outcome.goal_ends.clone(),
            stopped_by,
            statistics: outcome.statistics.clone(),
            certificate: None,
            segments: regrasp_plan::records(&outcome.motion, self.hand())?,
        })
    }

    pub(super) fn resolved_scenario(&self) -> ResolvedScenario {
        let plugin = |choice: &regrasp_host::Choice| PluginChoice {
            id: choice.id.clone(),
            settings: Value::Object(choice.settings.clone()),
        };
        ResolvedScenario {
            name: self.scenario.name.clone(),
            problem: self.scenario.problem.clone(),
            plugins: self.choices().iter().map(|(slot, choice)| (slot, plugin(choice))).collect(),
        }
    }

    /// What the plan claims: one cone for all contacts, or none where they differ.
    fn claims(&self, motion: &Motion) -> Claims {
        let object = &self.scenario.object;
        let cone = |(finger, contact): (FingerIndex, &Contact)| {
            ConeClaim::from_cone(&self.plugins.contact_model.cone(finger, contact, object.friction))
        };
        let states = motion.segments.iter().flat_map(|segment| &segment.states);
        let mut cones =
            states.flat_map(|q| q.contacts.iter().filter_map(|(i, c)| Some((i, c.as_ref()?)))).map(cone);
        let first = cones.next().flatten();
        let cone = first.filter(|_| cones.all(|other| other == first));
        let model = self.choices().choice(regrasp_api::Slot::ContactModel).id.clone();
        Claims {
            contact: ContactClaim { model, cone, cones: vec![] },
            criterion: self.plugins.stability.criterion(),
            transfer_law: TransferLaw::of_fingertips(self.hand().fingertip()),
            margin: MarginFrame::of_object(object),
        }
    }
}
