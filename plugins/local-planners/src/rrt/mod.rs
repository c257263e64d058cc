//! `local-planner/rrt`: one finger moves to a new contact, everything else rests.

mod flight;
mod follow;
mod lift;
mod tree;

use crate::common::{Levers, refuse, wrong_target};
use flight::Flight;
use regrasp_api::{
    Build, CallError, Configuration, Contact, Context, Entry, FingerIndex, FingerJoints, Hand, Hint,
    LocalPlanner, Path, Reached, Reason, Settings, SettingsError, Slot, SurfacePath, Target, Task, TipRule,
    check_count, check_range, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

const ID: &str = "local-planner/rrt";
const SLOT: Slot = Slot::RegraspPlanner;

/// Settings of [`Rrt`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RrtSettings {
    /// Most nodes of the two random trees together, 0 (no search) to 100,000. Our choice: enough to pass an obstacle, little enough
    /// that a hopeless search does not hold the planner up.
    pub nodes: usize,
    /// Longest edge of a tree, as a bound of the finger's travel (m), 1e-3 to 0.5. Our choice.
    pub extend: f64,
    /// Tries to shorten the path that the trees find, 0 to 10,000. Our choice.
    pub shortcuts: usize,
}

impl Default for RrtSettings {
    fn default() -> Self {
        Self { nodes: 60, extend: 0.03, shortcuts: 12 }
    }
}

impl Settings for RrtSettings {
    fn validate(&self) -> Result<(), SettingsError> {
        check_count("nodes", self.nodes, 0, 100_000)?;
        check_range("extend", self.extend, 1e-3, 0.5)?;
        check_count("shortcuts", self.shortcuts, 0, 10_000)
    }
}

/// Moves one finger to a new contact or a free posture, the object resting in the grasp of the others.
///
/// Lifts the fingertip along the contact's normal, follows the geodesic between the two contacts at that height, touches down along the
/// new normal. Where the way at that height is barred, and between free postures, two random trees in the finger's joint space
/// search another (Kuffner & LaValle, "RRT-Connect: an efficient approach to single-query path planning", ICRA 2000, after LaValle & Kuffner,
/// "Randomized kinodynamic planning", IJRR 2001, which the paper names).
///
/// All or nothing. Refused for `stability` where the other fingers do not hold the object, `retreat` where the finger can
/// lift off at neither height of the task, otherwise for what bars the geodesic.
#[derive(Clone, Debug)]
pub struct Rrt {
    settings: RrtSettings,
    levers: Levers,
}

/// Memory that a call uses and leaves to the next one on the same thread.
#[derive(Default)]
struct Scratch {
    slide: SurfacePath,
    /// How far (m) the lifted fingertip has travelled at each of the slide's waypoints.
    lengths: Vec<f64>,
    /// The finger's postures after the start, in turn.
    postures: Vec<FingerJoints>,
    /// The finger's postures from the target's contact up.
    descent: Vec<FingerJoints>,
    trees: tree::Trees,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// One end of the motion: a posture, and the contact if the finger touches there.
#[derive(Clone, Copy)]
struct End<'a> {
    joints: &'a FingerJoints,
    contact: Option<&'a Contact>,
}

impl Rrt {
    /// A planner with these settings for this hand, or why they are refused.
    pub fn new(settings: RrtSettings, hand: &dyn Hand) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings, levers: Levers::new(hand) })
    }

    /// Fills `scratch.postures` with the finger's motion, without its start; or says what bars it.
    fn fly(
        &self,
        flight: &Flight<'_>,
        ends: (End<'_>, End<'_>),
        scratch: &mut Scratch,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        scratch.postures.clear();
        scratch.descent.clear();
        let Some(low) = leave(flight, ends.0, &mut scratch.postures) else {
            return Ok(Some(Reason::Retreat));
        };
        let Some(high) = leave(flight, ends.1, &mut scratch.descent) else {
            return Ok(Some(Reason::Retreat));
        };
        let a = *scratch.postures.last().unwrap_or(ends.0.joints);
        let b = *scratch.descent.last().unwrap_or(ends.1.joints);
        let lifted = scratch.postures.len();
        if let Err(reason) = direct(flight, ends, (low, high), (&a, &b), scratch, context)? {
            scratch.postures.truncate(lifted);
            if !tree::search(flight, &self.settings, (&a, &b), scratch, context)? {
                return Ok(Some(reason));
            }
        }
        // The way down is the way up backwards, and ends at the target's posture exactly.
        let Scratch { postures, descent, .. } = scratch;
        postures.extend(descent.iter().rev().skip(1));
        if !descent.is_empty() {
            postures.push(*ends.1.joints);
        }
        Ok(None)
    }
}

