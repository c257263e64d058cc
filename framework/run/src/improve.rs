//! Better plans, any time: after the first verified plan other searches, and the best plan of all.

use crate::{Run, RunError, RunOptions, Setup, Stop};
use regrasp_api::{Interrupt, Random};
use regrasp_plan::{Motion, StoppedBy};
use regrasp_planner::{Clock, Outcome, PlanError, Request, Status};
use serde::{Deserialize, Serialize};
use std::thread;

/// Tells the seeds of further searches from those of anything else.
const SEEDS: u64 = 0x696d_7072_6f76_6564;

/// What makes one plan better than another; of two that are alike in it, the one of shorter duration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// Fewer regrasps.
    #[default]
    Regrasps,
    /// A shorter motion (s).
    Duration,
    /// Less friction at which every grasp still bears what it must (`certificate.holds`; no unit).
    Holds,
    /// Less travel of the joints, summed over all of them (rad; m where prismatic).
    Travel,
}

impl Objective {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Regrasps => "regrasps",
            Self::Duration => "duration",
            Self::Holds => "holds",
            Self::Travel => "travel",
        }
    }

    /// What a run's plan costs, the less the better; infinite where the plan lacks the figure.
    pub fn cost(self, run: &Run) -> f64 {
        match self {
            Self::Holds => {
                let certificate = run.plan.as_ref().and_then(|plan| plan.certificate.as_ref());
                let holds = certificate.and_then(|certificate| certificate.holds.as_ref());
                holds.map_or(f64::INFINITY, |holds| holds.friction.value)
            }
            _ => self.cost_unverified(&run.outcome),
        }
    }

    /// The same of an outcome that the verifier has not seen; for what the verifier finds out, the least that
    /// can be.
    fn cost_unverified(self, outcome: &Outcome) -> f64 {
        match self {
            Self::Regrasps => outcome.statistics.regrasps as f64,
            Self::Duration => duration(&outcome.motion),
            Self::Holds => 0.0,
            Self::Travel => travel(&outcome.motion),
        }
    }
}

/// How long to go on after the first plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// So many further searches: the result does not depend on the clock.
    Searches(u64),
    /// So many seconds.
    Seconds(f64),
}

/// A plan that was better than all before it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Better {
    /// The search that found it: 0 is the first plan's.
    pub search: u64,
    /// Its seed: a run with it finds the same plan at once.
    pub seed: u64,
    /// When it was there, from the run's begin (s).
    pub time_s: f64,
    /// What it costs.
    pub cost: f64,
}

/// The best run, and how it was come by.
pub struct Improved {
    /// The run of the best plan; where there was no plan to improve, the first run.
    pub run: Run,
    /// How.
    pub course: Course,
}

/// The course of an improvement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// What was to become less.
    pub objective: Objective,
    /// The plans that were better than all before, the first plan first; empty where there was none.
    pub curve: Vec<Better>,
    /// Searches after the first that were brought to an end.
    pub searches: u64,
    /// What ended them before their number was full; absent also where seconds were asked for and are over.
    pub stopped_by: Option<StoppedBy>,
}

