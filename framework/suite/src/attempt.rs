//! What came of one trial.

use serde::{Deserialize, Serialize};

/// What a replay of a plan says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replayed {
    /// Whether the object arrives.
    pub arrived: bool,
    /// How far it is in the end from where it should be (m).
    pub distance: f64,
    /// By how much it is turned from there (rad).
    pub angle: f64,
}

/// Why a plan cannot be replayed, in a sentence.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Unreplayable(pub String);

/// One plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Attempt {
    /// Whether there is a plan to the goal and the verifier accepts it.
    pub solved: bool,
    /// Time for planning alone (s).
    pub planning_s: f64,
    /// Nodes that were generated.
    pub generated: usize,
    /// Regrasps of the plan; 0 where there is none.
    pub regrasps: usize,
    /// What the replay says; absent where there is no plan, or nobody replays.
    pub replayed: Option<Replayed>,
    /// Why nobody can replay the plan; absent where somebody does, or was not asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unreplayable: Option<Unreplayable>,
}

/// A trial: one plan, or in a chain one after the other until there is none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// The number of the series.
    pub series: usize,
    /// The number of the problem.
    pub problem: usize,
    /// The plans.
    pub attempts: Vec<Attempt>,
}

impl Trial {
    /// Goals that were reached in turn.
    pub fn reached(&self) -> usize {
        self.attempts.iter().take_while(|attempt| attempt.solved).count()
    }

    /// Goals that were reached in turn and whose plans arrive in the replay; `None` where nobody replays.
    pub fn arrived(&self) -> Option<usize> {
        let is_replayed = self.attempts.iter().any(|attempt| attempt.replayed.is_some());
        let arrives = |attempt: &&Attempt| attempt.replayed.is_some_and(|replayed| replayed.arrived);
        is_replayed.then(|| self.attempts.iter().take_while(arrives).count())
    }
}