/// Appends the direct way from the lifted posture `a` to `b`: along the geodesic between two contacts, otherwise straight; or says what
/// bars it.
fn direct(
    flight: &Flight<'_>,
    ends: (End<'_>, End<'_>),
    heights: (f64, f64),
    (a, b): (&FingerJoints, &FingerJoints),
    scratch: &mut Scratch,
    context: &mut Context<'_>,
) -> Result<Result<(), Reason>, CallError> {
    let Scratch { slide, lengths, postures, .. } = scratch;
    let (Some(from), Some(to)) = (ends.0.contact, ends.1.contact) else {
        return Ok(flight.straight(a, b, postures));
    };
    if !flight.task.surface.geodesic(from, to, slide, context)? {
        return Ok(Err(Reason::Surface));
    }
    Ok(flight.follow(slide, lengths, heights, (a, b), postures))
}

/// Lifts the finger off the object where it touches: the greatest height of the task's that it reaches, 0 where it is free.
fn leave(flight: &Flight<'_>, end: End<'_>, postures: &mut Vec<FingerJoints>) -> Option<f64> {
    let Some(contact) = end.contact else { return Some(0.0) };
    let resolution = flight.task.resolution;
    let lowest = resolution.retreat.into_iter().fold(resolution.lift, f64::min);
    // A little higher, so that rounding leaves no finger short of the height at which it counts as lifted.
    let heights = [resolution.lift, lowest].map(|height| 1.01 * height);
    heights.into_iter().find(|&height| flight.lift(contact, end.joints, (height, lowest), postures))
}

impl LocalPlanner for Rrt {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        mut path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let &Target::Regrasp { finger, contact, joints } = to else { return Err(wrong_target(ID, SLOT)) };
        if let Some(path) = path.as_deref_mut() {
            path.restart(from);
        }
        let start = End { joints: &from.joints[finger], contact: from.contacts[finger].as_ref() };
        let target = End { joints, contact };
        context.proceed()?;
        if !others_hold(task, from, finger, context)? {
            return Ok(refuse(SLOT, Reason::Stability, from, context));
        }
        let flight = Flight::new(task, &self.levers, from, finger);
        if let Some(reason) = unfit(&flight, target) {
            return Ok(refuse(SLOT, reason, from, context));
        }
        let mut scratch = SCRATCH.take();
        let barred = self.fly(&flight, (start, target), &mut scratch, context)?;
        if let Some(reason) = barred {
            SCRATCH.replace(scratch);
            return Ok(refuse(SLOT, reason, from, context));
        }
        let mut end = from.clone();
        end.joints[finger] = *joints;
        end.contacts[finger] = contact.copied();
        if let Some(path) = path {
            store(path, &end, finger, &scratch.postures);
        }
        SCRATCH.replace(scratch);
        Ok(Reached { end, fraction: 1.0, stop: None })
    }
}

/// Whether the other fingers hold the object; their grasp does not change, so one test holds for the whole motion.
fn others_hold(
    task: &Task<'_>,
    from: &Configuration,
    finger: FingerIndex,
    context: &mut Context<'_>,
) -> Result<bool, CallError> {
    let others = from.holding().without(finger);
    let grasp = task.grasp(from, others);
    Ok(!others.is_empty() && task.stability.test(&grasp, &mut Hint::default(), context)?.is_stable())
}

/// Why the target is no place for the finger, if so.
fn unfit(flight: &Flight<'_>, target: End<'_>) -> Option<Reason> {
    let Flight { task, finger, .. } = flight;
    if !task.hand.within_limits(*finger, target.joints) {
        return Some(Reason::Limits);
    }
    let mut rule = TipRule::Clear(flight.clear());
    if let Some(contact) = target.contact {
        rule = TipRule::Touches;
        let gap = task.hand.tip_center(*finger, target.joints) - flight.center(contact, 0.0);
        if gap.norm() > 0.5 * task.tolerances.closure {
            return Some(Reason::Closure);
        }
    }
    (!flight.free(target.joints, rule)).then_some(Reason::Collision)
}

/// Appends the motion to the path; the finger touches nothing before `end`, to which the last posture belongs.
fn store(path: &mut Path, end: &Configuration, finger: FingerIndex, postures: &[FingerJoints]) {
    let mut moving = end.clone();
    moving.contacts[finger] = None;
    for posture in &postures[..postures.len().saturating_sub(1)] {
        moving.joints[finger] = *posture;
        path.states.push(moving.clone());
    }
    if path.states.last() != Some(end) {
        path.states.push(end.clone());
    }
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[SLOT],
        summary: "lifts the finger, follows the geodesic, touches down; random trees search a way around obstacles",
        references: &[
            "A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation planning, SSD 2007",
            "S. M. LaValle, J. J. Kuffner, Randomized kinodynamic planning, IJRR 2001",
            "J. J. Kuffner, S. M. LaValle, RRT-Connect: an efficient approach to single-query path planning, ICRA 2000",
        ],
        schema: RrtSettings::schema,
        check: check_settings::<RrtSettings>,
        build: Build::LocalPlanner(|json, parts| {
            Ok(Box::new(Rrt::new(RrtSettings::from_json(json)?, parts.hand)?))
        }),
    }
}
