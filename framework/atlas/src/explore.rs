//! The work: start grasps, goals, plans.

use crate::starts::Starts;
use crate::{AtlasError, AtlasHand, Attempt, Cell, Found, Member, Wish};
use regrasp_api::{Configuration, GoalDescription, Pose, PoseDescription, Problem, Random, Refuse, Vec3};
use regrasp_host::Registry;
use regrasp_planner::{Clock, Silent, Status, Stuck};
use regrasp_run::scenario::{Scenario, from_text};
use regrasp_run::{Run, RunOptions, Setup, Stop, start_at};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// The kind of the random streams of goals.
const GOALS: u64 = 0x6174_6c61_7367;

/// Told what was found.
pub trait Told: Send {
    /// A member is done; an error ends the work.
    fn done(&mut self, cell: &Cell) -> Result<(), AtlasError>;
}

/// How the work ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// All members are done.
    Whole,
    /// It was stopped from outside.
    Stopped,
}

/// Does every member of the family that is not among `known` (by number), on `threads` threads; what is found
/// of a member is a pure function of wish, hand and member.
pub fn explore(
    wish: &Wish,
    hands: &[AtlasHand],
    known: &[usize],
    registry: &Registry,
    (threads, stop, clock): (usize, &dyn Stop, &(dyn Clock + Sync)),
    told: &mut dyn Told,
) -> Result<Ended, AtlasError> {
    wish.validate()?;
    let members = wish.members(hands.iter().map(|hand| hand.name.as_str()));
    let mut open: Vec<usize> = (0..members.len()).filter(|number| !known.contains(number)).collect();
    // Hands in turn: what is stopped early knows something of each.
    let of_one = members.len() / hands.len().max(1);
    open.sort_by_key(|number| (number % of_one.max(1), number / of_one.max(1)));
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let told = Mutex::new((told, None::<AtlasError>));
    let is_over = || stop.interrupted() || told.lock().is_ok_and(|told| told.1.is_some());
    let work = || {
        while let Some(&number) = open.get(next.fetch_add(1, Ordering::Relaxed)) {
            if is_over() {
                return;
            }
            let member = &members[number];
            let Some(hand) = hands.iter().find(|hand| hand.name == member.hand) else { return };
            let found = Explorer { wish, hand, member, registry, stop, clock }.cell(number);
            let Ok(mut told) = told.lock() else { return };
            match found.and_then(|cell| cell.map(|cell| told.0.done(&cell)).transpose()) {
                Ok(kept) => {
                    done.fetch_add(usize::from(kept.is_some()), Ordering::Relaxed);
                }
                Err(error) => {
                    told.1.get_or_insert(error);
                }
            }
        }
    };
    thread::scope(|scope| (0..threads.max(1)).for_each(|_| drop(scope.spawn(work))));
    match told.into_inner() {
        Ok((_, Some(error))) => Err(error),
        _ if done.into_inner() < open.len() => Ok(Ended::Stopped),
        _ => Ok(Ended::Whole),
    }
}

/// One member at work.
struct Explorer<'a> {
    wish: &'a Wish,
    hand: &'a AtlasHand,
    member: &'a Member,
    registry: &'a Registry,
    stop: &'a dyn Stop,
    clock: &'a (dyn Clock + Sync),
}

