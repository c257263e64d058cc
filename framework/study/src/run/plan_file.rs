//! The plan file of an outcome.

use super::{RunError, Setup};
use regrasp_api::{Contact, GoalDescription, Pose, angle_between};
use regrasp_plan::{
    Claims, ConeClaim, ContactClaim, Format, MarginFrame, Motion, Plan, PluginChoice, ResolvedScenario,
    StoppedBy, TransferLaw, VERSION,
};
use regrasp_planner::Outcome;
use serde_json::Value;

/// How far the contact of a given grasp may lie from where the file says (m), as the scenario file allows.
const GIVEN_CONTACT: f64 = 1e-3;

impl Setup<'_> {
    pub(super) fn plan_file(
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
            claims: self.claims(&outcome.motion),
            goals_reached: self.goal_marks(outcome),
            stopped_by,
            statistics: outcome.statistics.clone(),
            certificate: None,
            segments: regrasp_plan::records(&outcome.motion, self.hand())?,
        })
    }

    fn resolved_scenario(&self) -> ResolvedScenario {
        let plugin = |choice: &regrasp_host::Choice| PluginChoice {
            id: choice.id.clone(),
            settings: Value::Object(choice.settings.clone()),
        };
        ResolvedScenario {
            name: self.scenario.name.clone(),
            problem: self.scenario.problem.clone(),
            plugins: self.choices.iter().map(|(slot, choice)| (slot, plugin(choice))).collect(),
        }
    }

    /// What the plan claims: one cone for all contacts, or none where they differ.
    fn claims(&self, motion: &Motion) -> Claims {
        let object = &self.scenario.object;
        let cone = |contact: &Contact| {
            ConeClaim::from_cone(&self.plugins.contact_model.cone(contact, object.friction))
        };
        let states = motion.segments.iter().flat_map(|segment| &segment.states);
        let mut cones =
            states.flat_map(|q| q.contacts.iter().filter_map(|(_, contact)| contact.as_ref())).map(cone);
        let first = cones.next().flatten();
        let cone = first.filter(|_| cones.all(|other| other == first));
        let model = self.choices.choice(regrasp_api::Slot::ContactModel).id.clone();
        Claims {
            contact: ContactClaim { model, cone },
            criterion: self.plugins.stability.criterion(),
            transfer_law: TransferLaw::of_fingertips(self.hand().fingertip()),
            margin: MarginFrame::of_object(object),
        }
    }

    /// For each goal that was reached, how many segments are done by then.
    fn goal_marks(&self, outcome: &Outcome) -> Vec<usize> {
        let segments = &outcome.motion.segments;
        let mut done = 0;
        let reached = self.scenario.problem.goal.iter().take(outcome.goals_reached);
        reached
            .map(|goal| {
                let last = |&segment: &usize| segments[segment - 1].states.last();
                let at_goal = |&segment: &usize| last(&segment).is_some_and(|q| self.is_at(goal, q));
                done = (done.max(1)..=segments.len()).find(at_goal).unwrap_or(segments.len());
                done
            })
            .collect()
    }

    fn is_at(&self, goal: &GoalDescription, q: &regrasp_api::Configuration) -> bool {
        let Ok(X_HG) = goal.pose.pose() else { return false };
        let tolerances = &self.scenario.problem.limits.tolerances;
        let apart = |X: &Pose| (X.translation.vector - X_HG.translation.vector).norm();
        let there = apart(&q.X_HO) <= tolerances.goal_position
            && angle_between(&q.X_HO.rotation, &X_HG.rotation) <= tolerances.goal_angle;
        there && goal.grasp.as_ref().is_none_or(|grasp| holds_as_given(grasp, q))
    }
}

fn holds_as_given(grasp: &[regrasp_api::FingerGrasp], q: &regrasp_api::Configuration) -> bool {
    q.contacts.iter().zip(grasp).all(|((_, contact), given)| match (contact, given.contact) {
        (Some(contact), Some(given)) => {
            (contact.p_OC - regrasp_api::Vec3::from(given)).norm() <= 2.0 * GIVEN_CONTACT
        }
        (contact, given) => contact.is_none() && given.is_none(),
    })
}
