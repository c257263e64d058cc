//! One run: from a scenario to a plan that was verified.

use crate::RunError;
use crate::again::{TRIES, Try};
use crate::error;
use crate::scenario::{Scenario, ScenarioError, other_test};
use regrasp_abi::GuardedService;
use regrasp_api::{
    Clearance, FrictionFactor, Hand, HoldDescription, Interrupt, Parts, Pose, Problem, Refusal, Vec3,
};
use regrasp_host::{Choices, PluginSet, Registry, Source};
use regrasp_plan::{Plan, StoppedBy};
use regrasp_planner::{Clock, Outcome, PlanError, Progress, Request, Status, Stuck};
use regrasp_verify::Verdict;
use regrasp_world::SceneClearance;
use std::iter;

/// An interrupt that knows what it was.
pub trait Stop: Interrupt {
    /// What stopped the run; asked only after it was interrupted.
    fn cause(&self) -> StoppedBy;
}

/// Lets every run come to its own end.
#[derive(Clone, Copy, Debug, Default)]
pub struct NeverStops;

impl Interrupt for NeverStops {
    fn interrupted(&self) -> bool {
        false
    }
}

impl Stop for NeverStops {
    fn cause(&self) -> StoppedBy {
        StoppedBy::Interrupt
    }
}

/// What a run needs besides the scenario.
#[derive(Clone, Copy)]
pub struct RunOptions<'a> {
    /// Seed of all random streams.
    pub seed: u64,
    /// How many threads compute; the plan does not depend on it.
    pub threads: usize,
    /// Stops the run from outside.
    pub stop: &'a dyn Stop,
    /// Times the phases.
    pub clock: &'a dyn Clock,
    /// Told how far the run is.
    pub progress: &'a dyn Progress,
}

/// What a run gives.
pub struct Run {
    /// The planner's own answer.
    pub outcome: Outcome,
    /// What stopped the search before its end; absent where it came to an end of its own, with a plan or
    /// without.
    pub stopped_by: Option<StoppedBy>,
    /// The plan as its file holds it, certificate included; absent where no goal was reached.
    pub plan: Option<Plan>,
    /// The verifier's answer on the plan.
    pub verdict: Option<Verdict>,
    /// Seconds for planning alone: start and goal grasps, search, smoothing, timing.
    pub planning_s: f64,
    /// Seconds for the verification.
    pub verification_s: f64,
}

impl Run {
    /// Whether there is a plan and the verifier accepts it; a plan that reaches only some goals is judged by
    /// what it does.
    pub fn is_verified(&self) -> bool {
        self.verdict.as_ref().is_some_and(|verdict| match self.outcome.status {
            Status::Solved => verdict.valid,
            _ => verdict.is_sound(),
        })
    }

    /// What ended the run before its last goal, and where; absent where it is solved.
    pub fn why_not_solved(&self) -> Option<String> {
        let outcome = &self.outcome;
        if outcome.status == Status::Solved {
            return None;
        }
        let stuck = match outcome.stuck {
            Some(Stuck::StartGrasp) => "no admissible grasp was found at the start".to_owned(),
            Some(Stuck::GoalGrasp(goal)) => format!("no admissible grasp was found at goal {}", goal + 1),
            Some(Stuck::Search(goal)) => format!("the search for goal {} found no way", goal + 1),
            None => format!("the search was stopped on the way to goal {}", outcome.goal_ends.len() + 1),
        };
        let stopped = match self.stopped_by {
            Some(StoppedBy::TimeLimit) => "no plan within the time limit",
            Some(StoppedBy::MaxNodes) => "no plan within the budget of nodes",
            Some(StoppedBy::Interrupt) => "interrupted",
            None => "no plan",
        };
        Some(format!("{stopped}: {stuck}"))
    }
}

/// The planner, or something around it.
pub type Solve<'s> = &'s dyn Fn(&Request<'_>) -> Result<Outcome, PlanError>;

/// A scenario with its plugins built, ready to be planned with any seed.
pub struct Setup<'a> {
    pub(crate) scenario: &'a Scenario,
    choices: Choices,
    pub(crate) clearance: SceneClearance,
    /// The object's at the start and at the goals, in turn.
    pub(crate) poses: Vec<Pose>,
    pub(crate) plugins: PluginSet,
    /// Whether some plugin comes from a library: a panic of hand or clearance could not leave it.
    has_loaded: bool,
}

impl<'a> Setup<'a> {
    /// Builds collision and plugins; `choices` as the scenario gives them or changed since.
    pub fn new(scenario: &'a Scenario, choices: &Choices, registry: &Registry) -> Result<Self, RunError> {
        Self::build(scenario, choices, registry, poses)
    }

    /// The same without start and goals, for work on grasps: nothing is asked of them, and no plugin is told.
    pub fn without_ends(
        scenario: &'a Scenario,
        choices: &Choices,
        registry: &Registry,
    ) -> Result<Self, RunError> {
        Self::build(scenario, choices, registry, |_, _| Ok(Vec::new()))
    }

