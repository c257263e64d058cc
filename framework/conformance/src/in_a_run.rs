//! A whole search of the planner with the plugin in its slot, every call of it under audit.
//!
//! The checks try a plugin on problems that are made for it; here the planner asks what it asks. The other
//! slots are filled with the kit's references.

use crate::fixtures::Bench;
use crate::reference::ReferencePlugins;
use crate::{Demands, Outcome};
use regrasp_api::{
    Build, BuildError, CallError, ClosedChainSampler, ContactModel, Entry, GraphStrategy, LocalPlanner,
    Parts, Plugins, PoseDescription, Problem, Shelf, Slot, StabilityTest, SurfaceParam, Uninterrupted,
    take_fault, with_slots,
};
use regrasp_audit::{Audited, Auditor, Breach};
use regrasp_planner::{Clock, PlanError, Request, Silent, solve};
use serde_json::{Value, json};

/// Nodes that a search may generate: enough that each slot is asked, few enough for a test.
const NODES: usize = 10;
const SEED: u64 = 1;

/// What a run with a plugin under audit came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// The plugin's id.
    pub plugin: String,
    /// The slot that it filled.
    pub slot: Slot,
    /// How it ended.
    pub outcome: Outcome,
    /// How many of its calls were looked at.
    pub looks: u64,
    /// The call that broke a law, as `regrasp plan --audit-save` keeps it: [`crate::replay`] makes it again.
    pub case: Option<Value>,
}

/// Time stands still: times are no matter of a law.
struct Still;

impl Clock for Still {
    fn seconds(&self) -> f64 {
        0.0
    }
}

macro_rules! cast {
    ($([$slot:ident $field:ident $trait:ident] $row:tt)+) => {
        /// The plugin of each slot.
        struct Cast {
            $($field: Box<dyn $trait>,)+
        }

        impl Cast {
            /// Plans with the plugin of one slot under audit.
            fn plan(
                &self,
                slot: Slot,
                bench: &Bench,
                problem: &Problem,
                auditor: &Auditor<'_>,
            ) -> Result<(), PlanError> {
                $(let $field = Audited::new(&*self.$field, Slot::$slot, auditor);)+
                let plugins = Plugins {
                    $($field: if slot == Slot::$slot { &$field } else { &*self.$field },)+
                };
                solve(&Request {
                    problem,
                    hand: &*bench.world.hand,
                    clearance: &bench.world.clearance,
                    object: &bench.world.object,
                    plugins,
                    seed: SEED,
                    threads: 1,
                    interrupt: &Uninterrupted,
                    clock: &Still,
                    progress: &Silent,
                })
                .map(drop)
            }
        }
    };
}
with_slots!(cast);

impl Cast {
    /// The kit's references.
    fn references(parts: &Parts<'_>) -> Result<Self, BuildError> {
        let shelf = &ReferencePlugins;
        Ok(Self {
            contact_model: shelf.contact_model(None, "", parts)?,
            stability: shelf.stability_test(None, "", parts)?,
            surface: shelf.surface(None, "", parts)?,
            sampler: shelf.sampler(None, "", parts)?,
            grasp: shelf.local_planner(Slot::GraspPlanner, None, "", parts)?,
            transfer: shelf.local_planner(Slot::TransferPlanner, None, "", parts)?,
            regrasp: shelf.local_planner(Slot::RegraspPlanner, None, "", parts)?,
            strategy: shelf.graph_strategy(None, "", parts)?,
        })
    }

    /// Puts a plugin into a slot.
    fn put(&mut self, entry: &Entry, slot: Slot, json: &str, parts: &Parts<'_>) -> Result<(), BuildError> {
        match entry.build {
            Build::ContactModel(build) => self.contact_model = build(json, parts)?,
            Build::StabilityTest(build) => self.stability = build(json, parts)?,
            Build::Surface(build) => self.surface = build(json, parts)?,
            Build::Sampler(build) => self.sampler = build(json, parts)?,
            Build::LocalPlanner(build) => match slot {
                Slot::GraspPlanner => self.grasp = build(json, parts)?,
                Slot::TransferPlanner => self.transfer = build(json, parts)?,
                _ => self.regrasp = build(json, parts)?,
            },
            Build::GraphStrategy(build) => self.strategy = build(json, parts)?,
        }
        Ok(())
    }
}

/// A ball in free fingertips, to be turned so far that fingers must be set anew.
fn problem() -> Problem {
    let mut problem = Bench::problem_of_free_sphere();
    problem.goal[0].pose = PoseDescription {
        axis: Some([0.3, 1.0, 0.2]),
        angle_deg: Some(70.0),
        ..problem.goal[0].pose.clone()
    };
    problem.limits.budget.max_nodes = NODES;
    problem
}

