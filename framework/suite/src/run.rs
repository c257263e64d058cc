//! Planning, verifying and replaying the problems of a protocol.

use crate::library::Files;
use crate::{Attempt, Problem, Protocol, Replayed, Series, SuiteError, Trial, Turn, problems};
use regrasp_api::{
    GoalDescription, Pose, PoseDescription, Problem as Task, Refusal, Rotation, StartDescription, Vec3,
};
use regrasp_atlas::start_at;
use regrasp_host::Registry;
use regrasp_plan::{Plan, configuration};
use regrasp_planner::{Clock, Silent, Status};
use regrasp_run::scenario::Scenario;
use regrasp_run::{RunOptions, Setup, Stop};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Replays a plan; why it cannot be replayed, in fields, where it cannot.
pub type Judge<'a> = &'a (dyn Fn(&Plan) -> Result<Replayed, Box<Refusal>> + Sync);

/// Told of every trial that has ended, with its plans.
pub type Told<'a> = &'a (dyn Fn(&Trial, &[Plan]) + Sync);

/// What a run needs beside the protocol.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// How many threads; what is found does not depend on it, times do.
    pub threads: usize,
    /// Stops the run from outside.
    pub stop: &'a dyn Stop,
    /// Times planning.
    pub clock: &'a (dyn Clock + Sync),
    /// Replays plans, where somebody does.
    pub judge: Option<Judge<'a>>,
    /// Told of every trial.
    pub told: Told<'a>,
}

/// Runs every trial of a protocol, in the order of its series; the trials so far where it was stopped.
pub fn run(
    protocol: &Protocol,
    files: &Files,
    registry: &Registry,
    options: &Options<'_>,
) -> Result<Vec<Trial>, SuiteError> {
    let mut trials = Vec::new();
    for (number, series) in protocol.series.iter().enumerate() {
        let mut scenario = files.scenario(&series.scenario, registry)?;
        if let Some(name) = &series.preset {
            let preset = regrasp_host::preset(name)
                .map_err(|error| SuiteError::Preset { series: series.name.clone(), error: error.into() })?;
            preset.apply(&mut scenario.choices);
        }
        if let Some(most) = series.max_nodes {
            scenario.problem.limits.budget.max_nodes = most;
        }
        let job = Job { series, number, scenario: &scenario, registry, options };
        trials.extend(job.trials(&problems(series))?);
        if options.stop.interrupted() {
            break;
        }
    }
    Ok(trials)
}

/// A series at work.
struct Job<'a> {
    series: &'a Series,
    number: usize,
    scenario: &'a Scenario,
    registry: &'a Registry,
    options: &'a Options<'a>,
}

impl Job<'_> {
    /// Its trials, on threads, in their order.
    fn trials(&self, problems: &[Problem]) -> Result<Vec<Trial>, SuiteError> {
        let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
        let work = || -> Result<(), SuiteError> {
            let setup = Setup::new(self.scenario, &self.scenario.choices, self.registry)?;
            while let Some((k, problem)) = at(problems, next.fetch_add(1, Ordering::Relaxed)) {
                let Some((trial, plans)) = self.trial(&setup, k, problem)? else { return Ok(()) };
                (self.options.told)(&trial, &plans);
                if let Ok(mut done) = done.lock() {
                    done.push(trial);
                }
            }
            Ok(())
        };
        let ended = thread::scope(|scope| {
            let running: Vec<_> = (0..self.options.threads.max(1)).map(|_| scope.spawn(work)).collect();
            let join = |one: thread::ScopedJoinHandle<'_, Result<(), SuiteError>>| {
                one.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            running.into_iter().map(join).collect::<Result<Vec<()>, _>>()
        });
        ended?;
        let mut trials = done.into_inner().unwrap_or_default();
        trials.sort_by_key(|trial| trial.problem);
        Ok(trials)
    }

    /// One trial; `None` where it was stopped.
    fn trial(
        &self,
        setup: &Setup<'_>,
        k: usize,
        problem: &Problem,
    ) -> Result<Option<(Trial, Vec<Plan>)>, SuiteError> {
        let base = &self.scenario.problem;
        let mut trial = Trial { series: self.number, problem: k, attempts: Vec::new() };
        let mut plans = Vec::new();
        let mut start = base.start.clone();
        let goals: Vec<Option<&Turn>> = match problem.goals.is_empty() {
            true => vec![None],
            false => problem.goals.iter().map(Some).collect(),
        };
        for (step, turn) in goals.into_iter().enumerate() {
            let task = match turn {
                None => base.clone(),
                Some(turn) => task(base, start.clone(), turn)?,
            };
            let Some((attempt, plan)) = self.attempt(setup, &task, problem.seed + step as u64)? else {
                return Ok(None);
            };
            trial.attempts.push(attempt);
            let Some(plan) = plan else { break };
            if let Some(end) = plan.segments.last().and_then(|segment| segment.states.last()) {
                start = start_at(&configuration(end)?);
            }
            plans.push(plan);
        }
        Ok(Some((trial, plans)))
    }

    /// One plan; `None` where it was stopped.
    fn attempt(
        &self,
        setup: &Setup<'_>,
        task: &Task,
        seed: u64,
    ) -> Result<Option<(Attempt, Option<Plan>)>, SuiteError> {
        let options = RunOptions {
            seed,
            threads: 1,
            stop: self.options.stop,
            clock: self.options.clock,
            progress: &Silent,
        };
        let run = setup.run_problem(task, &regrasp_planner::solve, &options)?;
        if run.outcome.status == Status::Interrupted {
            return Ok(None);
        }
        let solved = run.outcome.status == Status::Solved && run.is_verified();
        let statistics = &run.outcome.statistics;
        let mut attempt = Attempt {
            solved,
            planning_s: run.planning_s,
            generated: statistics.generated_nodes,
            regrasps: if solved { statistics.regrasps } else { 0 },
            replayed: None,
        };
        let plan = run.plan.filter(|_| solved);
        if let (Some(judge), Some(plan)) = (self.options.judge, &plan) {
            let failed = |why| SuiteError::Replay { series: self.series.name.clone(), why };
            attempt.replayed = Some(judge(plan).map_err(failed)?);
        }
        Ok(Some((attempt, plan)))
    }
}

fn at(problems: &[Problem], k: usize) -> Option<(usize, &Problem)> {
    problems.get(k).map(|problem| (k, problem))
}

/// The problem of a turn from the scenario's start, begun in another start.
fn task(base: &Task, start: StartDescription, turn: &Turn) -> Result<Task, SuiteError> {
    // The scenario was checked: its start is a pose.
    let first = base.start.pose.pose().unwrap_or_else(|_| Pose::identity());
    let [w, x, y, z] = turn.orientation;
    let rotation = Rotation::new_normalize(nalgebra::Quaternion::new(w, x, y, z)) * first.rotation;
    let position = first.translation.vector + Vec3::from(turn.displacement);
    let goal = PoseDescription::from(&Pose::from_parts(position.into(), rotation));
    Ok(Task { start, goal: vec![GoalDescription { pose: goal, grasp: None }], ..base.clone() })
}