    fn build(
        scenario: &'a Scenario,
        choices: &Choices,
        registry: &Registry,
        poses: impl Fn(&Scenario, &SceneClearance) -> Result<Vec<Pose>, ScenarioError>,
    ) -> Result<Self, RunError> {
        let choices = choices.resolve(registry)?;
        can_hold(scenario, &choices)?;
        let limits = &scenario.problem.limits;
        let clearance = SceneClearance::new(
            scenario.hand.clone(),
            &scenario.object,
            &scenario.problem.obstacle,
            limits.tolerances.clearance + limits.resolution.clearance,
        )
        .map_err(|error| scenario.refuse(&error))?;
        let poses = poses(scenario, &clearance)?;
        let parts = Parts {
            g_H: Vec3::from(scenario.problem.gravity),
            tolerances: limits.tolerances,
            resolution: limits.resolution,
            landmarks: &poses,
            ..Parts::new(&scenario.object, scenario.hand.as_ref())
        };
        let plugins = PluginSet::build(registry, &choices, &parts)?;
        let loaded =
            |id: &str| registry.find(id).is_some_and(|entry| registry.source(entry) != Source::BuiltIn);
        let has_loaded = choices.iter().any(|(_, choice)| loaded(&choice.id));
        Ok(Self { scenario, choices, clearance, poses, plugins, has_loaded })
    }

    /// The plugins with full ids and complete settings.
    pub fn choices(&self) -> &Choices {
        &self.choices
    }

