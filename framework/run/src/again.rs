//! What is tried when a plan does not pass the verifier: that is a fault of the planner, and no reason to end
//! without a plan.

use regrasp_api::Problem;
use regrasp_verify::Verdict;
use std::borrow::Cow;

/// How one more try differs from the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Try {
    /// What the steps of paths are multiplied with.
    step: f64,
    /// Whether the plan is smoothed.
    smooth: bool,
    /// What is added to the seed: another search.
    seed: u64,
}

/// The tries in turn: less smoothed, finer, then another search, and both.
pub(crate) const TRIES: [Try; 5] = [
    Try { step: 1.0, smooth: true, seed: 0 },
    Try { step: 1.0, smooth: false, seed: 0 },
    Try { step: 0.5, smooth: true, seed: 0 },
    Try { step: 0.5, smooth: true, seed: SEED },
    Try { step: 0.25, smooth: false, seed: SEED.rotate_left(7) },
];
/// Far from the seeds that people give.
const SEED: u64 = 0x9e37_79b9_7f4a_7c15;

impl Try {
    /// The problem as this try plans it; the plan itself holds the problem as it was given.
    pub(crate) fn problem<'p>(&self, problem: &'p Problem) -> Cow<'p, Problem> {
        if self.step == 1.0 && self.smooth {
            return Cow::Borrowed(problem);
        }
        let mut changed = problem.clone();
        let resolution = &mut changed.limits.resolution;
        let steps = [
            (&mut resolution.grasp_step, 1e-5),
            (&mut resolution.grasp_turn, 1e-4),
            (&mut resolution.transfer_step, 1e-5),
            (&mut resolution.transfer_turn, 1e-4),
            (&mut resolution.regrasp_step, 1e-5),
        ];
        for (step, least) in steps {
            *step = (*step * self.step).max(least);
        }
        if !self.smooth {
            changed.limits.budget.smoothing = 0;
        }
        Cow::Owned(changed)
    }

    pub(crate) fn seed(&self, seed: u64) -> u64 {
        seed.wrapping_add(self.seed)
    }

    /// The note that a run carries whose first plan, or whose first few, did not pass.
    pub(crate) fn warning(&self, verdict: &Verdict) -> String {
        let checks: Vec<&str> = verdict.failures().map(|check| check.name).collect();
        let search = if self.seed == 0 { "" } else { ", by another search" };
        let smooth = if self.smooth { "" } else { ", not smoothed" };
        let step =
            if self.step == 1.0 { String::new() } else { format!(", with steps of {} times", self.step) };
        format!(
            "a plan did not pass the verifier ({}) and was planned again{step}{smooth}{search}: a fault of \
             the planner, \
             which its makers like to hear of",
            checks.join(", ")
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tries_differ_and_only_make_finer() {
        let text = r#"{
            "hand": {"name": "-", "fingertip_radius": 0.01, "finger": []},
            "object": {"shape": {"kind": "sphere", "radius": 0.03}, "friction": 0.8},
            "start": {"pose": {}}, "goal": []
        }"#;
        let problem: Problem = serde_json::from_str(text).unwrap();
        assert!(matches!(TRIES[0].problem(&problem), Cow::Borrowed(_)));
        for (i, one) in TRIES.iter().enumerate() {
            assert!(TRIES[..i].iter().all(|other| other != one), "{one:?} is tried twice");
            let (tried, given) = (one.problem(&problem), problem.limits);
            assert!(tried.limits.resolution.transfer_step <= given.resolution.transfer_step);
            assert_eq!(tried.limits.tolerances, given.tolerances, "what must hold stays");
        }
        assert_eq!(TRIES[1].problem(&problem).limits.budget.smoothing, 0);
    }
}
