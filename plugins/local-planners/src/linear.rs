//! `local-planner/linear`: straight on in GS_n, the contacts sliding along geodesics.

use crate::common::{Halving, bisection, refuse, with_spare, wrong_target};
use regrasp_api::{
    Build, CallError, Configuration, Contact, Context, Entry, Hint, LocalPlanner, MAX_FINGERS, Path, Reached,
    Reason, Settings, SettingsError, Slot, SurfacePath, Target, Task, angle_between, check_settings,
    interpolate,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

const ID: &str = "local-planner/linear";
const SLOT: Slot = Slot::GraspPlanner;

/// Settings of [`Linear`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LinearSettings {
    /// Largest change of a joint (rad; m where prismatic) from one state to the next: more is a jump to
    /// another branch of the inverse kinematics. Our choice: close to a stretched finger a step of 1.5 mm
    /// turns the joint by 0.3 rad.
    #[schemars(range(min = 0.01, max = 3.0), extend("x-unit" = "rad; m where prismatic"))]
    pub joint_jump: f64,
}

impl Default for LinearSettings {
    fn default() -> Self {
        Self { joint_jump: 0.4 }
    }
}

impl Settings for LinearSettings {}

/// Joins two configurations of GS_n: the pose moves straight, every contact slides along its geodesic,
/// inverse kinematics closes the chains, free fingers move their joints straight.
///
/// All or nothing. A look at three places with guessed contacts refuses most of what would fail. The states
/// of other paths are checked coarse to fine, because a path that fails mostly fails in a stretch of many
/// steps. What is stored cannot be executed (contacts slide, possibly across sharp edges); it is what
/// decomposition aims at (Sahbani, Saut, Perdereau, SSD 2007, section IV.B; the reduction property is that of
/// Alami, Siméon, Laumond, ISRR 1989).
#[derive(Clone, Debug)]
pub struct Linear {
    settings: LinearSettings,
}

impl Linear {
    /// A planner with these settings, or why they are refused.
    pub fn new(settings: LinearSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }
}

/// Memory that a call uses and leaves to the next one on the same thread.
#[derive(Default)]
struct Scratch {
    slides: [SurfacePath; MAX_FINGERS],
    /// States in the order in which they were checked; 0 and 1 are the ends.
    states: Vec<Configuration>,
    /// Where in `states` each step of the path is.
    places: Vec<usize>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl LocalPlanner for Linear {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        mut path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        context.count_call(SLOT);
        let Target::Grasp(to) = to else { return Err(wrong_target(ID, SLOT)) };
        if let Some(path) = path.as_deref_mut() {
            path.restart(from);
        }
        context.proceed()?;
        let mut scratch = SCRATCH.take();
        let obstacle = self.obstacle(task, from, to, &mut scratch, context)?;
        if let (None, Some(path)) = (obstacle, path) {
            path.states.extend(scratch.places[1..].iter().map(|&place| scratch.states[place].clone()));
        }
        SCRATCH.replace(scratch);
        Ok(match obstacle {
            Some(reason) => refuse(SLOT, reason, from, context),
            None => Reached { end: (*to).clone(), fraction: 1.0, stop: None },
        })
    }
}

impl Linear {
    /// What is in the way, if anything; otherwise `scratch` holds the path.
    fn obstacle(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Configuration,
        scratch: &mut Scratch,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        if from.holding() != to.holding() {
            return Ok(Some(Reason::Closure));
        }
        scratch.states.clear();
        scratch.states.extend([from.clone(), to.clone()]);
        if let Some(reason) = foreseen(task, (from, to), &mut from.clone()) {
            return Ok(Some(reason));
        }
        let count = match steps(task, (from, to), &mut scratch.slides, context)? {
            Ok(count) => count,
            Err(reason) => return Ok(Some(reason)),
        };
        scratch.places.clear();
        scratch.places.resize(count + 1, 0);
        scratch.places[count] = 1;
        let mut hint = Hint::default();
        for (checked, halving) in bisection(count).enumerate() {
            if checked % 16 == 0 {
                context.proceed()?;
            }
            if let Err(reason) = push_between(task, scratch, halving, count) {
                return Ok(Some(reason));
            }
            let state = &scratch.states[scratch.places[halving.middle]];
            if let Some(reason) = fault(task, state, &mut hint, context)? {
                return Ok(Some(reason));
            }
        }
        Ok(self.jumps(scratch).then_some(Reason::Closure))
    }

    /// Whether some joint jumps between neighbouring states.
    fn jumps(&self, scratch: &Scratch) -> bool {
        scratch.places.windows(2).any(|pair| {
            let (a, b) = (&scratch.states[pair[0]].joints, &scratch.states[pair[1]].joints);
            a.iter().any(|(finger, joints)| joints.max_difference(&b[finger]) > self.settings.joint_jump)
        })
    }
}

/// Where a path is looked at before its geodesics are laid: the middle first, where most of those that fail
/// do.
const LOOKS: [f64; 3] = [0.5, 0.25, 0.75];

