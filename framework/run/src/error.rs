//! Why a run cannot be made at all.

use crate::scenario::{Scenario, ScenarioError};
use regrasp_api::{Body, BodyPair, FingerGrasp, Refusal, Refuse};
use regrasp_host::HostError;
use regrasp_plan::ConvertError;
use regrasp_planner::{End, PlanError};
use thiserror::Error;

/// A run cannot be made; "no plan found" is not among these but an outcome.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RunError {
    /// The scenario says something that cannot be: a start in collision, an obstacle of no size.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// A plugin is refused.
    #[error(transparent)]
    Host(#[from] HostError),
    /// A plugin failed while the planner called it.
    #[error("{0}")]
    Call(regrasp_api::CallError),
    /// The planner's motion does not fit the plan file: a defect of the program.
    #[error("the plan cannot be written down: {0}")]
    Convert(#[from] ConvertError),
}

impl Refuse for RunError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Scenario(error) => error.refusal(),
            Self::Host(error) => error.refusal(),
            Self::Call(error) => error.refusal(),
            Self::Convert(_) => Refusal::new("defect", self),
        }
    }
}

impl RunError {
    pub(crate) fn of_planner(scenario: &Scenario, error: PlanError) -> Self {
        match error {
            PlanError::Call(error) => Self::Call(error),
            PlanError::Collision { end, pair } => Self::Scenario(scenario.refuse(&collision(
                scenario,
                &end.to_string(),
                pair,
                "choose another grasp or move the object",
            ))),
            PlanError::Unstable { end, friction } => {
                Self::Scenario(scenario.refuse(&unstable(scenario, end, friction)))
            }
            error => Self::Scenario(scenario.refuse(&error)),
        }
    }
}

/// The refusal of two bodies that are too close at the place `key`.
pub(crate) fn collision(scenario: &Scenario, key: &str, pair: BodyPair, fix: &str) -> Refusal {
    let problem = &scenario.problem;
    let clear = problem.limits.tolerances.clearance + problem.limits.resolution.clearance;
    let [a, b] = [pair.0, pair.1].map(|body: Body| problem.name_of(body));
    let clear = format!("{:.3} mm", clear * 1e3);
    let message = format!("`{key}`: {a} and {b} overlap, or are closer than the clearance of {clear}; {fix}");
    Refusal::new("collision", &message).key(key).value(format!("{a}, {b}")).range(clear).remedy(fix)
}

fn unstable(scenario: &Scenario, end: End, friction: f64) -> Refusal {
    let problem = &scenario.problem;
    let grasp = match end {
        End::Start => problem.start.grasp.as_deref(),
        End::Goal(index) => problem.goal.get(index).and_then(|goal| goal.grasp.as_deref()),
    };
    let touches = |entry: &&(&FingerGrasp, String)| entry.0.contact.is_some();
    let names = problem.hand.finger.iter().map(|finger| format!("`{}`", finger.name));
    let entries: Vec<_> = grasp.unwrap_or_default().iter().zip(names).collect();
    let holding: Vec<&str> = entries.iter().filter(touches).map(|(_, name)| name.as_str()).collect();
    let held = match holding.as_slice() {
        [] => "no finger has a `contact`, so that nothing holds the object".to_owned(),
        names => format!("the object is not held by {} contacts ({})", names.len(), names.join(", ")),
    };
    let fix = "give more fingers a `contact`, spread the contacts round the object, or raise the friction";
    let message = format!("`{end}.grasp`: the grasp is not stable: with friction {friction}, {held}; {fix}");
    Refusal::new("unstable", &message).key(format!("{end}.grasp")).value(friction).remedy(fix)
}
