//! A local planner for the slot `local-planner.regrasp`: hop from contact to contact, higher if something is
//! in the way.

// ANCHOR: uses
use regrasp_api::{
    Build, CallError, Configuration, Contact, Context, Entry, FingerIndex, FingerJoints, FingerSet, Hint,
    LocalPlanner, LoneFinger, Path, Reached, Reason, Settings, SettingsError, Slot, Target, Task, TipRule,
    check_settings,
};
use serde::{Deserialize, Serialize};
// ANCHOR_END: uses

// ANCHOR: settings
/// Settings of [`Hop`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HopSettings {
    /// Heights that are tried: the problem's lift height, twice that, and so on.
    #[schemars(range(min = 1, max = 20))]
    pub heights: usize,
    /// The fingertip's step as a part of the problem's `regrasp_step`.
    #[schemars(range(min = 0.05, max = 1.0), extend("x-unit" = "1"))]
    pub step: f64,
}

impl Default for HopSettings {
    fn default() -> Self {
        Self { heights: 4, step: 0.3 }
    }
}

impl Settings for HopSettings {}

/// Moves one finger: up along the normal, straight in its joints, down along the new normal; all or nothing.
#[derive(Clone, Copy, Debug)]
pub struct Hop {
    settings: HopSettings,
}

impl Hop {
    /// A local planner with checked settings.
    pub fn new(settings: HopSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }
}
// ANCHOR_END: settings

// ANCHOR: flight
/// What stays the same during one regrasp.
struct Flight<'a> {
    task: &'a Task<'a>,
    from: &'a Configuration,
    finger: FingerIndex,
    /// The finger among everything that rests.
    lone: Box<dyn LoneFinger + 'a>,
    /// Largest step of the fingertip (m).
    step: f64,
}

/// One end of a regrasp.
#[derive(Clone, Copy)]
struct End<'a> {
    contact: Option<&'a Contact>,
    joints: &'a FingerJoints,
}

/// Postures after the first, or why there are none.
type Way = Result<Vec<FingerJoints>, Reason>;

impl Flight<'_> {
    /// The posture near `near` with the fingertip at a height (m) above a contact.
    fn above(&self, contact: &Contact, height: f64, near: &FingerJoints) -> Result<FingerJoints, Reason> {
        let X_HO = &self.from.X_HO;
        let p_OF = contact.tip_center(self.task.hand.fingertip_radius() + height);
        let p_HF = X_HO.rotation * p_OF + X_HO.translation.vector;
        let joints = self.task.hand.inverse(self.finger, &p_HF, near).ok_or(Reason::Reach)?;
        // Close above its contact the tip cannot be as far from the object as other bodies are.
        self.free(joints, (0.5 * height).min(self.clear()))
    }

    fn clear(&self) -> f64 {
        self.task.tolerances.clearance + self.task.resolution.clearance
    }

    fn free(&self, joints: FingerJoints, gap: f64) -> Result<FingerJoints, Reason> {
        self.lone.free(&joints, TipRule::Clear(gap)).map(|()| joints).map_err(|_| Reason::Collision)
    }

    fn steps(&self, length: f64) -> usize {
        (length / self.step).ceil().max(1.0) as usize
    }
}
// ANCHOR_END: flight

// ANCHOR: hop
impl Flight<'_> {
    /// Straight up from a contact to a height (m); nothing for a finger that is free.
    fn lift(&self, end: End<'_>, height: f64) -> Way {
        let Some(contact) = end.contact else { return Ok(Vec::new()) };
        let count = self.steps(height);
        let mut near = *end.joints;
        let rise = |i| {
            near = self.above(contact, height * i as f64 / count as f64, &near)?;
            Ok(near)
        };
        (1..=count).map(rise).collect()
    }

    /// All joints at once, from a free posture to a free posture.
    fn straight(&self, from: &FingerJoints, to: &FingerJoints) -> Way {
        let tip = |joints| self.task.hand.tip_center(self.finger, joints);
        // Joints that turn without moving the tip move the links: a radian counts as 50 mm.
        let length = (tip(from) - tip(to)).norm().max(0.05 * from.max_difference(to));
        let count = self.steps(2.0 * length);
        (1..=count).map(|i| self.free(from.interpolate(to, i as f64 / count as f64), self.clear())).collect()
    }

    /// The whole way at one height (m).
    fn hop(&self, start: End<'_>, target: End<'_>, height: f64) -> Way {
        let (mut way, mut down) = (self.lift(start, height)?, self.lift(target, height)?);
        let high = *way.last().unwrap_or(start.joints);
        let over = *down.last().unwrap_or(target.joints);
        way.extend(self.straight(&high, &over)?);
        down.pop();
        way.extend(down.into_iter().rev());
        if target.contact.is_some() {
            way.push(*target.joints);
        }
        Ok(way)
    }
}
// ANCHOR_END: hop

