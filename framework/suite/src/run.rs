//! Planning, verifying and replaying the problems of a protocol.

use crate::library::Files;
use crate::problem::aims;
use crate::{Attempt, Problem, Protocol, Replayed, Series, SuiteError, Trial, Turn, Unreplayable, problems};
use regrasp_api::{
    GoalDescription, Pose, PoseDescription, Problem as Task, Rotation, StartDescription, Vec3,
};
use regrasp_host::Registry;
use regrasp_plan::{Plan, configuration};
use regrasp_planner::{Clock, Silent, Status};
use regrasp_run::scenario::Scenario;
use regrasp_run::{RunOptions, Setup, Stop, start_at};
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

/// Replays a plan; why it cannot be replayed where it cannot.
pub type Judge<'a> = &'a (dyn Fn(&Plan) -> Result<Replayed, Unreplayable> + Sync);

/// Told of every trial that has ended, with its plans; may end the run.
pub type Told<'a> = &'a (dyn Fn(&Trial, &[Plan]) -> ControlFlow<()> + Sync);

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

/// Runs every trial of a protocol but those that are `known`, in the order of its series; all trials, or
/// those so far where it was stopped.
///
/// `scenarios` are those of [`scenarios`].
pub fn run(
    protocol: &Protocol,
    scenarios: &[Scenario],
    registry: &Registry,
    known: Vec<Trial>,
    options: &Options<'_>,
) -> Result<Vec<Trial>, SuiteError> {
    let (mut trials, ended) = (known, AtomicBool::new(false));
    for (number, (series, scenario)) in protocol.series.iter().zip(scenarios).enumerate() {
        let job = Job { number, series, scenario, registry, options, ended: &ended };
        let is_known = |k: usize| trials.iter().any(|t| (t.series, t.problem) == (number, k));
        let all = problems(series).into_iter().enumerate();
        let open: Vec<(usize, Problem)> = all.filter(|(k, _)| !is_known(*k)).collect();
        trials.extend(job.trials(&open)?);
        if ended.load(Ordering::Relaxed) || options.stop.interrupted() {
            break;
        }
    }
    trials.sort_by_key(|trial| (trial.series, trial.problem));
    trials.dedup_by_key(|trial| (trial.series, trial.problem));
    Ok(trials)
}

/// The scenario of each series, with its preset and its budget.
pub fn scenarios(
    protocol: &Protocol,
    files: &Files,
    registry: &Registry,
) -> Result<Vec<Scenario>, SuiteError> {
    let scenario = |series: &Series| {
        let mut scenario = files.scenario(&series.scenario, registry)?;
        if let Some(name) = &series.preset {
            let preset = regrasp_host::preset(name)
                .map_err(|error| SuiteError::Preset { series: series.name.clone(), error: error.into() })?;
            preset.apply(&mut scenario.choices);
        }
        if let Some(most) = series.max_nodes {
            scenario.problem.limits.budget.max_nodes = most;
        }
        Ok(scenario)
    };
    protocol.series.iter().map(scenario).collect()
}

/// A series at work.
struct Job<'a> {
    number: usize,
    series: &'a Series,
    scenario: &'a Scenario,
    registry: &'a Registry,
    options: &'a Options<'a>,
    /// Whether who is told of trials wants no more.
    ended: &'a AtomicBool,
}

impl Job<'_> {
    /// Its trials, on threads, in their order.
    fn trials(&self, problems: &[(usize, Problem)]) -> Result<Vec<Trial>, SuiteError> {
        let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
        let work = || -> Result<(), SuiteError> {
            let setup = Setup::new(self.scenario, &self.scenario.choices, self.registry)?;
            while let Some((k, problem)) = problems.get(next.fetch_add(1, Ordering::Relaxed)) {
                if self.ended.load(Ordering::Relaxed) {
                    return Ok(());
                }
                let Some((trial, plans)) = self.trial(&setup, *k, problem)? else { return Ok(()) };
                if (self.options.told)(&trial, &plans).is_break() {
                    self.ended.store(true, Ordering::Relaxed);
                }
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
        Ok(done.into_inner().unwrap_or_default())
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
            let aims = turn.map_or(Vec::new(), |turn| aims(&self.series.problems, (k as u64, step), turn));
            let tasks: Vec<Task> = match turn {
                None => vec![base.clone()],
                Some(_) => {
                    aims.iter().map(|turn| task(base, start.clone(), turn)).collect::<Result<_, _>>()?
                }
            };
            let Some((attempt, plan)) = self.any(setup, &tasks, problem.seed + step as u64)? else {
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

    /// A plan to the first of some goals to which there is one; time and nodes are those of all that were
    /// tried. `None` where it was stopped.
    fn any(
        &self,
        setup: &Setup<'_>,
        tasks: &[Task],
        seed: u64,
    ) -> Result<Option<(Attempt, Option<Plan>)>, SuiteError> {
        let mut so_far: Option<Attempt> = None;
        for task in tasks {
            let Some((mut attempt, plan)) = self.attempt(setup, task, seed)? else { return Ok(None) };
            if let Some(before) = &so_far {
                attempt.planning_s += before.planning_s;
                attempt.generated += before.generated;
            }
            if plan.is_some() {
                return Ok(Some((attempt, plan)));
            }
            so_far = Some(attempt);
        }
        Ok(so_far.map(|attempt| (attempt, None)))
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
            unreplayable: None,
        };
        let plan = run.plan.filter(|_| solved);
        if let (Some(judge), Some(plan)) = (self.options.judge, &plan) {
            match judge(plan) {
                Ok(replayed) => attempt.replayed = Some(replayed),
                Err(why) => attempt.unreplayable = Some(why),
            }
        }
        Ok(Some((attempt, plan)))
    }
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
