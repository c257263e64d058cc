//! The plan file of an outcome.

use crate::cones::Cones;
use crate::{RunError, Setup};
use regrasp_plan::{
    Claims, ContactClaim, Format, MarginFrame, Plan, PluginChoice, ResolvedScenario, StoppedBy, TransferLaw,
    VERSION,
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
        let cones =
            Cones::of(&outcome.motion, self.plugins.contact_model.as_ref(), self.scenario.object.friction);
        let mut segments = regrasp_plan::records(&outcome.motion, self.hand())?;
        let mut claims = self.claims(&cones);
        claims.contact.cones = cones.record(&mut segments);
        Ok(Plan {
            format: Format::RegraspPlan,
            version: VERSION,
            scenario: self.resolved_scenario(),
            seed,
            versions: [("regrasp".to_owned(), env!("CARGO_PKG_VERSION").to_owned())].into(),
            object: None,
            notes: regrasp_plan::plugin_notes(&outcome.tally),
            claims,
            goals_reached: outcome.goal_ends.clone(),
            stopped_by,
            statistics: outcome.statistics.clone(),
            certificate: None,
            segments,
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

    /// What the plan claims, but for the cones of contacts that share none.
    fn claims(&self, cones: &Cones) -> Claims {
        let model = self.choices().choice(regrasp_api::Slot::ContactModel).id.clone();
        Claims {
            contact: ContactClaim { model, cone: cones.shared(), cones: Vec::new() },
            criterion: self.plugins.stability.criterion(),
            transfer_law: TransferLaw::of_fingertips(self.hand().fingertip()),
            margin: MarginFrame::of_object(&self.scenario.object),
        }
    }
}
