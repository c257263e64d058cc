//! What came of a series.

use crate::{Attempt, Problems, Series, Trial, Unreplayable};
use regrasp_study::compare::statistics::{Estimate, median, quantile, sorted, wilson};
use serde::Serialize;

/// Mean and standard deviation of a count for each trial of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation (with n - 1); 0 of one trial.
    pub deviation: f64,
}

impl Spread {
    fn of(counts: &[f64]) -> Option<Self> {
        let n = counts.len() as f64;
        if counts.is_empty() {
            return None;
        }
        let mean = counts.iter().sum::<f64>() / n;
        let squares: f64 = counts.iter().map(|count| (count - mean).powi(2)).sum();
        Some(Self { mean, deviation: (squares / (n - 1.0).max(1.0)).sqrt() })
    }

    fn times(self, factor: f64) -> Self {
        Self { mean: factor * self.mean, deviation: factor * self.deviation }
    }
}

/// What came of a series.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// The series.
    pub series: String,
    /// Trials.
    pub trials: usize,
    /// Plans that were asked for.
    pub plans: usize,
    /// Plans that were found and verified.
    pub solved: usize,
    /// Their share with its interval of 95 % (Wilson's score). In a chain the plans of a trial are not
    /// independent, and the interval is too narrow.
    pub share: Option<Estimate>,
    /// Of all plans that were asked for, those whose replay arrives; absent where nobody replays.
    pub arrived: Option<usize>,
    /// Their share with its interval.
    pub arrived_share: Option<Estimate>,
    /// Why plans cannot be replayed, the first reason; absent where all can, or nobody replays.
    pub unreplayable: Option<Unreplayable>,
    /// Time for planning alone (s): median, 90 % quantile and longest, of all plans, solved or not.
    pub planning_s: Option<[f64; 3]>,
    /// Generated nodes, median.
    pub generated: Option<f64>,
    /// Regrasps of the plans, median.
    pub regrasps: Option<f64>,
    /// Where objects are in the end of replays: distance (m), median and largest.
    pub distance: Option<[f64; 2]>,
    /// And by how much they are turned (rad), median and largest.
    pub angle: Option<[f64; 2]>,
    /// In a chain: goals in turn.
    pub chain: Option<Spread>,
    /// In a chain: goals in turn whose replays arrive.
    pub arrived_chain: Option<Spread>,
    /// In a chain: the share of trials that came to the last goal, with its interval.
    pub whole: Option<Estimate>,
    /// In a chain of turns about one axis: revolutions.
    pub revolutions: Option<Spread>,
}

impl Outcome {
    /// Of the trials of a series.
    pub fn of(series: &Series, trials: &[&Trial]) -> Self {
        let attempts: Vec<&Attempt> = trials.iter().flat_map(|trial| &trial.attempts).collect();
        let solved = attempts.iter().filter(|attempt| attempt.solved).count();
        let replays: Vec<_> = attempts.iter().filter_map(|attempt| attempt.replayed).collect();
        let is_replayed = !replays.is_empty();
        let arrived = is_replayed.then(|| replays.iter().filter(|replayed| replayed.arrived).count());
        let times = sorted(attempts.iter().map(|attempt| attempt.planning_s));
        let ends = |values: Vec<f64>| {
            let values = sorted(values);
            quantile(&values, 0.5).zip(quantile(&values, 1.0)).map(<[f64; 2]>::from)
        };
        let of_solved = attempts.iter().filter(|attempt| attempt.solved);
        let chain = chain(series, trials);
        let step = match series.problems {
            Problems::Continuing { step_deg, .. } => Some(step_deg / 360.0),
            _ => None,
        };
        Self {
            series: series.name.clone(),
            trials: trials.len(),
            plans: attempts.len(),
            solved,
            share: wilson(solved, attempts.len()),
            arrived,
            unreplayable: attempts.iter().find_map(|attempt| attempt.unreplayable.clone()),
            arrived_share: arrived.and_then(|arrived| wilson(arrived, attempts.len())),
            planning_s: quantile(&times, 0.5)
                .and_then(|median| Some([median, quantile(&times, 0.9)?, quantile(&times, 1.0)?])),
            generated: median(attempts.iter().map(|attempt| attempt.generated as f64)),
            regrasps: median(of_solved.map(|attempt| attempt.regrasps as f64)),
            distance: ends(replays.iter().map(|replayed| replayed.distance).collect()),
            angle: ends(replays.iter().map(|replayed| replayed.angle).collect()),
            chain: chain.as_ref().and_then(|chain| chain.reached),
            arrived_chain: chain.as_ref().and_then(|chain| chain.arrived),
            whole: chain.as_ref().and_then(|chain| wilson(chain.whole, trials.len())),
            revolutions: chain.as_ref().and_then(|chain| Some(chain.reached?.times(step?))),
        }
    }
}

