//! `local-planner/lift-slide-touch`: one finger lifts off, follows the geodesic, touches down; nothing is
//! searched.
//!
//! The regrasp that the paper's decomposition needs nearly always: the fingertip leaves its contact along the
//! normal, its centre follows the geodesic between the two contacts at lift height, and it comes down along
//! the new normal. A finger that starts or ends free moves its joints straight between the free posture and
//! the lifted one. It is `local-planner/rrt` without its trees, and shares its code: what it finds, `rrt`
//! finds with the same states. Where something bars the way it says no at once, so that a comparison shows
//! what the search is worth: among obstacles a third of the regrasps that are needed; on free objects hardly
//! any, and each hopeless one costs nothing.
//!
//! ```toml
//! [plugins.local-planner.regrasp]
//! use = "local-planner/lift-slide-touch"
//! heights = 3
//! ```

use crate::common::Levers;
use crate::regrasp::{NoDetour, Regrasping, SLOT};
use regrasp_api::{
    Build, CallError, Configuration, Context, Entry, Hand, LocalPlanner, Path, Reached, Settings,
    SettingsError, Target, Task, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ID: &str = "local-planner/lift-slide-touch";

/// Settings of [`LiftSlideTouch`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LiftSlideTouchSettings {
    /// How many heights are tried at each end, evenly from the task's lift height down to its least retreat
    /// height. Default: these two, as `local-planner/rrt`.
    #[schemars(range(min = 1, max = 16))]
    pub heights: usize,
}

impl Default for LiftSlideTouchSettings {
    fn default() -> Self {
        Self { heights: 2 }
    }
}

impl Settings for LiftSlideTouchSettings {}

/// Moves one finger to a new contact or a free posture the direct way, the object resting in the grasp of the
/// others.
///
/// All or nothing, and nothing random. Refused for `stability` where the other fingers do not hold the
/// object, `retreat` where the finger can lift off at none of the heights, otherwise for what bars the
/// geodesic (`reach`, `collision`, `surface`).
///
/// Source: Sahbani, Saut, Perdereau, "An efficient algorithm for dexterous manipulation planning", SSD 2007,
/// section IV (regrasp paths), with the search of the finger's way left out.
#[derive(Clone, Debug)]
pub struct LiftSlideTouch {
    settings: LiftSlideTouchSettings,
    levers: Levers,
}

impl LiftSlideTouch {
    /// A planner with these settings for this hand, or why they are refused.
    pub fn new(settings: LiftSlideTouchSettings, hand: &dyn Hand) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings, levers: Levers::new(hand) })
    }
}

impl LocalPlanner for LiftSlideTouch {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let heights = self.settings.heights;
        let regrasping = Regrasping { id: ID, levers: &self.levers, heights, detour: &NoDetour };
        regrasping.connect(task, from, to, path, context)
    }
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[SLOT],
        summary: "lifts the finger along the normal, follows the geodesic at lift height, touches down; no \
            search",
        references: &[
            "A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation \
                planning, SSD 2007",
        ],
        schema: LiftSlideTouchSettings::schema,
        check: check_settings::<LiftSlideTouchSettings>,
        build: Build::LocalPlanner(|json, parts| {
            Ok(Box::new(LiftSlideTouch::new(LiftSlideTouchSettings::from_json(json)?, parts.hand)?))
        }),
    }
}