    /// The scenario.
    pub fn scenario(&self) -> &'a Scenario {
        self.scenario
    }

    /// Plans and verifies.
    pub fn run(&self, options: &RunOptions<'_>) -> Result<Run, RunError> {
        self.run_by(&regrasp_planner::solve, options)
    }

    /// Plans with `solve`, which calls the planner with the request or with a changed one, and verifies.
    pub fn run_by(&self, solve: Solve<'_>, options: &RunOptions<'_>) -> Result<Run, RunError> {
        let begin = options.clock.seconds();
        self.refuse_too_heavy()?;
        let looked_s = options.clock.seconds() - begin;
        let mut run = self.run_problem(&self.scenario.problem, solve, options)?;
        run.planning_s += looked_s;
        Ok(run)
    }

    /// What stands in the object's way at a pose; the key of that pose is `key`.
    pub fn check_pose(&self, key: &str, X_HO: &Pose) -> Result<(), Box<Refusal>> {
        let overlap = |pair| Box::new(error::collision(self.scenario, key, pair, "move one of them"));
        self.clearance.object_free(X_HO).map_err(overlap)
    }

    /// Plans with `solve` for another start or other goals, which nobody has checked yet, and verifies; all
    /// else of `problem` must be the scenario's own. The plugins were told the scenario's start and goals.
    pub fn run_problem(
        &self,
        problem: &Problem,
        solve: Solve<'_>,
        options: &RunOptions<'_>,
    ) -> Result<Run, RunError> {
        let run = self.plan_and_verify(problem, solve, options);
        // A plugin that panicked outside the planner's own calls, say while cones were written down, spoils
        // the whole.
        match regrasp_api::take_fault() {
            Some(fault) => Err(RunError::Call(fault)),
            None => run,
        }
    }

    /// Asks the planner for something else than a plan: `ask` gets what a run would get.
    pub fn ask<T>(
        &self,
        options: &RunOptions<'_>,
        ask: impl FnOnce(&Request<'_>) -> Result<T, PlanError>,
    ) -> Result<T, RunError> {
        let problem = shares(&self.scenario.problem).swap_remove(0);
        let answer = self.requested(&problem, options, options.seed, ask);
        match regrasp_api::take_fault() {
            Some(fault) => Err(RunError::Call(fault)),
            None => answer,
        }
    }

    /// Plans for one share of the friction after the other where `[hold]` asks for as little as can be: the
    /// last plan that comes about is the one that needs least.
    fn plan_and_verify(
        &self,
        problem: &Problem,
        solve: Solve<'_>,
        options: &RunOptions<'_>,
    ) -> Result<Run, RunError> {
        let begin = options.clock.seconds();
        let mut best: Option<Run> = None;
        for problem in shares(problem) {
            // A smaller share of the friction is one more wish: where it does not come about, nothing is
            // tried again for it.
            let tries = if best.is_none() { &TRIES[..] } else { &TRIES[..1] };
            let run = self.plan_until_verified(&problem, solve, options, tries)?;
            let good = run.outcome.status == Status::Solved && run.is_verified();
            if best.is_some() && !good {
                break;
            }
            best = Some(run);
            if !good {
                break;
            }
        }
        let mut run = best.expect("there is a share of the friction to plan with");
        run.planning_s = options.clock.seconds() - begin - run.verification_s;
        Ok(run)
    }

    /// Plans in one way after the other until the verifier accepts the plan; where it accepts none, the last
    /// one tells why.
    fn plan_until_verified(
        &self,
        problem: &Problem,
        solve: Solve<'_>,
        options: &RunOptions<'_>,
        tries: &[Try],
    ) -> Result<Run, RunError> {
        let mut run = self.plan_one(problem, solve, options, tries[0])?;
        let mut warnings = Vec::new();
        for again in &tries[1..] {
            let Some(verdict) = run.verdict.as_ref().filter(|_| !run.is_verified()) else { break };
            if run.stopped_by.is_some() {
                break;
            }
            warnings.push(again.warning(verdict));
            let next = self.plan_one(problem, solve, options, *again)?;
            let verification_s = run.verification_s + next.verification_s;
            if next.verdict.is_some() {
                run = next;
            }
            run.verification_s = verification_s;
        }
        run.outcome.warnings.extend(warnings);
        Ok(run)
    }

    fn plan_one(
        &self,
        problem: &Problem,
        solve: Solve<'_>,
        options: &RunOptions<'_>,
        how: Try,
    ) -> Result<Run, RunError> {
        let begin = options.clock.seconds();
        let outcome = self.requested(&how.problem(problem), options, how.seed(options.seed), solve)?;
        let planned = options.clock.seconds();
        let stopped_by = stopped_by(&outcome, options.stop);
        let (mut plan, mut verdict) = (None, None);
        if !outcome.goal_ends.is_empty() {
            let mut file = self.plan_file(problem, &outcome, options.seed, stopped_by)?;
            let judged = regrasp_verify::verify_on(&file, options.threads);
            file.certificate = judged.certificate.clone();
            (plan, verdict) = (Some(file), Some(judged));
        }
        let verified = options.clock.seconds();
        Ok(Run {
            outcome,
            stopped_by,
            plan,
            verdict,
            planning_s: planned - begin,
            verification_s: verified - planned,
        })
    }

    fn requested<T>(
        &self,
        problem: &Problem,
        options: &RunOptions<'_>,
        seed: u64,
        ask: impl FnOnce(&Request<'_>) -> Result<T, PlanError>,
    ) -> Result<T, RunError> {
        let (hand, clearance) = (self.hand(), &self.clearance as &dyn Clearance);
        let guarded_hand = GuardedService::guarding("service/hand", hand);
        let guarded_clearance = GuardedService::guarding("service/clearance", clearance);
        let request = Request {
            problem,
            hand: if self.has_loaded { &guarded_hand } else { hand },
            clearance: if self.has_loaded { &guarded_clearance } else { clearance },
            object: &self.scenario.object,
            plugins: self.plugins.plugins(),
            seed,
            threads: options.threads,
            interrupt: options.stop,
            clock: options.clock,
            progress: options.progress,
        };
        ask(&request).map_err(|error| RunError::of_planner(self.scenario, error))
    }

    /// The hand.
    pub fn hand(&self) -> &dyn Hand {
        self.scenario.hand.as_ref()
    }
}

/// The problem with each share of the friction that it is to be planned with in turn; at least one.
fn shares(problem: &Problem) -> Vec<Problem> {
    let Some(hold) = problem.hold else { return vec![problem.clone()] };
    let planned = |&share: &f64| {
        let mut problem = problem.clone();
        problem.hold = Some(HoldDescription { friction_factor: FrictionFactor::Share(share), ..hold });
        problem.limits.resolution.friction_margin = share;
        problem
    };
    hold.friction_factor.shares().iter().map(planned).collect()
}

/// Refuses a stability test, which the command line may have chosen, that cannot do what `[hold]` asks for.
fn can_hold(scenario: &Scenario, choices: &Choices) -> Result<(), ScenarioError> {
    let test = &choices.choice(regrasp_api::Slot::StabilityTest).id;
    let refusal = scenario.problem.hold.as_ref().and_then(|hold| other_test(hold, test));
    refusal.map_or(Ok(()), |refusal| Err(scenario.refuse(&refusal)))
}

/// The poses of start and goals; refuses those at which the object itself is in collision: no grasp could
/// mend that.
fn poses(scenario: &Scenario, clearance: &SceneClearance) -> Result<Vec<Pose>, ScenarioError> {
    let poses = scenario.problem.poses().map_err(|error| scenario.refuse(&error))?;
    let goals = (0..poses.len() - 1).map(|i| format!("goal[{i}].pose"));
    for (key, X_HO) in iter::once("start.pose".to_owned()).chain(goals).zip(&poses) {
        let overlap = |pair| scenario.refuse(&error::collision(scenario, &key, pair, "move one of them"));
        clearance.object_free(X_HO).map_err(overlap)?;
    }
    Ok(poses)
}

fn stopped_by(outcome: &Outcome, stop: &dyn Stop) -> Option<StoppedBy> {
    match (outcome.status, outcome.stuck) {
        (Status::Interrupted, _) => Some(stop.cause()),
        (Status::NoPlan, Some(Stuck::Search(_))) => Some(StoppedBy::MaxNodes),
        _ => None,
    }
}
