//! `regrasp plan --goals`: many goals, each a plan of its own from the scenario's start.

use crate::args::PlanArgs;
use crate::outputs::{self, Kind};
use crate::quantity::span;
use crate::roadmap::{Known, is_by_roadmap};
use crate::terminal::remark;
use crate::{Failure, say};
use regrasp::api::{GoalDescription, Problem, Refusal, Refuse};
use regrasp::plan::StoppedBy;
use regrasp::planner::roadmap::{RoadmapGraph, Through};
use regrasp::planner::{Request, Status, solve_through};
use regrasp::run::scenario::GoalList;
use regrasp::run::{Run, RunOptions, Setup};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// A list of goals to be planned.
pub struct Job<'a> {
    pub args: &'a PlanArgs,
    pub setup: &'a Setup<'a>,
    pub options: &'a RunOptions<'a>,
    pub list: &'a Path,
}

/// Refuses an output that is no folder, and plans that would replace something else; nothing is computed yet.
pub fn check(args: &PlanArgs, inputs: &[PathBuf]) -> Result<(), Failure> {
    let Some(folder) = &args.output else { return Ok(()) };
    outputs::check_folder(folder)?;
    if folder.exists() && !folder.is_dir() {
        let message = format!("`-o {}`: with `--goals` it is a folder, and this is none", folder.display());
        return Err(Failure::bad_input(message));
    }
    let count =
        GoalList::load(args.goals.as_deref().unwrap_or(Path::new(""))).map_or(0, |list| list.goals.len());
    let plans: Vec<PathBuf> = (0..count).map(|row| place(folder, row)).filter(|path| path.exists()).collect();
    let wished: Vec<(&Path, Kind)> = plans.iter().map(|path| (path.as_path(), Kind::Plan)).collect();
    outputs::check(inputs, &wished, args.overwrite)
}

/// Plans to each goal in turn, and tells of each.
pub fn run(job: &Job<'_>, mut known: Option<&mut Known>) -> Result<(), Failure> {
    let list = GoalList::load(job.list).map_err(Failure::refused)?;
    if let Some(folder) = &job.args.output {
        let failed = |error| Failure::bad_input(format!("`{}`: {error}", folder.display()));
        fs::create_dir_all(folder).map_err(failed)?;
    }
    let (mut counts, mut row) = (Counts::default(), 0);
    while row < list.goals.len() && !job.options.stop.interrupted() {
        let taught = job.rows(&list, &mut row, known.as_deref(), &mut counts)?;
        if let (Some(run), Some(known)) = (taught, known.as_deref_mut()) {
            known.learn(job.setup, job.options, &run)?;
        }
    }
    counts.left = list.goals.len() - row;
    if let Some(known) = known {
        remark(&known.keep()?);
    }
    counts.ending(list.goals.len(), job)
}

impl Job<'_> {
    /// Plans to the goals from `row` on, up to the last, or to the first from which the roadmap is to learn:
    /// the run for that.
    fn rows(
        &self,
        list: &GoalList,
        row: &mut usize,
        known: Option<&Known>,
        counts: &mut Counts,
    ) -> Result<Option<Run>, Failure> {
        let graph = known.map(Known::graph);
        while *row < list.goals.len() && !self.options.stop.interrupted() {
            let number = *row;
            *row += 1;
            let goal = self.checked(number, &list.goals[number], list);
            match goal.and_then(|goal| self.plan(goal, graph.as_ref())) {
                Err(refusal) => {
                    counts.wrong.push(number + 1);
                    self.tell_refusal(number, &refusal)?;
                }
                Ok(run) => {
                    counts.add(number, &run);
                    self.tell(number, &run)?;
                    if self.args.roadmap_add && !is_by_roadmap(&run) {
                        return Ok(Some(run));
                    }
                }
            }
        }
        Ok(None)
    }

    /// A row that is right, and where the object may be.
    fn checked<'g>(
        &self,
        row: usize,
        goal: &'g Result<GoalDescription, impl Refuse>,
        list: &GoalList,
    ) -> Result<&'g GoalDescription, Box<Refusal>> {
        let goal = goal.as_ref().map_err(|error| Box::new(error.refusal()))?;
        let key = format!("goal[{row}].pose");
        let X_HO = goal.pose.pose().map_err(|error| Box::new(list.refuse(row, &error).refusal()))?;
        self.setup.check_pose(&key, &X_HO).map(|()| goal)
    }

    fn plan(&self, goal: &GoalDescription, graph: Option<&RoadmapGraph<'_>>) -> Result<Run, Box<Refusal>> {
        let problem = &self.setup.scenario().problem;
        let problem = Problem { goal: vec![goal.clone()], ..problem.clone() };
        let through = graph.map(|graph| Through { graph, alone: false });
        let solve = |request: &Request<'_>| match through {
            Some(through) => solve_through(request, through),
            None => regrasp::planner::solve(request),
        };
        self.setup.run_problem(&problem, &solve, self.options).map_err(|error| Box::new(error.refusal()))
    }

    /// Saves the plan where that is wished and it is complete and verified, and tells what came of a goal.
    fn tell(&self, row: usize, run: &Run) -> Result<(), Failure> {
        let done = run.outcome.status == Status::Solved && run.is_verified();
        let path = self.args.output.as_deref().filter(|_| done).map(|folder| place(folder, row));
        if let (Some(path), Some(plan)) = (&path, &run.plan) {
            regrasp::plan::write(path, plan).map_err(Failure::refused)?;
        }
        if self.args.json {
            return say(&format!("{}\n", told_json(row, run, path.as_deref())));
        }
        say(&format!("goal {}: {}\n", row + 1, told(run, path.as_deref())))
    }

    fn tell_refusal(&self, row: usize, refusal: &Refusal) -> Result<(), Failure> {
        match self.args.json {
            true => say(&format!("{}\n", json!({ "goal": row + 1, "error": refusal }))),
            false => say(&format!("goal {}: refused: {}\n", row + 1, refusal.message)),
        }
    }
}