/// Goals in turn.
struct Chain {
    reached: Option<Spread>,
    arrived: Option<Spread>,
    whole: usize,
}

fn chain(series: &Series, trials: &[&Trial]) -> Option<Chain> {
    let (Problems::Consecutive { most, .. } | Problems::Continuing { most, .. }) = series.problems else {
        return None;
    };
    let reached: Vec<f64> = trials.iter().map(|trial| trial.reached() as f64).collect();
    let arrived: Option<Vec<f64>> = trials.iter().map(|trial| trial.arrived().map(|n| n as f64)).collect();
    let whole = trials.iter().filter(|trial| trial.reached() == most).count();
    Some(Chain {
        reached: Spread::of(&reached),
        arrived: arrived.and_then(|arrived| Spread::of(&arrived)),
        whole,
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{Published, Replayed, World};

    pub fn series(problems: Problems) -> Series {
        let published = Published {
            what: "goals in turn".into(),
            figure: "21.3 ± 14.8".into(),
            world: World::Real,
            method: "sampling-based control | real LEAP hand".into(),
        };
        Series {
            name: "cube".into(),
            scenario: "cubic".into(),
            preset: None,
            max_nodes: None,
            problems,
            published: vec![published],
        }
    }

    pub fn attempt(solved: bool, arrived: Option<bool>) -> Attempt {
        let replayed = arrived.map(|arrived| Replayed { arrived, distance: 1e-3, angle: 0.02 });
        Attempt { solved, planning_s: 0.01, generated: 3, regrasps: 4, replayed, unreplayable: None }
    }

    #[test]
    fn chains_count_goals_in_turn() {
        let series =
            series(Problems::Continuing { trials: 2, most: 3, axis: [0.0, 0.0, 1.0], step_deg: 90.0 });
        let whole = Trial { attempts: vec![attempt(true, Some(true)); 3], ..Trial::default() };
        let short =
            Trial { attempts: vec![attempt(true, Some(false)), attempt(false, None)], ..whole.clone() };
        let outcome = Outcome::of(&series, &[&whole, &short]);
        assert_eq!(outcome.chain, Some(Spread { mean: 2.0, deviation: 2.0_f64.sqrt() }));
        assert_eq!(outcome.arrived_chain.map(|spread| spread.mean), Some(1.5));
        assert_eq!(outcome.revolutions.map(|spread| spread.mean), Some(0.5));
        assert_eq!(outcome.whole.map(|share| share.value), Some(0.5));
        assert_eq!((outcome.plans, outcome.solved, outcome.arrived), (5, 4, Some(3)));
    }

    #[test]
    fn what_cannot_be_replayed_says_why() {
        let series = series(Problems::Scenario { seeds: 1 });
        let why = Unreplayable("points stay where they are set down".into());
        let attempt = Attempt { unreplayable: Some(why.clone()), ..attempt(true, None) };
        let trial = Trial { attempts: vec![attempt], ..Trial::default() };
        let outcome = Outcome::of(&series, &[&trial]);
        assert_eq!((outcome.solved, outcome.arrived, outcome.unreplayable), (1, None, Some(why)));
    }

    #[test]
    fn without_replays_nothing_is_said_of_them() {
        let series = series(Problems::Scenario { seeds: 2 });
        let trial = |solved| Trial { attempts: vec![attempt(solved, None)], ..Trial::default() };
        let outcome = Outcome::of(&series, &[&trial(true), &trial(false)]);
        assert_eq!((outcome.arrived, outcome.chain, outcome.regrasps), (None, None, Some(4.0)));
        assert_eq!(outcome.share.map(|share| share.value), Some(0.5));
    }
}