impl Explorer<'_> {
    /// Its cell; `None` where it was stopped. A member that makes no sense has a cause and no attempts.
    fn cell(&self, number: usize) -> Result<Option<Cell>, AtlasError> {
        let empty = Cell {
            number,
            member: self.member.clone(),
            grasps: 0,
            poses: 0,
            cause: None,
            attempts: Vec::new(),
        };
        let refused = |message: String| Ok(Some(Cell { cause: Some(message), ..empty.clone() }));
        let text = self.member.scenario(self.hand, self.wish.nodes);
        let scenario = match from_text(&self.member.title(), &text, Path::new(""), self.registry) {
            Ok(scenario) => scenario,
            Err(error) => return refused(error.refusal().message),
        };
        let setup = match Setup::without_ends(&scenario, &scenario.choices, self.registry) {
            Ok(setup) => setup,
            Err(error) => return refused(error.refusal().message),
        };
        let Some(starts) = Starts::draw(&setup, self.wish, self.stop)? else { return Ok(None) };
        let cell = Cell { grasps: starts.found, poses: starts.counts.poses, ..empty };
        if starts.grasps.is_empty() {
            return Ok(Some(Cell { cause: Some(starts.cause()), ..cell }));
        }
        let mut attempts = Vec::new();
        for goal in 0..self.wish.goals {
            let start = &starts.grasps[goal % starts.grasps.len()];
            match self.attempt(&setup, &scenario, start, goal)? {
                Some(attempt) => attempts.push(attempt),
                None => return Ok(None),
            }
        }
        Ok(Some(Cell { attempts, ..cell }))
    }

    /// One orientation, at one position after the other; `None` where it was stopped.
    fn attempt(
        &self,
        setup: &Setup<'_>,
        scenario: &Scenario,
        start: &Configuration,
        goal: usize,
    ) -> Result<Option<Attempt>, AtlasError> {
        // All members have the same turns: what differs between them is not luck.
        let mut random = Random::from_key(self.wish.seed, GOALS, goal as u64, 0);
        let turn = random.rotation();
        let (axis, angle) = turn.axis_angle().map_or((Vec3::z(), 0.0), |(axis, angle)| (*axis, angle));
        let p_HO = start.X_HO.translation.vector;
        let mut attempt = Attempt {
            start: p_HO.into(),
            axis: axis.into(),
            angle_deg: angle.to_degrees(),
            found: Found::NoGrasp,
            tries: 0,
            regrasps: None,
        };
        for number in 0..self.wish.tries {
            let offset = if number == 0 { Vec3::zeros() } else { in_ball(&mut random, self.wish.reach) };
            let X_HO = Pose::from_parts((p_HO + offset).into(), turn * start.X_HO.rotation);
            let problem = Problem {
                start: start_at(start),
                goal: vec![GoalDescription { pose: PoseDescription::from(&X_HO), grasp: None }],
                ..scenario.problem.clone()
            };
            let seed = Random::from_key(self.wish.seed, GOALS, goal as u64, 1 + number as u64).word();
            let options =
                RunOptions { seed, threads: 1, stop: self.stop, clock: self.clock, progress: &Silent };
            let run = setup.run_problem(&problem, &regrasp_planner::solve, &options)?;
            let Some(found) = found(&run) else { return Ok(None) };
            attempt.tries = number + 1;
            attempt.found = if number == 0 { found } else { nearer(attempt.found, found) };
            if found == Found::Reached {
                attempt.regrasps = Some(run.outcome.statistics.regrasps);
                break;
            }
        }
        Ok(Some(attempt))
    }
}

/// What a run has found; `None` where it was stopped.
fn found(run: &Run) -> Option<Found> {
    match (run.outcome.status, run.outcome.stuck) {
        (Status::Solved, _) if run.is_verified() => Some(Found::Reached),
        (Status::Solved, _) => Some(Found::Unverified),
        (Status::Interrupted, _) => None,
        (Status::NoPlan, Some(Stuck::GoalGrasp(_))) => Some(Found::NoGrasp),
        (Status::NoPlan, _) => Some(Found::NoWay),
    }
}

/// Of two tries the one that came nearer to a plan.
fn nearer(a: Found, b: Found) -> Found {
    let rank = |found: &Found| match found {
        Found::NoGrasp => 0,
        Found::NoWay => 1,
        Found::Unverified => 2,
        Found::Reached => 3,
    };
    [a, b].into_iter().max_by_key(rank).unwrap_or(a)
}

/// A point drawn uniformly from a ball about the origin.
fn in_ball(random: &mut Random, radius: f64) -> Vec3 {
    random.direction() * (radius * random.unit().cbrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_fill_the_ball_evenly() {
        let mut random = Random::from_key(1, 2, 3, 4);
        let points: Vec<Vec3> = (0..4000).map(|_| in_ball(&mut random, 2.0)).collect();
        assert!(points.iter().all(|point| point.norm() <= 2.0));
        // Half of the volume lies within 0.794 of the radius; 4000 draws stray by 1.6 % (two deviations).
        let inside = points.iter().filter(|point| point.norm() < 2.0 * 0.5_f64.cbrt()).count();
        assert!((inside as f64 / 4000.0 - 0.5).abs() < 0.03, "{inside}");
    }

    #[test]
    fn the_try_that_came_nearest_counts() {
        assert_eq!(nearer(Found::NoWay, Found::NoGrasp), Found::NoWay);
        assert_eq!(nearer(Found::Unverified, Found::Reached), Found::Reached);
    }
}
