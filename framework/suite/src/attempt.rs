//! What came of one trial.

use serde::Serialize;

/// What a replay of a plan says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Replayed {
    /// Whether the object arrives.
    pub arrived: bool,
    /// How far it is in the end from where it should be (m).
    pub distance: f64,
    /// By how much it is turned from there (rad).
    pub angle: f64,
}

/// One plan.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
}

/// A trial: one plan, or in a chain one after the other until there is none.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
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
