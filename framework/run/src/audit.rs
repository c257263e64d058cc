//! A run under audit: every call of a plugin is held against its role's laws.

use crate::setup::Solve;
use crate::{Run, RunError, RunOptions, Setup};
use regrasp_api::{Hand, Plugins, Slot, with_slots};
pub use regrasp_audit::Depth;
use regrasp_audit::{Audited, Auditor, Breach};
use regrasp_planner::{Outcome, PlanError, Request};
use serde_json::{Value, json};

/// What [`AuditCase`] files begin with.
const FORMAT: &str = "regrasp-audit-case";

/// A breach with the problem in which it happened.
#[derive(Clone, Debug, PartialEq)]
pub struct AuditCase {
    /// The breach.
    pub breach: Breach,
    /// The file: the breach, the resolved scenario with the plugins' settings, and the seed.
    pub file: Value,
}

impl Setup<'_> {
    /// Plans and verifies as [`Setup::run`] does, the calls of plugins under audit; the first breach of a law
    /// ends the run.
    ///
    /// The plan is that of a run without audit, which takes a fifth of the time or more.
    pub fn run_audited(
        &self,
        options: &RunOptions<'_>,
        depth: Depth,
    ) -> (Result<Run, RunError>, Option<AuditCase>) {
        let auditor = self.auditor().at(depth);
        let solve = |request: &Request<'_>| audited(request, &auditor, &regrasp_planner::solve);
        let run = self.run_by(&solve, options);
        (run, auditor.breach().map(|breach| self.case(breach, options.seed)))
    }

    /// Who audits a run of these plugins.
    pub fn auditor(&self) -> Auditor<'_> {
        let plugins = self.choices().iter().map(|(slot, choice)| (slot, choice.id.clone()));
        Auditor::new(&self.scenario().object, self.scenario().hand.fingertip_radius(), plugins)
    }

    fn case(&self, breach: Breach, seed: u64) -> AuditCase {
        let file = json!({
            "format": FORMAT,
            "seed": seed,
            "breach": breach.json(),
            "scenario": self.resolved_scenario(&self.scenario.problem),
        });
        AuditCase { breach, file }
    }
}

macro_rules! audited {
    ($([$slot:ident $field:ident $trait:ident] $row:tt)+) => {
        /// Plans by `solve` with every plugin of the request under audit.
        pub fn audited(
            request: &Request<'_>,
            auditor: &Auditor<'_>,
            solve: Solve<'_>,
        ) -> Result<Outcome, PlanError> {
            $(let $field = Audited::new(request.plugins.$field, Slot::$slot, auditor);)+
            solve(&Request { plugins: Plugins { $($field: &$field),+ }, ..*request })
        }
    };
}
with_slots!(audited);