/// What came of a goal, in words.
fn told(run: &Run, saved: Option<&Path>) -> String {
    if let Some(why) = run.why_not_solved() {
        return why;
    }
    let statistics = &run.outcome.statistics;
    let verdict = if run.is_verified() { "verified" } else { "not verified" };
    let how = match statistics.time_s.contains_key("roadmap") {
        true if is_by_roadmap(run) => ", through the roadmap",
        true => " without the roadmap, which knows no way",
        false => "",
    };
    let saved = saved.map(|path| format!(", {}", path.display())).unwrap_or_default();
    let regrasps = statistics.regrasps;
    format!("{regrasps} regrasps, planned in {}{how}, {verdict}{saved}", span(run.planning_s))
}

fn told_json(row: usize, run: &Run, saved: Option<&Path>) -> Value {
    let statistics = &run.outcome.statistics;
    json!({
        "goal": row + 1,
        "status": run.outcome.status,
        "verified": run.is_verified(),
        "by_roadmap": is_by_roadmap(run),
        "time_s": run.planning_s,
        "verification_s": run.verification_s,
        "phases_s": statistics.time_s,
        "transfers": statistics.transfers,
        "regrasps": statistics.regrasps,
        "duration_s": run.outcome.motion.segments.last().and_then(|last| last.times.last()),
        "why": run.why_not_solved(),
        "warnings": run.outcome.warnings,
        "output": saved,
    })
}

/// Where the plan of a row goes.
fn place(folder: &Path, row: usize) -> PathBuf {
    folder.join(format!("goal-{:05}.json", row + 1))
}

/// How many goals ended how; the rows that were refused.
#[derive(Default)]
struct Counts {
    solved: usize,
    unsolved: Vec<usize>,
    unverified: Vec<usize>,
    wrong: Vec<usize>,
    /// Goals that were not begun.
    left: usize,
}

impl Counts {
    fn add(&mut self, row: usize, run: &Run) {
        match (run.outcome.status, run.is_verified()) {
            (Status::Solved, true) => self.solved += 1,
            (Status::Solved, false) => self.unverified.push(row + 1),
            _ => self.unsolved.push(row + 1),
        }
    }

    /// What the exit code says: wrong rows first, for they are the user's.
    fn ending(&self, goals: usize, job: &Job<'_>) -> Result<(), Failure> {
        let solved = format!("{} of {goals} goals are solved", self.solved);
        let rows = |rows: &[usize]| rows.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        if self.left > 0 {
            let stopped = format!("stopped: {solved}, {} were not begun", self.left);
            return Err(match job.options.stop.cause() {
                StoppedBy::Interrupt => Failure::interrupted(stopped),
                _ => Failure::no_plan(stopped),
            });
        }
        if !self.wrong.is_empty() {
            let (list, wrong) = (job.list.display(), rows(&self.wrong));
            return Err(Failure::bad_input(format!("{solved}; wrong in `{list}`: goal {wrong}")));
        }
        if !self.unverified.is_empty() {
            return Err(Failure::not_verified(format!("{solved}; not verified: {}", rows(&self.unverified))));
        }
        match self.unsolved.is_empty() {
            true => Ok(()),
            false => Err(Failure::no_plan(format!("{solved}; no plan to goal {}", rows(&self.unsolved)))),
        }
    }
}