/// Plans with the plugin in each of its slots, every call of it under audit.
pub fn audit_in_a_run(entry: &Entry, demands: &Demands) -> Vec<Trial> {
    entry.slots.iter().map(|&slot| trial(entry, slot, demands)).collect()
}

fn trial(entry: &Entry, slot: Slot, demands: &Demands) -> Trial {
    let problem = problem();
    let bench = Bench::of(&problem).expect("the kit's own problems are sound");
    let plugin = entry.id.to_owned();
    let mut trial = Trial { plugin: plugin.clone(), slot, outcome: Outcome::Passed, looks: 0, case: None };
    let parts = bench.parts();
    let built = Cast::references(&parts).and_then(|mut cast| {
        cast.put(entry, slot, &demands.settings, &parts)?;
        Ok(cast)
    });
    let cast = match built {
        Ok(cast) => cast,
        Err(error) => {
            trial.outcome = Outcome::from(Err(crate::report::Fault::from(error)));
            return trial;
        }
    };
    let auditor = Auditor::new(&bench.world.object, bench.radius(), [(slot, plugin)]);
    let planned = cast.plan(slot, &bench, &problem, &auditor);
    // A breach in a call that returns no `Result` is this thread's fault.
    take_fault();
    trial.looks = auditor.looks();
    trial.outcome = match (auditor.breach(), planned) {
        (Some(breach), _) => {
            trial.case = Some(case(&breach, &problem, &demands.settings));
            Outcome::Failed(breach.error().to_string())
        }
        (None, Ok(())) if trial.looks == 0 => Outcome::NotApplicable("the run never asks it".into()),
        (None, Ok(())) => Outcome::Passed,
        (None, Err(PlanError::Call(CallError::Unsupported { reason, .. }))) => Outcome::NotApplicable(reason),
        (None, Err(error @ PlanError::Call(_))) => Outcome::Failed(format!("the run ends with {error}")),
        // Too few fingers for a contact model, say.
        (None, Err(error)) => Outcome::NotApplicable(error.to_string()),
    };
    trial
}

/// A breach with its problem, in the form of `--audit-save`.
fn case(breach: &Breach, problem: &Problem, settings: &str) -> Value {
    let settings: Value = serde_json::from_str(settings).unwrap_or_else(|_| json!({}));
    json!({
        "format": "regrasp-audit-case",
        "seed": SEED,
        "breach": breach.json(),
        "scenario": {
            "name": "conformance",
            "problem": problem,
            "plugins": { breach.slot.name(): { "id": breach.plugin, "settings": settings } },
        },
    })
}

impl Trial {
    /// One line: how many calls kept the laws, or why there was no run.
    fn line(&self) -> String {
        let Self { plugin, slot, outcome, looks, .. } = self;
        let slot = slot.name();
        match outcome {
            Outcome::Passed => format!("`{plugin}`: {looks} calls of a run in `{slot}` audited"),
            Outcome::NotApplicable(reason) => format!("`{plugin}`: no run in `{slot}` ({reason})"),
            Outcome::Failed(reason) => format!("`{plugin}`, in a run in `{slot}`: {reason}"),
        }
    }
}

/// Plans with every registered plugin, its calls under audit, and says in a line each how many there were;
/// panics with the calls that broke a law. They are kept as files in `folder`, if there is one.
pub fn assert_registered_keep_the_laws_in_a_run(demands: &Demands, folder: Option<&str>) -> String {
    let trials = crate::registered().into_iter().flat_map(|entry| audit_in_a_run(entry, demands));
    let trials: Vec<Trial> = trials.collect();
    let failed = trials.iter().filter(|trial| matches!(trial.outcome, Outcome::Failed(_)));
    let failed: Vec<String> = failed.map(|trial| trial.line() + &kept(trial, folder)).collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    trials.iter().map(|trial| trial.line() + "\n").collect()
}

/// Keeps the call of a trial, and says where.
fn kept(trial: &Trial, folder: Option<&str>) -> String {
    let (Some(case), Some(folder)) = (&trial.case, folder) else { return String::new() };
    let name = format!("breach-{}-{}.json", trial.plugin.replace('/', "-"), trial.slot.name());
    let file = std::path::Path::new(folder).join(name);
    match std::fs::write(&file, format!("{case:#}\n")) {
        Ok(()) => format!("; the call is kept in {}, for `assert_replay_keeps`", file.display()),
        Err(error) => format!("; the call cannot be kept in {}: {error}", file.display()),
    }
}
