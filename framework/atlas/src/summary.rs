//! Shares with intervals.

use crate::bins::band;
use crate::{ANGLES_DEG, Attempt, Cell, Found, Sector, Shape};
use regrasp_study::compare::statistics::{Estimate, quantile, sorted, wilson};
use serde::Serialize;
use std::collections::BTreeMap;

/// A share of attempts, with its interval of 95 % (Wilson's score).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// Attempts that reached their goal.
    pub reached: usize,
    /// All attempts.
    pub of: usize,
    /// The share and its interval; absent where there are no attempts.
    #[serde(flatten)]
    pub estimate: Option<Estimate>,
}

impl Share {
    /// Of these attempts.
    pub fn of<'a>(attempts: impl IntoIterator<Item = &'a Attempt>) -> Self {
        let (mut reached, mut of) = (0, 0);
        for attempt in attempts {
            of += 1;
            reached += usize::from(attempt.found == Found::Reached);
        }
        Self::counted(reached, of)
    }

    /// So many of so many.
    pub(crate) fn counted(reached: usize, of: usize) -> Self {
        Self { reached, of, estimate: wilson(reached, of) }
    }
}

/// What the attempts of one member come to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CellSummary {
    /// The member's number.
    pub number: usize,
    /// All attempts. Where no grasp exists it is 0 of 0.
    pub share: Share,
    /// Attempts by the bands of [`ANGLES_DEG`].
    pub by_angle: [Share; ANGLES_DEG.len() - 1],
    /// Median of the regrasps of the plans; absent where there are none.
    pub regrasps_median: Option<f64>,
    /// Their 90 % quantile.
    pub regrasps_90: Option<f64>,
    /// How the attempts ended.
    pub found: BTreeMap<Found, usize>,
}

impl CellSummary {
    fn of(cell: &Cell) -> Self {
        let attempts = &cell.attempts;
        let of_band = |k: usize| Share::of(attempts.iter().filter(|attempt| band(attempt.angle_deg) == k));
        let (median, most) = regrasps(attempts);
        let count = |found: Found| attempts.iter().filter(|attempt| attempt.found == found).count();
        Self {
            number: cell.number,
            share: Share::of(attempts),
            by_angle: std::array::from_fn(of_band),
            regrasps_median: median,
            regrasps_90: most,
            found: Found::ALL.into_iter().map(|found| (found, count(found))).collect(),
        }
    }
}

/// Median and 90 % quantile of the regrasps of plans.
fn regrasps<'a>(attempts: impl IntoIterator<Item = &'a Attempt>) -> (Option<f64>, Option<f64>) {
    let counts = attempts.into_iter().filter_map(|attempt| attempt.regrasps).map(|n| n as f64);
    let counts = sorted(counts);
    let tenths = |q: f64| quantile(&counts, q).map(|count| (count * 10.0).round() / 10.0);
    (tenths(0.5), tenths(0.9))
}

/// The turns of one hand with objects of one shape about axes of one sector, by angles of one band: of all
/// sizes, frictions and masses together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bin {
    /// The hand.
    pub hand: String,
    /// The shape.
    pub shape: Shape,
    /// The number of the band of [`ANGLES_DEG`].
    pub band: usize,
    /// Where the axes point.
    pub sector: String,
    /// The attempts.
    pub share: Share,
    #[serde(skip)]
    pub(crate) at: Sector,
}

/// All figures of an atlas.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// One entry for each cell.
    pub cells: Vec<CellSummary>,
    /// The maps.
    pub bins: Vec<Bin>,
}

impl Summary {
    /// Of these cells.
    pub fn of(cells: &[Cell]) -> Self {
        let mut groups: BTreeMap<(usize, Shape), Vec<&Cell>> = BTreeMap::new();
        let mut hands: Vec<&str> = Vec::new();
        for cell in cells {
            let hand = hands.iter().position(|hand| *hand == cell.member.hand).unwrap_or_else(|| {
                hands.push(&cell.member.hand);
                hands.len() - 1
            });
            groups.entry((hand, cell.member.shape)).or_default().push(cell);
        }
        let bins = groups.iter().flat_map(|(&(hand, shape), cells)| map(hands[hand], shape, cells)).collect();
        Self { cells: cells.iter().map(CellSummary::of).collect(), bins }
    }
}

/// The bins of one hand and shape.
fn map(hand: &str, shape: Shape, cells: &[&Cell]) -> Vec<Bin> {
    let mut bins = Vec::new();
    for band in 0..ANGLES_DEG.len() - 1 {
        for at in Sector::all() {
            let inside = |attempt: &&Attempt| {
                crate::bins::band(attempt.angle_deg) == band && Sector::of(attempt.axis) == at
            };
            let share = Share::of(cells.iter().flat_map(|cell| &cell.attempts).filter(inside));
            bins.push(Bin { hand: hand.to_owned(), shape, band, sector: at.name(), share, at });
        }
    }
    bins
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::Member;

    pub fn attempt(axis: [f64; 3], angle_deg: f64, regrasps: Option<usize>) -> Attempt {
        let found = if regrasps.is_some() { Found::Reached } else { Found::NoWay };
        Attempt { start: [0.0; 3], axis, angle_deg, found, tries: 1, regrasps }
    }

    pub fn cell(number: usize, hand: &str, size: f64, attempts: Vec<Attempt>) -> Cell {
        let member = Member { hand: hand.into(), shape: Shape::Cube, size, friction: 0.8, mass: None };
        let cause = attempts.is_empty().then(|| "no grasp in 7 poses".to_owned());
        Cell { number, member, grasps: 9, poses: 99, cause, attempts }
    }

    #[test]
    fn shares_and_regrasps_are_those_of_the_attempts() {
        let up = [0.0, 0.0, 1.0];
        let attempts = vec![
            attempt(up, 30.0, Some(2)),
            attempt(up, 100.0, Some(4)),
            attempt([1.0, 0.0, 0.0], 170.0, None),
            attempt(up, 179.0, Some(8)),
        ];
        let summary = Summary::of(&[cell(0, "h", 0.05, attempts)]);
        let of = &summary.cells[0];
        assert_eq!((of.share.reached, of.share.of), (3, 4));
        let estimate = of.share.estimate.unwrap();
        assert!(estimate.low < 0.75 && 0.75 < estimate.high);
        assert_eq!(of.by_angle.map(|share| (share.reached, share.of)), [(1, 1), (1, 1), (1, 2)]);
        assert_eq!(of.regrasps_median, Some(4.0));
        assert_eq!(of.found[&Found::NoWay], 1);
        let bin =
            summary.bins.iter().find(|bin| bin.band == 2 && bin.sector.starts_with("about +z")).unwrap();
        assert_eq!((bin.share.reached, bin.share.of), (1, 1));
        assert_eq!(summary.bins.iter().map(|bin| bin.share.of).sum::<usize>(), 4);
    }

    #[test]
    fn what_cannot_be_held_has_no_share() {
        let summary = Summary::of(&[cell(0, "h", 0.5, Vec::new())]);
        assert_eq!(summary.cells[0].share.estimate, None);
        assert_eq!(summary.cells[0].regrasps_median, None);
    }
}
