//! A local planner for the slot `local-planner.regrasp`: lift the finger, slide it above the surface, touch
//! down.

use regrasp_api::{
    Build, CallError, Configuration, Contact, Context, Entry, FingerIndex, FingerJoints, FingerSet, Hint,
    LocalPlanner, LoneFinger, Path, Reached, Reason, Settings, SettingsError, Slot, SurfacePath, Target,
    Task, TipRule, check_settings,
};
use serde::{Deserialize, Serialize};

/// Settings of [`UpOverDown`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct UpOverDownSettings {
    /// The fingertip's step as a part of the problem's `regrasp_step` (no unit).
    #[schemars(range(min = 0.05, max = 1.0), extend("x-unit" = "1"))]
    pub step: f64,
}

impl Default for UpOverDownSettings {
    fn default() -> Self {
        Self { step: 0.3 }
    }
}

impl Settings for UpOverDownSettings {}

/// Moves one finger: up along the normal, along the shortest path on the surface, down along the new normal;
/// all or nothing.
#[derive(Clone, Copy, Debug)]
pub struct UpOverDown {
    settings: UpOverDownSettings,
}

impl UpOverDown {
    /// A local planner with checked settings.
    pub fn new(settings: UpOverDownSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }
}

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

    /// Straight up from a contact; nothing for a finger that is free.
    fn lift(&self, end: End<'_>) -> Way {
        let Some(contact) = end.contact else { return Ok(Vec::new()) };
        // A little higher, so that rounding leaves the finger no lower than where it counts as lifted.
        let lift = 1.01 * self.task.resolution.lift;
        let count = self.steps(lift);
        let mut near = *end.joints;
        (1..=count)
            .map(|i| {
                near = self.above(contact, lift * i as f64 / count as f64, &near)?;
                Ok(near)
            })
            .collect()
    }

    /// Above the path on the surface, from a lifted posture to a lifted posture.
    fn slide(&self, path: &SurfacePath, from: &FingerJoints, to: &FingerJoints) -> Way {
        // The fingertip's way is longer at a height than on the surface; twice is enough for objects larger
        // than the fingertip.
        let count = self.steps(2.0 * path.lift_length());
        let lift = 1.01 * self.task.resolution.lift;
        let mut near = *from;
        let mut way = Vec::with_capacity(count + 1);
        for i in 1..count {
            near = self.above(&path.at(i as f64 / count as f64), lift, &near)?;
            way.push(near);
        }
        way.extend(self.straight(&near, to)?);
        Ok(way)
    }

    /// All joints at once, from a free posture to a free posture.
    fn straight(&self, from: &FingerJoints, to: &FingerJoints) -> Way {
        let tip = |joints| self.task.hand.tip_center(self.finger, joints);
        // Joints that turn without moving the tip move the links: a radian counts as 50 mm.
        let length = (tip(from) - tip(to)).norm().max(0.05 * from.max_difference(to));
        let count = self.steps(2.0 * length);
        (1..=count).map(|i| self.free(from.interpolate(to, i as f64 / count as f64), self.clear())).collect()
    }

    /// The whole way.
    fn fly(&self, start: End<'_>, target: End<'_>, context: &mut Context<'_>) -> Result<Way, CallError> {
        let (mut way, mut down) = match (self.lift(start), self.lift(target)) {
            (Ok(up), Ok(down)) => (up, down),
            (Err(reason), _) | (_, Err(reason)) => return Ok(Err(reason)),
        };
        context.proceed()?;
        let high = *way.last().unwrap_or(start.joints);
        let over = *down.last().unwrap_or(target.joints);
        let middle = match (start.contact, target.contact) {
            (Some(a), Some(b)) => {
                let mut path = SurfacePath::default();
                if !self.task.surface.geodesic(a, b, &mut path, context)? {
                    return Ok(Err(Reason::Surface));
                }
                self.slide(&path, &high, &over)
            }
            _ => self.straight(&high, &over),
        };
        Ok(middle.map(|middle| {
            way.extend(middle);
            down.pop();
            way.extend(down.into_iter().rev());
            if target.contact.is_some() {
                way.push(*target.joints);
            }
            way
        }))
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

impl LocalPlanner for UpOverDown {
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
            flight.fly(start, End { contact, joints }, context)?
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

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "local-planner/template",
    slots: &[Slot::RegraspPlanner],
    summary: "lifts the finger, slides it above the surface, touches down",
    references: &[
        "Sahbani, Saut, Perdereau, An efficient algorithm for dexterous manipulation planning, SSD 2007",
    ],
    schema: UpOverDownSettings::schema,
    check: check_settings::<UpOverDownSettings>,
    build: Build::LocalPlanner(|json, _parts| {
        Ok(Box::new(UpOverDown::new(UpOverDownSettings::from_json(json)?)?))
    }),
};
