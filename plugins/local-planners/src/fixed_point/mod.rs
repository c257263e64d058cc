//! `local-planner/fixed-point`: the object moves straight, contact points stay where they are on object and
//! fingertip.
//!
//! For hands that declare `fingertip = "point"`. The classical point contact: the contact is fixed in both
//! bodies, and the finger turns freely about it (Salisbury & Roth, "Kinematic and force analysis of
//! articulated mechanical hands", ASME JMTAD 1983; Li, Hsu, Sastry, "Grasping and coordinated manipulation by
//! a multifingered robot hand", IJRR 1989, who assume fixed points of contact). The other model of the same
//! transfer, `local-planner/rolling`, is for fingertips that are balls.
//!
//! In this project's geometry a fingertip is a ball of radius r that touches at p along the normal n. A
//! declared point keeps p *and* n while the object moves: the ball's centre rides on the object at p + r n,
//! so that the ball stays a tangent collision shape, and only the joints turn. What the idealisation neglects
//! is of the order of r times the angle turned; a hand that declares points should have small fingertips.
//!
//! There is nothing to integrate: inverse kinematics puts each centre where the object carries it. The
//! numbers that remain are how closely the straight motion of the joints between two states follows, and that
//! is what steps are halved for. Contacts do not drift, so a transfer ends where rolling would not: with the
//! contacts it began with.
//!
//! ```toml
//! [plugins.local-planner.transfer]
//! use = "local-planner/fixed-point"
//! ```

mod pin;

use crate::common::{Levers, largest_travel, wrong_target};
use crate::transfer::{Motion, Pace, demand_fingertip};
use pin::{Failure, Pinned};
use regrasp_api::{
    Build, CallError, Configuration, Context, Entry, Fingertip, Hand, Hint, LocalPlanner, Path, Pose,
    Reached, Reason, Settings, SettingsError, Slot, Target, Task, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ID: &str = "local-planner/fixed-point";
const SLOT: Slot = Slot::TransferPlanner;

/// Settings of [`FixedPoint`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FixedPointSettings {
    /// What part of the task's tolerances for closure and slip the fingertip may stray between two states.
    /// Default: half, as the plan's meaning asks.
    #[schemars(range(min = 0.01, max = 1.0), extend("x-unit" = "1"))]
    pub tolerance_share: f64,
    /// How often a step may be halved before the contact counts as lost. Our choice.
    #[schemars(range(min = 0, max = 20))]
    pub halvings: usize,
}

impl Default for FixedPointSettings {
    fn default() -> Self {
        Self { tolerance_share: 0.5, halvings: 8 }
    }
}

impl Settings for FixedPointSettings {}

/// Moves the object straight to a pose, every holding fingertip pinned to its contact point; free fingers
/// stay.
///
/// Refused when it is built for a hand whose fingertips are balls. Stops at the last valid state: at a
/// joint's limit (`limits`), out of reach or at a singularity (`reach`), at a collision, where the grasp is
/// no longer stable, and where steps of the finest length still stray (`closure`).
#[derive(Clone, Debug)]
pub struct FixedPoint {
    settings: FixedPointSettings,
    levers: Levers,
}

impl FixedPoint {
    /// A planner with these settings for this hand, or why they are refused.
    pub fn new(settings: FixedPointSettings, hand: &dyn Hand) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings, levers: Levers::new(hand) })
    }

    fn pinned<'a>(&'a self, task: &'a Task<'a>, from: &Configuration, to: &Pose) -> Pinned<'a> {
        let radius = task.hand.fingertip_radius();
        Pinned {
            task,
            levers: &self.levers,
            motion: Motion::new(&from.X_HO, to),
            pins: from
                .holding()
                .iter()
                .filter_map(|f| Some((f, from.contacts[f]?.tip_center(radius))))
                .collect(),
            stray: self.settings.tolerance_share * task.tolerances.closure.min(task.tolerances.slip),
            travel: largest_travel(task.resolution),
        }
    }
}

impl LocalPlanner for FixedPoint {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        mut path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        context.count_call(SLOT);
        let Target::Transfer(to) = to else { return Err(wrong_target(ID, SLOT)) };
        if let Some(path) = path.as_deref_mut() {
            path.restart(from);
        }
        let pinned = self.pinned(task, from, to);
        // Two states in turn: the one that is reached and the one that is tried.
        let (mut q, mut next) = (from.clone(), from.clone());
        let mut s = if pinned.motion.is_still() { 1.0 } else { 0.0 };
        let mut pace = Pace::new(pinned.motion.step(task.resolution), self.settings.halvings);
        let (mut hint, mut stop) = (Hint::default(), None);
        while s < 1.0 && stop.is_none() {
            context.proceed()?;
            match step(&pinned, (&q, s), &mut next, &mut pace) {
                Ok(further) => {
                    stop = fault(task, &next, &mut hint, context)?;
                    if stop.is_none() {
                        std::mem::swap(&mut q, &mut next);
                        s = further;
                        if let Some(path) = path.as_deref_mut() {
                            path.states.push(q.clone());
                        }
                    }
                }
                Err(reason) => stop = Some(reason),
            }
        }
        let stop = stop.map(|reason| context.reject(SLOT, reason));
        Ok(Reached { end: q, fraction: s, stop })
    }
}

/// Steps as far as the pace and what remains allow, halving until the fingertips stay pinned in between: how
/// far the object has come then.
fn step(
    pinned: &Pinned<'_>,
    (q, s): (&Configuration, f64),
    next: &mut Configuration,
    pace: &mut Pace,
) -> Result<f64, Reason> {
    let mut h = pace.next(f64::INFINITY, 1.0 - s);
    while h >= 0.5 * pace.finest {
        // The last step ends at 1 exactly, whatever the sum of the steps before it.
        let further = if 1.0 - (s + h) < 1e-12 { 1.0 } else { s + h };
        match pinned.advance(q, (s, further), next) {
            Ok(()) => return Ok(further),
            Err(Failure::Finer) => h = pace.halve(h),
            Err(Failure::Stop(reason)) => return Err(reason),
        }
    }
    Err(Reason::Closure)
}

/// What is wrong with a state: stability first, because it costs less than collision. In the object's frame
/// the contacts rest, but gravity turns.
fn fault(
    task: &Task<'_>,
    q: &Configuration,
    hint: &mut Hint,
    context: &mut Context<'_>,
) -> Result<Option<Reason>, CallError> {
    let holding = q.holding();
    if !task.stability.test(&task.transfer_grasp(q, holding), hint, context)?.is_stable() {
        return Ok(Some(Reason::Stability));
    }
    Ok(task.clearance.configuration_free(q, holding, true).is_err().then_some(Reason::Collision))
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[SLOT],
        summary: "the object moves straight, contact points stay put: for hands that declare point \
            fingertips",
        references: &[
            "J. K. Salisbury, B. Roth, Kinematic and force analysis of articulated mechanical hands, ASME \
                JMTAD 1983",
            "Z. Li, P. Hsu, S. Sastry, Grasping and coordinated manipulation by a multifingered robot hand, \
                IJRR 1989",
            "A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation \
                planning, SSD 2007",
        ],
        schema: FixedPointSettings::schema,
        check: check_settings::<FixedPointSettings>,
        build: Build::LocalPlanner(|json, parts| {
            let settings = FixedPointSettings::from_json(json)?;
            demand_fingertip(Fingertip::Point, parts.hand)?;
            Ok(Box::new(FixedPoint::new(settings, parts.hand)?))
        }),
    }
}
