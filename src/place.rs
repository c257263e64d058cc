//! Where an object is put so that it can be planned with: places that look good, tried by planning.

use crate::Failure;
use regrasp::Stopwatch;
use regrasp::api::{Problem, Vec3};
use regrasp::host::Registry;
use regrasp::planner::{self, Status};
use regrasp::run::scenario::Scenario;
use regrasp::run::{Run, Setup, scenario};
use regrasp::world::ObjectPlace;
use std::path::Path;
use std::time::Duration;

/// Places that are tried.
const TRIES: usize = 12;
/// How far (m) they lie from each other.
const APART: f64 = 8e-3;
/// How long one of them may take, in the first round and in the second: most places that are any good are
/// planned at once, and the others hold everything up.
const ROUNDS: [Duration; 2] = [Duration::from_millis(250), Duration::from_millis(1000)];
/// How long the plan that was found may take when it is made again as it will be by `regrasp plan`.
const AGAIN: Duration = Duration::from_millis(3000);

/// The first text that is planned, of those that `text` makes for each place, the best place first. `name` is
/// what messages call the scenario; `folder` is where its files are.
pub fn that_plans(
    (name, folder): (&str, &Path),
    registry: &Registry,
    places: &[ObjectPlace],
    text: impl Fn(Vec3) -> String,
) -> Result<Option<String>, Failure> {
    let read = |place| scenario::from_text(name, &text(place), folder, registry).map_err(Failure::refused);
    let places = spread(places);
    let Some(&first) = places.first() else { return Ok(None) };
    // Hand, object and plugins are made once; at each place only the object's poses are others.
    let moved = read(first)?;
    let Ok(setup) = Setup::without_ends(&moved, &moved.choices, registry) else { return Ok(None) };
    let tries = places.into_iter().map(|place| (place, shifted(&moved, place - first)));
    let tries: Vec<_> = tries.filter(|(_, problem)| is_free(&setup, problem)).collect();
    for (limit, (place, problem)) in ROUNDS.iter().flat_map(|limit| tries.iter().map(move |one| (limit, one)))
    {
        let options = Stopwatch::limited(*limit);
        if !setup.run_problem(problem, &planner::solve, &options.options(0)).is_ok_and(is_solved) {
            continue;
        }
        let scenario = read(*place)?;
        let Ok(setup) = Setup::new(&scenario, &scenario.choices, registry) else { continue };
        if setup.run(&Stopwatch::limited(AGAIN).options(0)).is_ok_and(is_solved) {
            return Ok(Some(text(*place)));
        }
    }
    Ok(None)
}

fn is_solved(run: Run) -> bool {
    run.outcome.status == Status::Solved && run.is_verified()
}

/// The problem with start and goals elsewhere.
fn shifted(scenario: &Scenario, by: Vec3) -> Problem {
    let mut problem = scenario.problem.clone();
    let goals = problem.goal.iter_mut().map(|goal| &mut goal.pose);
    for pose in std::iter::once(&mut problem.start.pose).chain(goals) {
        pose.position = (Vec3::from(pose.position) + by).into();
    }
    problem
}

/// Whether nothing stands in the object's way at the start and at the goals.
fn is_free(setup: &Setup<'_>, problem: &Problem) -> bool {
    let goals = problem.goal.iter().map(|goal| &goal.pose);
    std::iter::once(&problem.start.pose)
        .chain(goals)
        .all(|pose| pose.pose().is_ok_and(|X_HO| setup.check_pose("start.pose", &X_HO).is_ok()))
}

/// A few of the places that lie apart from each other.
fn spread(places: &[ObjectPlace]) -> Vec<Vec3> {
    let mut kept: Vec<Vec3> = Vec::new();
    for place in places {
        if kept.len() < TRIES && kept.iter().all(|other| (other - place.p_HO).norm() > APART) {
            kept.push(place.p_HO);
        }
    }
    kept
}
