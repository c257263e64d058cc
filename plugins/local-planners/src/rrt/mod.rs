//! `local-planner/rrt`: one finger moves to a new contact, everything else rests.

mod tree;

use crate::common::Levers;
use crate::regrasp::{Detour, Flight, Regrasping, SLOT};
use regrasp_api::{
    Build, CallError, Configuration, Context, Entry, FingerJoints, Hand, LocalPlanner, Path, Reached,
    Settings, SettingsError, Target, Task, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

const ID: &str = "local-planner/rrt";

/// Settings of [`Rrt`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RrtSettings {
    /// Most nodes of the two random trees together, 0 (no search) to 100,000. Our choice: enough to pass an
    /// obstacle, little enough that a hopeless search does not hold the planner up.
    #[schemars(range(min = 0, max = 100_000))]
    pub nodes: usize,
    /// Longest edge of a tree, as a bound of the finger's travel (m). Our choice.
    #[schemars(range(min = 1e-3, max = 0.5), extend("x-unit" = "m"))]
    pub extend: f64,
    /// Tries to shorten the path that the trees find. Our choice.
    #[schemars(range(min = 0, max = 10_000))]
    pub shortcuts: usize,
    /// Whether the way along the geodesic is tried before the trees. The paper searches every regrasp by RRT
    /// (section IV.C).
    pub direct: bool,
}

impl Default for RrtSettings {
    fn default() -> Self {
        Self { nodes: 60, extend: 0.03, shortcuts: 12, direct: true }
    }
}

impl Settings for RrtSettings {}

/// Moves one finger to a new contact or a free posture, the object resting in the grasp of the others.
///
/// Lifts the fingertip along the contact's normal, follows the geodesic between the two contacts at that
/// height, touches down along the new normal. Where the way at that height is barred, and between free
/// postures, two random trees in the finger's joint space search another (Kuffner & LaValle, "RRT-Connect: an
/// efficient approach to single-query path planning", ICRA 2000, after LaValle & Kuffner, "Randomized
/// kinodynamic planning", IJRR 2001, which the paper names).
///
/// All or nothing. Refused for `stability` where the other fingers do not hold the object, `retreat` where
/// the finger can lift off at neither height of the task, otherwise for what bars the geodesic.
#[derive(Clone, Debug)]
pub struct Rrt {
    settings: RrtSettings,
    levers: Levers,
}

thread_local! {
    /// Memory that a call uses and leaves to the next one on the same thread.
    static TREES: RefCell<tree::Trees> = RefCell::default();
}

/// Lift heights tried at each end: the task's, and its least retreat.
const HEIGHTS: usize = 2;

impl Rrt {
    /// A planner with these settings for this hand, or why they are refused.
    pub fn new(settings: RrtSettings, hand: &dyn Hand) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings, levers: Levers::new(hand) })
    }
}

impl Detour for RrtSettings {
    fn comes_first(&self) -> bool {
        !self.direct
    }

    fn search(
        &self,
        flight: &Flight<'_>,
        ends: (&FingerJoints, &FingerJoints),
        postures: &mut Vec<FingerJoints>,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        let mut trees = TREES.take();
        let found = trees.search(flight, self, ends, postures, context);
        TREES.replace(trees);
        found
    }
}

impl LocalPlanner for Rrt {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let Self { settings, levers } = self;
        let regrasping = Regrasping { id: ID, levers, heights: HEIGHTS, detour: settings };
        regrasping.connect(task, from, to, path, context)
    }
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[SLOT],
        summary: "lifts the finger, follows the geodesic, touches down; random trees search a way \
         around obstacles",
        references: &[
            "A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation \
             planning, SSD 2007",
            "S. M. LaValle, J. J. Kuffner, Randomized kinodynamic planning, IJRR 2001",
            "J. J. Kuffner, S. M. LaValle, RRT-Connect: an efficient approach to single-query path \
             planning, ICRA 2000",
        ],
        schema: RrtSettings::schema,
        check: check_settings::<RrtSettings>,
        build: Build::LocalPlanner(|json, parts| {
            Ok(Box::new(Rrt::new(RrtSettings::from_json(json)?, parts.hand)?))
        }),
    }
}
