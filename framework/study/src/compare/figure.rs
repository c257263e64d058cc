//! Figures of a run that are summed up and compared.

use super::RunRecord;

/// A figure of a run that is summed up by its median over the successes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Figure {
    /// Planning time (s).
    Planning,
    /// Nodes that the search generated.
    GeneratedNodes,
    /// Nodes of the final graph.
    GraphNodes,
    /// Regrasps of the plan.
    Regrasps,
    /// Transfers of the plan.
    Transfers,
    /// Duration of the motion (s).
    Duration,
    /// Smallest closure margin.
    Margin,
    /// Smallest clearance (m).
    Clearance,
    /// Time of the verification (s).
    Verification,
    /// Questions of collision or distance that planning asked.
    CollisionTests,
    /// Bytes that planning had in use at once, at most.
    Memory,
    /// The smallest coefficient of friction at which every grasp still bears what it must.
    Friction,
    /// The largest mass that every grasp carries (kg).
    Mass,
    /// The largest disturbing force from any side that every grasp withstands (N).
    Force,
    /// The largest share of its limit that a joint's effort takes.
    Effort,
}

impl Figure {
    /// Every figure, in the order of the columns of `summary.csv`.
    pub const ALL: [Self; 15] = [
        Self::Planning,
        Self::GeneratedNodes,
        Self::GraphNodes,
        Self::Regrasps,
        Self::Transfers,
        Self::Duration,
        Self::Margin,
        Self::Clearance,
        Self::Verification,
        Self::CollisionTests,
        Self::Memory,
        Self::Friction,
        Self::Mass,
        Self::Force,
        Self::Effort,
    ];

    /// The name of its column in `runs.csv` and the begin of that in `summary.csv`, with its unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Planning => "planning_s",
            Self::GeneratedNodes => "generated_nodes",
            Self::GraphNodes => "graph_nodes",
            Self::Regrasps => "regrasps",
            Self::Transfers => "transfers",
            Self::Duration => "duration_s",
            Self::Margin => "margin",
            Self::Clearance => "clearance_m",
            Self::Verification => "verification_s",
            Self::CollisionTests => "collision_tests",
            Self::Memory => "memory_bytes",
            Self::Friction => "holds_friction",
            Self::Mass => "holds_mass_kg",
            Self::Force => "holds_force_n",
            Self::Effort => "effort_share",
        }
    }

    /// The figure of one run; absent where the run has none.
    pub fn of(self, run: &RunRecord) -> Option<f64> {
        let (motion, certified) = (run.motion.as_ref(), run.certified.as_ref());
        match self {
            Self::Planning => Some(run.times.planning_s),
            Self::GeneratedNodes => Some(run.counts.generated_nodes as f64),
            Self::GraphNodes => Some(run.counts.graph_nodes as f64),
            Self::Regrasps => motion.map(|motion| motion.regrasps as f64),
            Self::Transfers => motion.map(|motion| motion.transfers as f64),
            Self::Duration => motion.map(|motion| motion.duration_s),
            Self::Margin => certified.and_then(|certified| certified.margin),
            Self::Clearance => certified.and_then(|certified| certified.clearance_m),
            Self::Verification => certified.map(|_| run.times.verification_s),
            Self::CollisionTests => Some(run.counts.collision_tests as f64),
            Self::Memory => run.times.memory_bytes.map(|bytes| bytes as f64),
            Self::Friction => certified.and_then(|certified| certified.holds_friction),
            Self::Mass => certified.and_then(|certified| certified.holds_mass_kg),
            Self::Force => certified.and_then(|certified| certified.holds_force_n),
            Self::Effort => certified.and_then(|certified| certified.effort_share),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::analyse;
    use crate::compare::fixture::{runs, study};

    #[test]
    fn figures_are_found_where_they_are_kept() {
        assert!(Figure::ALL.into_iter().enumerate().all(|(k, figure)| figure as usize == k));
        let study = study(&["rlg"]);
        let records = runs(&study, |_| Some(0.25));
        let rows = analyse(&study, &records);
        let median = |figure| rows[0][0].median(figure).map(|found| found.value);
        assert_eq!(median(Figure::Planning), Some(0.25));
        assert_eq!((median(Figure::Regrasps), median(Figure::Transfers)), (Some(3.0), Some(4.0)));
        assert_eq!((median(Figure::Margin), median(Figure::Clearance)), (Some(0.1), None));
    }
}
