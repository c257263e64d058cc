//! What a run says besides its plan, as JSON for Python.

use regrasp::run::Run;
use regrasp::run::scenario::Scenario;
use serde_json::{Value, json};

/// How a run ended, with its figures.
pub fn summary(scenario: &Scenario, run: &Run) -> Value {
    let outcome = &run.outcome;
    json!({
        "status": outcome.status,
        "verified": run.is_verified(),
        "stopped_by": run.stopped_by,
        "reason": run.why_not_solved(),
        "advice": run.why_not_solved().map(|_| regrasp::advice(run)),
        "goals": scenario.problem.goal.len(),
        "goals_reached": outcome.goal_ends.len(),
        "planning_s": run.planning_s,
        "verification_s": run.verification_s,
        "statistics": outcome.statistics,
        "warnings": outcome.warnings,
        "verdict": run.verdict,
    })
}
