//! What a run hands back, and what it tells while it runs.

use crate::GraphRecord;
use regrasp_api::Tally;
use regrasp_plan::{Motion, Statistics};
use serde::{Deserialize, Serialize};

/// A clock, injected so that the library owns none.
pub trait Clock: Sync {
    /// Seconds since some fixed instant.
    fn seconds(&self) -> f64;
}

/// Told how far a run is; all methods do nothing by default.
pub trait Progress: Sync {
    /// The search for goal number `leg` (from 0) has this many nodes in this many components.
    fn search(&self, leg: usize, nodes: usize, components: usize) {
        let _ = (leg, nodes, components);
    }
    /// The motion with this many segments is being smoothed.
    fn smoothing(&self, segments: usize) {
        let _ = segments;
    }
}

/// Tells nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;
impl Progress for Silent {}

/// A phase of a run, timed by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    Endpoints,
    Roadmap,
    Relay,
    Search,
    Smoothing,
    Timing,
}

impl Phase {
    /// Its name in the statistics.
    pub fn name(self) -> &'static str {
        match self {
            Self::Endpoints => "endpoints",
            Self::Roadmap => "roadmap",
            Self::Relay => "relay",
            Self::Search => "search",
            Self::Smoothing => "smoothing",
            Self::Timing => "timing",
        }
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// All goals reached.
    Solved,
    /// No plan within the budget of nodes, or the strategy gave up.
    NoPlan,
    /// Stopped from outside: a deadline or Ctrl-C.
    Interrupted,
}

/// Where a run without a full plan got stuck.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stuck {
    /// No admissible grasp was found at the start's pose.
    StartGrasp,
    /// No admissible grasp was found at the pose of this goal.
    GoalGrasp(usize),
    /// The budget of nodes ended, or the strategy gave up, on the way to this goal.
    Search(usize),
}

/// What a run hands back.
#[derive(Debug)]
pub struct Outcome {
    /// How it ended.
    pub status: Status,
    /// Where it got stuck, unless solved.
    pub stuck: Option<Stuck>,
    /// The motion; through fewer goals than asked for unless solved.
    pub motion: Motion,
    /// For each goal that the motion reaches, in turn, how many of its segments are done by then.
    pub goal_ends: Vec<usize>,
    /// Counts, and times of the phases `endpoints`, `roadmap`, `relay`, `search`, `smoothing` and
    /// `timing`.
    pub statistics: Statistics,
    /// Calls and rejections by cause.
    pub tally: Tally,
    /// The manipulation graph at the end.
    pub graph: GraphRecord,
    /// What the user should know.
    pub warnings: Vec<String>,
}
