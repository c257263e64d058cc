//! What a study keeps of one run: a row of `runs.csv`, a line of `runs.jsonl`.

use regrasp_api::Slot;
use regrasp_plan::{PluginNotes, PluginStatistics, RoadmapStatistics};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunStatus {
    /// All goals reached; [`RunRecord::verified`] says whether the verifier agrees.
    Solved,
    /// No plan within the budget of nodes, or the strategy gave up.
    NoPlan,
    /// The study's time limit for one run ended it.
    TimeOut,
    /// There is no answer: a start that is refused, a plugin that does not support what it was asked.
    Error,
    /// A plugin or the framework panicked.
    Panic,
    /// The process that made it ended: a segmentation fault, a stack overflow, an abort.
    Crash,
}

impl RunStatus {
    /// Every status, in the order of their numbers.
    pub const ALL: [Self; 6] =
        [Self::Solved, Self::NoPlan, Self::TimeOut, Self::Error, Self::Panic, Self::Crash];

    /// The name used in files and tables, in kebab case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solved => "solved",
            Self::NoPlan => "no-plan",
            Self::TimeOut => "time-out",
            Self::Error => "error",
            Self::Panic => "panic",
            Self::Crash => "crash",
        }
    }
}

/// The phases of planning that are timed, in their order: keys of [`Times::phases_s`].
pub const PHASES: [&str; 5] = ["endpoints", "relay", "search", "smoothing", "timing"];

/// What was measured: all that a repeated run may change in its record.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Times {
    /// Planning alone, on one thread: start and goal grasps, relays, search, smoothing, timing (s).
    pub planning_s: f64,
    /// The verification of the plan (s); 0 where there was no plan.
    pub verification_s: f64,
    /// Planning by phase ([`PHASES`]), in all [`Times::planning_s`] but for rounding (s).
    pub phases_s: BTreeMap<String, f64>,
    /// Planning by who computed, calls of others taken off (s): the slots by name, `clearance` for collision
    /// and distance, and `framework` for the rest. In all [`Times::planning_s`].
    pub roles_s: BTreeMap<String, f64>,
    /// Bytes that planning had in use at once, at most, beyond those in use when it began
    /// ([`super::Memory`]); absent where nobody counted. Repeated runs share it, but for the first of a
    /// variant on a scenario in a process, which also makes tables that those after it find.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub memory_bytes: Option<u64>,
}

/// What the search counted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Counts {
    /// Nodes that the search generated: samples that gave a grasp, kept or not.
    pub generated_nodes: usize,
    /// Nodes of the final manipulation graph.
    pub graph_nodes: usize,
    /// Components of the final manipulation graph.
    pub components: usize,
    /// The graph's part in GS_n, and what became of it.
    pub roadmap: RoadmapStatistics,
    /// Questions of collision or distance that planning asked, one of which may be about several bodies; 0
    /// where nobody counted.
    pub collision_tests: u64,
    /// Goals that the motion reaches; all of them exactly where the run is solved.
    pub goals_reached: usize,
    /// Calls of the plugin in each slot, and its rejections by cause; slots that were not called are left
    /// out.
    pub plugins: BTreeMap<Slot, PluginStatistics>,
    /// What plugins noted under names of their own.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub notes: BTreeMap<Slot, PluginNotes>,
}

/// The motion that was found, smoothed; of all goals, or of those that were reached.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MotionFigures {
    /// Transfers.
    pub transfers: usize,
    /// Regrasps.
    pub regrasps: usize,
    /// Regrasps before smoothing.
    pub regrasps_before_smoothing: usize,
    /// Stored states.
    pub states: usize,
    /// How long the motion takes (s); determined by the plan, not measured.
    pub duration_s: f64,
    /// Length of the way of the object's origin (m).
    pub object_path_m: f64,
    /// Angles that the object turns through, summed over the states (rad).
    pub object_turn_rad: f64,
    /// Travel of all revolute joints, summed (rad).
    pub joint_travel_rad: f64,
    /// Travel of all prismatic joints, summed (m).
    pub joint_travel_m: f64,
}

/// The verifier's word on the plan.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Certified {
    /// Smallest closure margin of the plan, certified (no unit; see [`regrasp_plan::PlanCertificate`]).
    pub margin: Option<f64>,
    /// Smallest distance of two bodies that may not touch (m).
    pub clearance_m: Option<f64>,
    /// Largest net slip of a contact from its finger's touch-down to its lift (m).
    pub slip_m: Option<f64>,
    /// Largest distance between a holding fingertip and the surface (m).
    pub closure_m: Option<f64>,
    /// The smallest coefficient of friction at which every grasp still bears what it must (no unit).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub holds_friction: Option<f64>,
    /// The largest mass of the object that every grasp carries (kg).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub holds_mass_kg: Option<f64>,
    /// The largest disturbing force, in any direction, that every grasp withstands (N).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub holds_force_n: Option<f64>,
    /// The largest share of its limit that a joint's effort takes (no unit).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effort_share: Option<f64>,
    /// The names of the checks that the plan fails; empty for a plan that is right.
    pub failed_checks: Vec<String>,
}

/// One run of a study: one scenario, planned by one variant with one seed, and verified.
///
/// Everything but `times` is determined by the study on one machine, unless the status is `time-out`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunRecord {
    /// The scenario's name, that of one of [`super::Study::scenarios`].
    pub scenario: String,
    /// The variant's name, that of one of [`super::Study::variants`]; the plugins are
    /// [`super::StudyScenario::plugins`].
    pub variant: String,
    /// The seed of all random streams.
    pub seed: u64,
    /// How it ended.
    pub status: RunStatus,
    /// Whether there is a full plan and the verifier accepts it.
    pub verified: bool,
    /// Why there is no plan, in words; for a solved run absent.
    pub message: Option<String>,
    /// What was measured.
    pub times: Times,
    /// What the search counted.
    pub counts: Counts,
    /// The motion; absent where no goal was reached.
    pub motion: Option<MotionFigures>,
    /// The verifier's figures; absent where no goal was reached.
    pub certified: Option<Certified>,
}

impl RunRecord {
    /// Whether the run counts as a success: solved, and the verifier agrees.
    pub fn is_success(&self) -> bool {
        self.status == RunStatus::Solved && self.verified
    }
}
