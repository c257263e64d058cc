//! The problems of a series: a pure function of its file.

use crate::group::cube;
use crate::{Problems, Series};
use regrasp_api::{Random, Rotation, Vec3};
use serde::Serialize;

/// The kind of the random streams.
const STREAM: u64 = 0x7375_6974_6573;

/// A goal beside the start: the object turned about an axis of the hand's frame, and displaced.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Turn {
    /// The turn as a quaternion w, x, y, z, from the start's orientation.
    pub orientation: [f64; 4],
    /// The displacement from the start's position (m).
    pub displacement: [f64; 3],
}

impl Turn {
    fn new(turn: &Rotation, displacement: Vec3) -> Self {
        let q = turn.quaternion();
        Self { orientation: [q.w, q.i, q.j, q.k], displacement: displacement.into() }
    }
}

/// One trial of a series.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Problem {
    /// The seed that it is planned with.
    pub seed: u64,
    /// Its goals; none where the scenario's own are meant. In a chain each is tried from where the one before
    /// has ended.
    pub goals: Vec<Turn>,
}

/// The problems of a series, always the same.
pub fn problems(series: &Series) -> Vec<Problem> {
    match &series.problems {
        Problems::Scenario { seeds } => {
            (0..*seeds as u64).map(|seed| Problem { seed, goals: Vec::new() }).collect()
        }
        Problems::CubeGroup { seeds } => {
            let one = |(turn, seed): (Rotation, usize)| Problem {
                seed: seed as u64,
                goals: vec![Turn::new(&turn, Vec3::zeros())],
            };
            cube().into_iter().flat_map(|turn| (0..*seeds).map(move |seed| (turn, seed))).map(one).collect()
        }
        Problems::Random { count, angle_deg, displacement } => {
            let one = |k: u64| {
                let mut random = Random::from_key(0, STREAM, k, 0);
                let turn = turn(&mut random, *angle_deg);
                let [low, high] = *displacement;
                let displaced = random.direction() * random.range(low, high);
                Problem { seed: k, goals: vec![Turn::new(&turn, displaced)] }
            };
            (0..*count as u64).map(one).collect()
        }
        Problems::Consecutive { trials, most, apart_deg, .. } => {
            let one = |trial: u64| {
                let mut random = Random::from_key(0, STREAM, trial, 1);
                let mut before = Rotation::identity();
                let goals = (0..*most).map(|_| {
                    before = apart(&mut random, &before, apart_deg.to_radians());
                    Turn::new(&before, Vec3::zeros())
                });
                Problem { seed: trial, goals: goals.collect() }
            };
            (0..*trials as u64).map(one).collect()
        }
        Problems::Continuing { trials, most, axis, step_deg } => {
            let goals: Vec<Turn> = (1..=*most).map(|k| about(*axis, *step_deg * k as f64)).collect();
            (0..*trials as u64).map(|seed| Problem { seed, goals: goals.clone() }).collect()
        }
    }
}

/// What is aimed at for one goal of a trial, one after the other until there is a plan: the goal itself, and
/// what counts as the goal.
pub(crate) fn aims(problems: &Problems, (trial, step): (u64, usize), goal: &Turn) -> Vec<Turn> {
    let Problems::Consecutive { within_deg, within, aims, .. } = problems else { return vec![*goal] };
    let mut random = Random::from_key(0, STREAM, trial, 2 + step as u64);
    let [w, x, y, z] = goal.orientation;
    let wanted = Rotation::new_normalize(nalgebra::Quaternion::new(w, x, y, z));
    let near = |_| {
        let turn = turn(&mut random, Some([0.0, *within_deg])) * wanted;
        let displaced = random.direction() * random.range(0.0, *within);
        Turn::new(&turn, Vec3::from(goal.displacement) + displaced)
    };
    [*goal].into_iter().chain((1..*aims).map(near)).collect()
}

/// An orientation, uniform over those at least so far (rad) from another.
fn apart(random: &mut Random, from: &Rotation, least: f64) -> Rotation {
    loop {
        let turn = random.rotation();
        if turn.angle_to(from) >= least {
            return turn;
        }
    }
}

