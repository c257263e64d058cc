//! What variants are compared in.

use super::{Figure, RunRecord};
use regrasp_api::Slot;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The name of a measure that can be chosen for a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MeasureName {
    /// Whether the run is solved and verified.
    Solved,
    /// Planning time (s).
    Planning,
    /// Time of the verification (s).
    Verification,
    /// Questions of collision or distance.
    CollisionTests,
    /// Memory that planning had in use at once, at most (bytes).
    Memory,
    /// Regrasps of the plan.
    Regrasps,
    /// Duration of the motion (s).
    Duration,
    /// Smallest closure margin.
    Margin,
    /// Smallest clearance (m).
    Clearance,
    /// The least friction that the grasps need.
    Friction,
    /// The largest mass that they carry (kg).
    Mass,
    /// The largest disturbing force that they withstand (N).
    Force,
    /// The largest share of its limit that a joint's effort takes.
    Effort,
    /// What plugins note under names of their own.
    Notes,
}

impl MeasureName {
    /// Every name, in the order in which measures are told.
    pub const ALL: [Self; 14] = [
        Self::Solved,
        Self::Planning,
        Self::Verification,
        Self::CollisionTests,
        Self::Memory,
        Self::Regrasps,
        Self::Duration,
        Self::Margin,
        Self::Clearance,
        Self::Friction,
        Self::Mass,
        Self::Force,
        Self::Effort,
        Self::Notes,
    ];

    /// The name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solved => "solved",
            Self::Planning => "planning",
            Self::Verification => "verification",
            Self::CollisionTests => "collision-tests",
            Self::Memory => "memory",
            Self::Regrasps => "regrasps",
            Self::Duration => "duration",
            Self::Margin => "margin",
            Self::Clearance => "clearance",
            Self::Friction => "friction",
            Self::Mass => "mass",
            Self::Force => "force",
            Self::Effort => "effort",
            Self::Notes => "notes",
        }
    }
}

/// Something that variants are compared in.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Measure {
    /// The share of runs that are solved and verified.
    Solved,
    /// A figure of the run.
    Figure(Figure),
    /// What the plugin in a slot noted under this name: the mean over a run.
    Note(Slot, String),
}

/// In which unit a measure is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Seconds, told as s, ms or µs.
    Seconds,
    /// Metres, told as mm.
    Metres,
    /// Bytes, told as kB or MB of powers of ten.
    Bytes,
    /// Told in this unit, which may be nothing.
    Plain(&'static str),
    /// Shares, told as percentage points.
    Share,
}

impl Unit {
    /// The name of the unit in which numbers are kept; `share` for shares, nothing where there is none.
    pub fn name(self) -> &'static str {
        match self {
            Self::Seconds => "s",
            Self::Metres => "m",
            Self::Bytes => "bytes",
            Self::Plain(name) => name,
            Self::Share => "share",
        }
    }
}

impl Measure {
    /// Every measure that the runs have and that is chosen (all where `chosen` is empty), in their order.
    pub fn of_runs<'a>(
        runs: impl Iterator<Item = &'a RunRecord> + Clone,
        chosen: &[MeasureName],
    ) -> Vec<Self> {
        let is_chosen = |name: MeasureName| chosen.is_empty() || chosen.contains(&name);
        let mut all = Vec::new();
        for name in MeasureName::ALL.into_iter().filter(|name| is_chosen(*name)) {
            match name.figure() {
                Some(figure) if runs.clone().any(|run| run.is_success() && figure.of(run).is_some()) => {
                    all.push(Self::Figure(figure));
                }
                Some(_) => {}
                None if name == MeasureName::Solved => all.push(Self::Solved),
                None => all.extend(notes(runs.clone())),
            }
        }
        all
    }

    /// What it is called, in the singular or plural in which sentences use it.
    pub fn noun(&self) -> String {
        match self {
            Self::Solved => "solved".into(),
            Self::Figure(figure) => figure_words(*figure).0.into(),
            Self::Note(slot, name) => {
                // Names are the plugin's, and stand in sentences that a reader takes apart.
                let plain = |c: char| if c.is_alphanumeric() || "-_ .".contains(c) { c } else { '-' };
                format!("{} ({})", name.chars().map(plain).collect::<String>(), slot.name())
            }
        }
    }

    /// The words for more and for less of it, such as `slower` and `faster`.
    pub fn words(&self) -> [&'static str; 2] {
        match self {
            Self::Solved => ["more", "fewer"],
            Self::Figure(figure) => figure_words(*figure).1,
            Self::Note(..) => ["larger", "smaller"],
        }
    }

    /// Whether more of it is better (1), worse (-1), or neither (0).
    pub fn sense(&self) -> i8 {
        match self {
            Self::Solved => 1,
            Self::Figure(figure) => match figure {
                Figure::Margin | Figure::Clearance | Figure::Mass | Figure::Force => 1,
                Figure::GeneratedNodes | Figure::GraphNodes | Figure::Transfers => 0,
                _ => -1,
            },
            Self::Note(..) => 0,
        }
    }

    /// The unit.
    pub fn unit(&self) -> Unit {
        match self {
            Self::Solved | Self::Figure(Figure::Effort) => Unit::Share,
            Self::Figure(Figure::Planning | Figure::Duration | Figure::Verification) => Unit::Seconds,
            Self::Figure(Figure::Clearance) => Unit::Metres,
            Self::Figure(Figure::Memory) => Unit::Bytes,
            Self::Figure(Figure::Mass) => Unit::Plain("kg"),
            Self::Figure(Figure::Force) => Unit::Plain("N"),
            Self::Figure(_) | Self::Note(..) => Unit::Plain(""),
        }
    }

    /// The name in tables for programs, with the unit of the numbers there.
    pub fn column(&self) -> String {
        match self {
            Self::Solved => "solved".into(),
            Self::Figure(figure) => figure.name().into(),
            Self::Note(slot, name) => format!("{}.note.{name}", slot.name()),
        }
    }

    /// The value of one run. A run that failed has none, but for the planning time: it counts as the whole
    /// `horizon_s`, since whoever waited that long has no plan.
    ///
    /// That is the time restricted at the horizon, as survival analysis has it (P. Royston, M. K. B. Parmar,
    /// "Restricted mean survival time: an alternative to the hazard ratio for the design and analysis of
    /// randomized trials with a time-to-event outcome", BMC Medical Research Methodology 2013).
    pub fn of(&self, run: &RunRecord, horizon_s: f64) -> Option<f64> {
        let success = run.is_success();
        match self {
            Self::Solved => Some(f64::from(u8::from(success))),
            Self::Figure(Figure::Planning) => {
                Some(if success { run.times.planning_s.min(horizon_s) } else { horizon_s })
            }
            Self::Figure(figure) => success.then(|| figure.of(run)).flatten(),
            Self::Note(slot, name) => {
                let notes = run.counts.notes.get(slot).filter(|_| success)?;
                notes.get(name).map(|figure| figure.mean)
            }
        }
        .filter(|value| value.is_finite())
    }
}