impl Setup<'_> {
    /// Plans and verifies, then goes on: other searches, each with a seed of its own. The same seed and
    /// number of searches give the same plan, on any number of threads.
    pub fn improve(
        &self,
        objective: Objective,
        extent: Extent,
        options: &RunOptions<'_>,
    ) -> Result<Improved, RunError> {
        let begin = options.clock.seconds();
        let run = self.run(options)?;
        let course = Course { objective, curve: Vec::new(), searches: 0, stopped_by: None };
        let mut best = Best { run, course };
        if best.run.outcome.status != Status::Solved || !best.run.is_verified() {
            return Ok(Improved { run: best.run, course: best.course });
        }
        best.note(0, options.seed, options.clock.seconds() - begin);
        let deadline = match extent {
            Extent::Seconds(seconds) => options.clock.seconds() + seconds,
            Extent::Searches(_) => f64::INFINITY,
        };
        let until = Until { stop: options.stop, clock: options.clock, deadline };
        let most = if let Extent::Searches(most) = extent { most } else { u64::MAX };
        while best.course.searches < most && !until.interrupted() {
            let done = best.course.searches;
            let count = (options.threads as u64).max(1).min(most - done);
            let options = RunOptions { stop: &until, threads: 1, ..*options };
            for found in self.searches(&best, done + 1..done + 1 + count, &options) {
                let (search, seed, run) = found?;
                if run.outcome.status == Status::Interrupted {
                    break;
                }
                best.course.searches += 1;
                best.offer(run, search, seed, options.clock.seconds() - begin);
            }
        }
        let Best { run, mut course } = best;
        let is_cut_short = course.searches < most && options.stop.interrupted();
        course.stopped_by = is_cut_short.then(|| options.stop.cause());
        Ok(Improved { run, course })
    }

    /// The searches with these numbers, side by side, in their order.
    fn searches(
        &self,
        best: &Best,
        numbers: std::ops::Range<u64>,
        options: &RunOptions<'_>,
    ) -> Vec<Result<(u64, u64, Run), RunError>> {
        let one = |search: u64| {
            let seed = Random::from_key(options.seed, SEEDS, search, 0).word();
            let options = RunOptions { seed, ..*options };
            let run = self.run_by(&|request: &Request<'_>| best.worth_verifying(request), &options)?;
            Ok((search, seed, run))
        };
        if numbers.end - numbers.start == 1 {
            return numbers.map(one).collect();
        }
        thread::scope(|scope| {
            let one = &one;
            let begun: Vec<_> = numbers.map(|search| scope.spawn(move || one(search))).collect();
            // A panic goes on where it would have gone on one thread.
            let join = |handle: thread::ScopedJoinHandle<'_, _>| {
                handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            begun.into_iter().map(join).collect()
        })
    }
}

/// The best run so far.
struct Best {
    run: Run,
    course: Course,
}

impl Best {
    /// Plans; what is no better than the best is handed back as no plan, for the verifier costs as much as
    /// the search.
    fn worth_verifying(&self, request: &Request<'_>) -> Result<Outcome, PlanError> {
        let mut outcome = regrasp_planner::solve(request)?;
        let figures = (self.course.objective.cost_unverified(&outcome), duration(&outcome.motion));
        if outcome.status != Status::Solved || !is_less(figures, self.figures()) {
            outcome.goal_ends.clear();
        }
        Ok(outcome)
    }

    /// Takes a run in the place of the best one if its plan is verified and better.
    fn offer(&mut self, run: Run, search: u64, seed: u64, time_s: f64) {
        let figures = (self.course.objective.cost(&run), duration(&run.outcome.motion));
        let is_whole = run.outcome.status == Status::Solved && run.plan.is_some() && run.is_verified();
        if is_whole && is_less(figures, self.figures()) {
            self.run = run;
            self.note(search, seed, time_s);
        }
    }

    fn figures(&self) -> (f64, f64) {
        (self.course.objective.cost(&self.run), duration(&self.run.outcome.motion))
    }

    fn note(&mut self, search: u64, seed: u64, time_s: f64) {
        self.course.curve.push(Better { search, seed, time_s, cost: self.course.objective.cost(&self.run) });
    }
}

fn is_less(a: (f64, f64), b: (f64, f64)) -> bool {
    a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).is_lt()
}

/// Duration of a motion (s).
fn duration(motion: &Motion) -> f64 {
    motion.segments.last().and_then(|segment| segment.times.last().copied()).unwrap_or(0.0)
}

/// Travel of all joints in a motion (rad; m where prismatic).
fn travel(motion: &Motion) -> f64 {
    let pairs = motion.segments.iter().flat_map(|segment| segment.states.windows(2));
    let joints = pairs.flat_map(|pair| pair[0].joints.iter().map(|(finger, a)| (a, &pair[1].joints[finger])));
    joints.map(|(a, b)| a.iter().zip(b.iter()).map(|(a, b)| (a - b).abs()).sum::<f64>()).sum()
}

/// Stops at a deadline, too.
struct Until<'a> {
    stop: &'a dyn Stop,
    clock: &'a dyn Clock,
    deadline: f64,
}

impl Interrupt for Until<'_> {
    fn interrupted(&self) -> bool {
        self.stop.interrupted() || self.clock.seconds() >= self.deadline
    }
}

impl Stop for Until<'_> {
    fn cause(&self) -> StoppedBy {
        if self.stop.interrupted() { self.stop.cause() } else { StoppedBy::TimeLimit }
    }
}