/// A turn about a random axis; uniform over all where no angles are given.
fn turn(random: &mut Random, angle_deg: Option<[f64; 2]>) -> Rotation {
    let Some([low, high]) = angle_deg else { return random.rotation() };
    let axis = nalgebra::Unit::new_normalize(random.direction());
    Rotation::from_axis_angle(&axis, random.range(low, high).to_radians())
}

fn about(axis: [f64; 3], angle_deg: f64) -> Turn {
    let turn = match nalgebra::Unit::try_new(Vec3::from(axis), 1e-9) {
        Some(axis) => Rotation::from_axis_angle(&axis, angle_deg.to_radians()),
        None => Rotation::identity(),
    };
    Turn::new(&turn, Vec3::zeros())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::consecutive;

    fn series(problems: Problems) -> Series {
        Series {
            name: "s".into(),
            scenario: "sphere".into(),
            preset: None,
            max_nodes: None,
            problems,
            published: Vec::new(),
        }
    }

    #[test]
    fn problems_are_always_the_same_and_within_what_was_asked_for() {
        let asked = series(Problems::Random {
            count: 200,
            angle_deg: Some([30.0, 90.0]),
            displacement: [0.01, 0.03],
        });
        let made = problems(&asked);
        assert_eq!(made, problems(&asked));
        assert_eq!(made.len(), 200);
        for problem in &made {
            let [w, ..] = problem.goals[0].orientation;
            let angle = 2.0 * w.abs().acos().to_degrees();
            assert!((30.0 - 1e-9..=90.0 + 1e-9).contains(&angle));
            let far = Vec3::from(problem.goals[0].displacement).norm();
            assert!((0.01 - 1e-12..=0.03 + 1e-12).contains(&far));
        }
    }

    #[test]
    fn fewer_trials_are_the_first_of_more() {
        let few = problems(&series(consecutive(2, 5)));
        let more = problems(&series(consecutive(4, 5)));
        assert_eq!(few, more[..2]);
        assert_ne!(more[0].goals, more[1].goals);
    }

    #[test]
    fn a_turn_that_goes_on_comes_round() {
        let made = problems(&series(Problems::Continuing {
            trials: 1,
            most: 4,
            axis: [0.0, 0.0, 2.0],
            step_deg: 90.0,
        }));
        let [w, _, _, z] = made[0].goals[3].orientation;
        assert!(w.abs() > 1.0 - 1e-12 && z.abs() < 1e-12);
        assert_eq!(problems(&series(Problems::CubeGroup { seeds: 2 })).len(), 46);
    }

    fn rotation(turn: &Turn) -> Rotation {
        let [w, x, y, z] = turn.orientation;
        Rotation::new_normalize(nalgebra::Quaternion::new(w, x, y, z))
    }

    #[test]
    fn goals_in_turn_are_apart_and_aims_count_as_their_goal() {
        let asked = Problems::Consecutive {
            trials: 3,
            most: 40,
            apart_deg: 90.0,
            within_deg: 20.0,
            within: 0.01,
            aims: 5,
        };
        for (trial, problem) in problems(&series(asked.clone())).iter().enumerate() {
            let mut before = Rotation::identity();
            for (step, goal) in problem.goals.iter().enumerate() {
                assert!(rotation(goal).angle_to(&before) >= 90_f64.to_radians());
                before = rotation(goal);
                let all = aims(&asked, (trial as u64, step), goal);
                assert_eq!((all.len(), all[0]), (5, *goal));
                for aim in &all {
                    assert!(rotation(aim).angle_to(&before) <= 20_f64.to_radians() + 1e-9);
                    assert!(Vec3::from(aim.displacement).norm() <= 0.01);
                }
                assert_ne!(all[1], all[2]);
            }
        }
        let goal = &problems(&series(consecutive(1, 1)))[0].goals[0];
        assert_eq!(aims(&consecutive(1, 1), (0, 0), goal), [*goal]);
    }
}
