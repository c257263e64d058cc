//! A run under audit: every call of a plugin is held against its role's laws.

use crate::setup::Solve;
use crate::{Run, RunError, RunOptions, Setup};
use regrasp_api::{Hand, Slot};
use regrasp_audit::{Audited, Auditor, Breach};
use regrasp_planner::{Drivers, Outcome, PlanError, Request};
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
    /// Plans and verifies as [`Setup::run`] does, every call of a plugin under audit; the first breach of a law ends the run.
    ///
    /// The plan is that of a run without audit. It takes about three times as long.
    pub fn run_audited(&self, options: &RunOptions<'_>) -> (Result<Run, RunError>, Option<AuditCase>) {
        let auditor = self.auditor();
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
            "scenario": self.resolved_scenario(),
        });
        AuditCase { breach, file }
    }
}

/// Plans by `solve` with every plugin of the request under audit.
pub fn audited(request: &Request<'_>, auditor: &Auditor<'_>, solve: Solve<'_>) -> Result<Outcome, PlanError> {
    let drivers = &request.drivers;
    let contact_model = Audited::new(request.contact_model, Slot::ContactModel, auditor);
    let stability = Audited::new(request.stability, Slot::StabilityTest, auditor);
    let surface = Audited::new(request.surface, Slot::Surface, auditor);
    let sampler = Audited::new(drivers.sampler, Slot::Sampler, auditor);
    let grasp = Audited::new(drivers.grasp, Slot::GraspPlanner, auditor);
    let transfer = Audited::new(drivers.transfer, Slot::TransferPlanner, auditor);
    let regrasp = Audited::new(drivers.regrasp, Slot::RegraspPlanner, auditor);
    let strategy = Audited::new(drivers.strategy, Slot::GraphStrategy, auditor);
    solve(&Request {
        contact_model: &contact_model,
        stability: &stability,
        surface: &surface,
        drivers: Drivers {
            sampler: &sampler,
            grasp: &grasp,
            transfer: &transfer,
            regrasp: &regrasp,
            strategy: &strategy,
        },
        ..*request
    })
}