/// What seems to be in the way, with the contacts guessed.
///
/// A heuristic: four geodesics cost as much as dozens of looks, and most paths fail. One in thirty of the
/// paths that would succeed is refused (ring and bracket: one in twenty), and of those that fail nine in ten
/// with ball and ellipsoid, a third to two thirds with bracket and ring, one in ten with the cube.
fn foreseen(
    task: &Task<'_>,
    (from, to): (&Configuration, &Configuration),
    q: &mut Configuration,
) -> Option<Reason> {
    let all = q.joints.fingers().collect();
    for s in LOOKS {
        q.X_HO = interpolate(&from.X_HO, &to.X_HO, s);
        for (finger, joints) in from.joints.iter() {
            let near = joints.interpolate(&to.joints[finger], s);
            q.joints[finger] = near;
            let (Some(a), Some(b)) = (&from.contacts[finger], &to.contacts[finger]) else { continue };
            // Where no guess can be made, nothing is foreseen.
            let center = guess(task, (a, b), s)?.tip_center(task.hand.fingertip_radius());
            let p_HF = q.X_HO.rotation * center + q.X_HO.translation.vector;
            match task.hand.inverse(finger, &p_HF, &near) {
                Some(joints) => q.joints[finger] = joints,
                None => return Some(Reason::Reach),
            }
        }
        if task.clearance.configuration_free(q, all, true).is_err() {
            return Some(Reason::Collision);
        }
    }
    None
}

/// A guess at the contact a fraction `s` of the way from `a` to `b`: exact on a ball; `None` where the two
/// lie nearly opposite.
fn guess(task: &Task<'_>, (a, b): (&Contact, &Contact), s: f64) -> Option<Contact> {
    let n_O = (a.n_O * (1.0 - s) + b.n_O * s).try_normalize(0.1)?;
    // Far enough out to lie outside of most objects, where projecting is quick.
    let out = 0.5 * (b.p_OC - a.p_OC).norm() + task.hand.fingertip_radius();
    let hint = if s < 0.5 { a.facet } else { b.facet };
    Some(task.surface.project(&(a.p_OC.lerp(&b.p_OC, s) + n_O * out), Some(hint)).contact)
}

/// Lays the geodesics and counts the steps, at least 1; or says what is in the way.
fn steps(
    task: &Task<'_>,
    (from, to): (&Configuration, &Configuration),
    slides: &mut [SurfacePath; MAX_FINGERS],
    context: &mut Context<'_>,
) -> Result<Result<usize, Reason>, CallError> {
    let resolution = task.resolution;
    let distance = (to.X_HO.translation.vector - from.X_HO.translation.vector).norm();
    let angle = angle_between(&from.X_HO.rotation, &to.X_HO.rotation);
    let mut steps = (distance / resolution.grasp_step).max(angle / resolution.grasp_turn);
    for (finger, contact) in from.contacts.iter() {
        if let (Some(a), Some(b)) = (contact, &to.contacts[finger]) {
            let slide = &mut slides[finger.index()];
            if !task.surface.geodesic(a, b, slide, context)? {
                return Ok(Err(Reason::Surface));
            }
            steps = steps.max(slide.lift_length() / resolution.grasp_step);
        }
    }
    Ok(Ok((steps.ceil() as usize).max(1)))
}

/// Appends the closed configuration at one step, with the joints near those of its neighbours.
fn push_between(
    task: &Task<'_>,
    scratch: &mut Scratch,
    halving: Halving,
    count: usize,
) -> Result<(), Reason> {
    let s = halving.middle as f64 / count as f64;
    let Scratch { slides, states, places } = scratch;
    let [low, high] = [halving.ends.0, halving.ends.1].map(|end| places[end]);
    places[halving.middle] = states.len();
    states.push(states[low].clone());
    let (known, fresh) = states.split_at_mut(places[halving.middle]);
    let (from, to, q) = (&known[0], &known[1], &mut fresh[0]);
    q.X_HO = interpolate(&from.X_HO, &to.X_HO, s);
    for (finger, contact) in from.contacts.iter() {
        let ends = (&from.joints[finger], &to.joints[finger]);
        if contact.is_none() {
            q.joints[finger] = ends.0.interpolate(ends.1, s);
            continue;
        }
        let contact = slides[finger.index()].at(s);
        let p_HF =
            q.X_HO.rotation * contact.tip_center(task.hand.fingertip_radius()) + q.X_HO.translation.vector;
        let near = q.joints[finger].interpolate(&known[high].joints[finger], halving.fraction());
        let near = with_spare(&task.hand.finger(finger).spare, &near, ends, s);
        q.joints[finger] = task.hand.inverse(finger, &p_HF, &near).ok_or(Reason::Reach)?;
        q.contacts[finger] = Some(contact);
    }
    Ok(())
}

/// What is wrong with a closed configuration: stability first, because it costs less than collision.
///
/// Transfers are to follow the path, so the grasp must hold as it does in a transfer.
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
    let all = q.joints.fingers().collect();
    Ok(task.clearance.configuration_free(q, all, true).is_err().then_some(Reason::Collision))
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[SLOT],
        summary: "pose and free joints move straight, contacts slide along geodesics, inverse kinematics \
            closes the chains",
        references: &[
            "A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation \
                planning, SSD 2007",
        ],
        schema: LinearSettings::schema,
        check: check_settings::<LinearSettings>,
        build: Build::LocalPlanner(|json, _| Ok(Box::new(Linear::new(LinearSettings::from_json(json)?)?))),
    }
}
