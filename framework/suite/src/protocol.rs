//! The form of a protocol's file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where a published method works.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum World {
    /// A real hand.
    Real,
    /// A physics simulation.
    Simulation,
    /// A planner's model.
    Model,
    /// It is not known here.
    Unknown,
}

impl World {
    /// In words, for a table.
    pub fn words(self) -> &'static str {
        match self {
            Self::Real => "real hand",
            Self::Simulation => "simulation",
            Self::Model => "planner's model",
            Self::Unknown => "not known here",
        }
    }
}

/// Problems of a published paper.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Protocol {
    /// What the protocol is about, in one line.
    pub title: String,
    /// Authors, title, venue, year, and the table.
    pub paper: String,
    /// What is like for like.
    pub like: String,
    /// What differs, and what the paper does not say and is chosen here.
    pub chosen: String,
    /// The series of problems.
    pub series: Vec<Series>,
}

/// A series of problems of one kind.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Series {
    /// What it is called.
    pub name: String,
    /// The scenario that it begins from: a file of the protocol's folder, or the name of a built-in one.
    pub scenario: String,
    /// A preset of plugins in the place of the scenario's.
    #[serde(default)]
    pub preset: Option<String>,
    /// The most nodes of a search, in the place of the scenario's.
    #[serde(default)]
    #[schemars(range(min = 1, max = 10_000_000))]
    pub max_nodes: Option<usize>,
    /// Which problems.
    pub problems: Problems,
    /// What was published of them.
    #[serde(default)]
    pub published: Vec<Published>,
}

/// How the problems of a series are made. Turns are about axes of the hand's frame, from the scenario's
/// start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", tag = "kind", deny_unknown_fields)]
pub enum Problems {
    /// The scenario's own goals, with so many seeds.
    Scenario {
        /// Seeds, from 0 on.
        #[schemars(range(min = 1, max = 100_000))]
        seeds: usize,
    },
    /// The 23 turns that take a cube to itself and are none; each with so many seeds.
    CubeGroup {
        /// Seeds of each turn.
        #[schemars(range(min = 1, max = 1000))]
        seeds: usize,
    },
    /// Turns about random axes by random angles, and random displacements.
    Random {
        /// How many.
        #[schemars(range(min = 1, max = 100_000))]
        count: usize,
        /// Smallest and largest angle (degrees); uniform over all orientations where absent.
        #[serde(default)]
        #[schemars(inner(range(min = 0.0, max = 180.0)), extend("x-unit" = "degrees"))]
        angle_deg: Option<[f64; 2]>,
        /// Smallest and largest displacement (m).
        #[serde(default)]
        #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "m"))]
        displacement: [f64; 2],
    },
    /// One goal after the other, orientations uniform over all at the start's position, until one is not
    /// reached.
    Consecutive {
        /// How many times it is begun anew.
        #[schemars(range(min = 1, max = 10_000))]
        trials: usize,
        /// The most goals of one trial.
        #[schemars(range(min = 1, max = 10_000))]
        most: usize,
        /// The least angle (degrees) between a goal and the one before.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 170.0), extend("x-unit" = "degrees"))]
        apart_deg: f64,
        /// An orientation this near to a goal's (degrees) counts as the goal's: where there is no plan to the
        /// goal itself, others are aimed at.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "degrees"))]
        within_deg: f64,
        /// How far (m) from the start's position the object may be at a goal.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "m"))]
        within: f64,
        /// How many poses are aimed at for each goal, itself among them.
        #[serde(default = "one")]
        #[schemars(range(min = 1, max = 1000))]
        aims: usize,
    },
    /// Turn after turn about one axis, until one is not reached.
    Continuing {
        /// How many times it is begun anew.
        #[schemars(range(min = 1, max = 10_000))]
        trials: usize,
        /// The most turns of one trial.
        #[schemars(range(min = 1, max = 10_000))]
        most: usize,
        /// The axis.
        #[schemars(extend("x-unit" = "1"))]
        axis: [f64; 3],
        /// The angle of each (degrees).
        #[schemars(range(min = 1.0, max = 180.0), extend("x-unit" = "degrees"))]
        step_deg: f64,
    },
}

fn one() -> usize {
    1
}

/// A figure that was published.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Published {
    /// What it measures, as the paper has it.
    pub what: String,
    /// The figure with its unit and spread, as it was published.
    pub figure: String,
    /// Where it was measured.
    pub world: World,
    /// The method, and what it ran on where that is known.
    pub method: String,
}

impl Series {
    /// Whether a trial is a chain of goals, each from where the last has ended.
    pub fn is_chain(&self) -> bool {
        matches!(self.problems, Problems::Consecutive { .. } | Problems::Continuing { .. })
    }
}

/// A chain of goals that are reached exactly or not.
#[cfg(test)]
pub(crate) fn consecutive(trials: usize, most: usize) -> Problems {
    Problems::Consecutive { trials, most, apart_deg: 0.0, within_deg: 0.0, within: 0.0, aims: 1 }
}