// ANCHOR: heights
impl Hop {
    /// The first height at which nothing is in the way; the reason of the lowest where there is none.
    fn over(
        &self,
        flight: &Flight<'_>,
        start: End<'_>,
        target: End<'_>,
        context: &Context<'_>,
    ) -> Result<Way, CallError> {
        // A little higher, so that rounding leaves the finger no lower than where it counts as lifted.
        let lift = 1.01 * flight.task.resolution.lift;
        let mut first = None;
        for i in 1..=self.settings.heights {
            context.proceed()?;
            match flight.hop(start, target, lift * i as f64) {
                Ok(way) => return Ok(Ok(way)),
                Err(reason) => first = first.or(Some(reason)),
            }
        }
        Ok(Err(first.unwrap_or(Reason::Budget)))
    }
}

/// Whether the other fingers hold the object: their grasp does not change during the motion.
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
// ANCHOR_END: heights

// ANCHOR: role
impl LocalPlanner for Hop {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        mut path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        context.count_call(Slot::RegraspPlanner);
        let &Target::Regrasp { finger, contact, joints } = to else {
            let reason = "it moves one finger; use it in the slot `local-planner.regrasp`".into();
            return Err(CallError::Unsupported { plugin: ENTRY.id.into(), reason });
        };
        context.proceed()?;
        if let Some(path) = path.as_deref_mut() {
            path.restart(from);
        }
        let way = if others_hold(task, from, finger, context)? {
            let lone = task.clearance.lone_finger(finger, from, FingerSet::first(from.joints.len()));
            let step = self.settings.step * task.resolution.regrasp_step;
            let flight = Flight { task, from, finger, lone, step };
            let start = End { contact: from.contacts[finger].as_ref(), joints: &from.joints[finger] };
            self.over(&flight, start, End { contact, joints }, context)?
        } else {
            Err(Reason::Stability)
        };
        let way = match way {
            Ok(way) => way,
            Err(reason) => {
                let stop = Some(context.reject(Slot::RegraspPlanner, reason));
                return Ok(Reached { end: from.clone(), fraction: 0.0, stop });
            }
        };
        let mut end = from.clone();
        (end.joints[finger], end.contacts[finger]) = (*joints, contact.copied());
        if let Some(path) = path {
            store(path, &end, finger, &way);
        }
        Ok(Reached { end, fraction: 1.0, stop: None })
    }
}

/// Appends the motion to the path; the finger touches nothing before the end.
fn store(path: &mut Path, end: &Configuration, finger: FingerIndex, way: &[FingerJoints]) {
    let mut moving = end.clone();
    moving.contacts[finger] = None;
    for posture in &way[..way.len().saturating_sub(1)] {
        moving.joints[finger] = *posture;
        path.states.push(moving.clone());
    }
    path.states.push(end.clone());
}
// ANCHOR_END: role

// ANCHOR: entry
/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "local-planner/hop",
    slots: &[Slot::RegraspPlanner],
    summary: "lifts the finger, goes straight in its joints, touches down; higher if something is in the way",
    references: &[
        "Sahbani, Saut, Perdereau, An efficient algorithm for dexterous manipulation planning, SSD 2007",
    ],
    schema: HopSettings::schema,
    check: check_settings::<HopSettings>,
    build: Build::LocalPlanner(|json, _parts| Ok(Box::new(Hop::new(HopSettings::from_json(json)?)?))),
};
regrasp_api::inventory::submit! { ENTRY }
// ANCHOR_END: entry