impl MeasureName {
    fn figure(self) -> Option<Figure> {
        Some(match self {
            Self::Solved | Self::Notes => return None,
            Self::Planning => Figure::Planning,
            Self::Verification => Figure::Verification,
            Self::CollisionTests => Figure::CollisionTests,
            Self::Memory => Figure::Memory,
            Self::Regrasps => Figure::Regrasps,
            Self::Duration => Figure::Duration,
            Self::Margin => Figure::Margin,
            Self::Clearance => Figure::Clearance,
            Self::Friction => Figure::Friction,
            Self::Mass => Figure::Mass,
            Self::Force => Figure::Force,
            Self::Effort => Figure::Effort,
        })
    }
}

fn notes<'a>(runs: impl Iterator<Item = &'a RunRecord>) -> impl Iterator<Item = Measure> {
    let mut names = BTreeSet::new();
    for (slot, notes) in runs.filter(|run| run.is_success()).flat_map(|run| &run.counts.notes) {
        names.extend(notes.keys().map(|name| (*slot, name.clone())));
    }
    names.into_iter().map(|(slot, name)| Measure::Note(slot, name))
}

/// The noun of a figure, and the words for more and less of it.
fn figure_words(figure: Figure) -> (&'static str, [&'static str; 2]) {
    match figure {
        Figure::Planning => ("planning", ["slower", "faster"]),
        Figure::Verification => ("verification", ["slower", "faster"]),
        Figure::GeneratedNodes => ("generated nodes", ["more", "fewer"]),
        Figure::GraphNodes => ("graph nodes", ["more", "fewer"]),
        Figure::Transfers => ("transfers", ["more", "fewer"]),
        Figure::CollisionTests => ("collision tests", ["more", "fewer"]),
        Figure::Memory => ("memory", ["more", "less"]),
        Figure::Regrasps => ("regrasps", ["more", "fewer"]),
        Figure::Duration => ("motion", ["longer", "shorter"]),
        Figure::Margin => ("margin", ["larger", "smaller"]),
        Figure::Clearance => ("clearance", ["larger", "smaller"]),
        Figure::Friction => ("needed friction", ["larger", "smaller"]),
        Figure::Mass => ("carried mass", ["larger", "smaller"]),
        Figure::Force => ("withstood force", ["larger", "smaller"]),
        Figure::Effort => ("effort", ["larger", "smaller"]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::RunKey;
    use crate::compare::fixture::{runs, study};

    #[test]
    fn a_run_that_failed_took_the_whole_horizon() {
        let study = study(&["rlg"]);
        let records = runs(&study, |key: RunKey| (key.seed > 0).then_some(0.25 * key.seed as f64));
        let planning = Measure::Figure(Figure::Planning);
        assert_eq!(planning.of(&records[0], 2.0), Some(2.0), "failed after half a second");
        assert_eq!(planning.of(&records[1], 2.0), Some(0.25));
        assert_eq!(planning.of(&records[11], 2.0), Some(2.0), "restricted");
        assert_eq!(Measure::Figure(Figure::CollisionTests).of(&records[0], 2.0), None);
        assert_eq!(Measure::Solved.of(&records[0], 2.0), Some(0.0));
    }

    #[test]
    fn measures_are_those_that_the_runs_have() {
        let study = study(&["rlg"]);
        let mut records = runs(&study, |_| Some(0.1));
        let of = |records: &[RunRecord], chosen: &[MeasureName]| {
            let nouns = Measure::of_runs(records.iter(), chosen).into_iter().map(|measure| measure.noun());
            nouns.collect::<Vec<_>>().join(", ")
        };
        let all = "solved, planning, verification, collision tests, memory, regrasps, motion, margin";
        assert_eq!(of(&records, &[]), all);
        assert_eq!(of(&records, &[MeasureName::Margin, MeasureName::Planning]), "planning, margin");
        let note = [("grip".to_owned(), regrasp_api::Figure::one(2.0))].into();
        records[3].counts.notes.insert(Slot::Sampler, note);
        assert_eq!(of(&records, &[]), format!("{all}, grip (sampler)"));
    }
}
