//! Why a run cannot be made at all.

use crate::scenario::{Scenario, ScenarioError};
use regrasp_host::HostError;
use regrasp_plan::ConvertError;
use regrasp_planner::PlanError;
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

impl RunError {
    pub(super) fn of_planner(scenario: &Scenario, error: PlanError) -> Self {
        match error {
            PlanError::Call(error) => Self::Call(error),
            error => Self::Scenario(scenario.refuse(&error)),
        }
    }
}
