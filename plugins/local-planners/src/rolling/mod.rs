//! `local-planner/rolling`: the object moves straight, the fingertips roll on it without slip.

pub(crate) mod constraint;
mod jump;
mod roller;
mod span;
mod step;

use crate::common::{Levers, largest_travel, wrong_target};
use crate::transfer::{Motion, Pace, demand_fingertip};
use regrasp_api::{
    Build, CallError, Configuration, Context, Entry, Fingertip, Hand, Hint, LocalPlanner, Mesh, Path, Pose,
    Reached, Reason, Settings, SettingsError, Slot, Target, Task, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use step::{Failure, Roller, State};

const ID: &str = "local-planner/rolling";
const SLOT: Slot = Slot::TransferPlanner;

/// Settings of [`Rolling`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RollingSettings {
    /// What part of the task's tolerances for closure and slip the motion may use. Default: half, as the
    /// plan's meaning asks.
    #[schemars(range(min = 0.01, max = 1.0), extend("x-unit" = "1"))]
    pub tolerance_share: f64,
    /// How often a step may be halved before the contact counts as lost. Our choice.
    #[schemars(range(min = 0, max = 20))]
    pub halvings: usize,
    /// How far (rad) a contact that carries torsion may spin in one transfer. A soft finger creeps by some
    /// millimetres a radian of spin; set down anew it begins from nothing. With point contacts it means
    /// nothing.
    #[schemars(range(min = 0.01, max = 100.0), extend("x-unit" = "rad"))]
    pub spin: f64,
}

/// The spin that is allowed by default (rad).
const SPIN: f64 = 0.6;

impl Default for RollingSettings {
    fn default() -> Self {
        Self { tolerance_share: 0.5, halvings: 8, spin: SPIN }
    }
}

impl Settings for RollingSettings {}

/// Moves the object straight to a pose while every holding fingertip rolls on it without slip; free fingers
/// stay.
///
/// At every instant the material points of fingertip and object at each contact have the same velocity (Cole,
/// Hauser, Sastry, "Kinematics and control of multifingered hands with rolling contact", IEEE T-AC 1989;
/// Montana, "The kinematics of contact and grasp", IJRR 1988). This is solved for the joint speeds of each
/// finger and integrated numerically, as the paper does (Sahbani, Saut, Perdereau, SSD 2007, section IV.C),
/// by the midpoint rule. Departures from it: the normal is the direction from the closest point to the
/// fingertip's centre, which needs no parameterisation of the object and is exact on its facets; after each
/// step the centre is moved along that normal onto the offset surface, so that closure does not drift; steps
/// are halved until the interpolated motion keeps its share of the tolerances.
///
/// The fingertips are balls: a hand that declares points is refused when the plugin is built from its entry.
///
/// Stops at the last valid state: at a joint's limit, out of reach or at a singularity (`reach`), at a
/// collision, where the grasp is no longer stable, where net slip at a state uses up its share (within a step
/// the tip may stray along the surface by as much as closure allows across it), where a contact that carries
/// torsion has spun as far as it may (`slip` too: that is what comes of it), and where a contact is lost,
/// or touches at a second place as well (`closure`). In a mild dent it goes on upon the other side, which the
/// fingertip touches at that instant, too: the contact jumps, by [`regrasp_api::LONGEST_JUMP`] at most, and
/// the fingertip does not.
#[derive(Clone, Debug)]
pub struct Rolling {
    settings: RollingSettings,
    levers: Levers,
    /// Whether the object is convex, so that no contact can jump.
    is_convex: bool,
}

impl Rolling {
    /// A planner with these settings for this hand and any object, or why they are refused.
    pub fn new(settings: RollingSettings, hand: &dyn Hand) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings, levers: Levers::new(hand), is_convex: false })
    }

    /// The same for objects of this mesh alone: quicker where it is convex.
    pub fn for_object(
        settings: RollingSettings,
        hand: &dyn Hand,
        mesh: &Mesh,
    ) -> Result<Self, SettingsError> {
        Ok(Self { is_convex: jump::is_convex(mesh), ..Self::new(settings, hand)? })
    }

    fn roller<'a>(&'a self, task: &'a Task<'a>, from: &Configuration, to: &Pose) -> Roller<'a> {
        Roller {
            task,
            levers: &self.levers,
            motion: Motion::new(&from.X_HO, to),
            holding: from.holding(),
            is_convex: self.is_convex,
            radius: task.hand.fingertip_radius(),
            closure: self.settings.tolerance_share * task.tolerances.closure,
            slip: self.settings.tolerance_share * task.tolerances.slip,
            spin: if carries_torsion(task, from) { self.settings.spin } else { f64::INFINITY },
            reach: task.resolution.transfer_step,
            travel: largest_travel(task.resolution),
        }
    }
}

impl LocalPlanner for Rolling {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        context.count_call(SLOT);
        let mut reached = self.roll(task, from, to, path, context)?;
        reached.stop = reached.stop.map(|reason| context.reject(SLOT, reason));
        Ok(reached)
    }
}

impl Rolling {
    /// What [`LocalPlanner::connect`] does, a refusal not yet counted: it is left to who builds upon the
    /// motion.
    pub(crate) fn roll(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        mut path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let Target::Transfer(to) = to else { return Err(wrong_target(ID, SLOT)) };
        if let Some(path) = path.as_deref_mut() {
            path.restart(from);
        }
        let roller = self.roller(task, from, to);
        // Two states in turn: the one that is reached and the one that is tried.
        let mut state = roller.start(from);
        let mut next = state.clone();
        let mut pace = Pace::new(roller.motion.step(task.resolution), self.settings.halvings);
        let (mut hint, mut stop) = (Hint::default(), None);
        while state.s < 1.0 && stop.is_none() {
            context.proceed()?;
            stop = obstacle(&roller, &state, &mut next, &mut pace, &mut hint, context)?;
            if stop.is_none() {
                std::mem::swap(&mut state, &mut next);
                if let Some(path) = path.as_deref_mut() {
                    path.states.push(state.q.clone());
                }
            }
        }
        Ok(Reached { end: state.q, fraction: state.s, stop })
    }
}

/// Whether a contact carries torsion, and so drags and creeps while it spins.
fn carries_torsion(task: &Task<'_>, q: &Configuration) -> bool {
    let mu = task.planning_friction();
    let contacts = q.contacts.iter().filter_map(|(finger, contact)| Some((finger, contact.as_ref()?)));
    contacts
        .into_iter()
        .any(|(finger, contact)| task.contact_model.cone(finger, contact, mu).carries_torsion())
}

/// Makes `next` the next valid state, or says why there is none: stability before collision, because it costs
/// less.
fn obstacle(
    roller: &Roller<'_>,
    state: &State,
    next: &mut State,
    pace: &mut Pace,
    hint: &mut Hint,
    context: &mut Context<'_>,
) -> Result<Option<Reason>, CallError> {
    let Roller { task, holding, .. } = roller;
    if let Err(reason) = step(roller, state, next, pace) {
        return Ok(Some(reason));
    }
    if !task.stability.test(&task.transfer_grasp(&next.q, *holding), hint, context)?.is_stable() {
        return Ok(Some(Reason::Stability));
    }
    let free = task.clearance.configuration_free(&next.q, *holding, true);
    Ok(free.is_err().then_some(Reason::Collision))
}

/// Steps as far as the pace, the state and what remains allow, halving until the contacts stay closed in
/// between.
fn step(roller: &Roller<'_>, state: &State, next: &mut State, pace: &mut Pace) -> Result<(), Reason> {
    if state.longest < pace.finest {
        // So close to a singularity that a joint races.
        return Err(Reason::Reach);
    }
    let mut h = pace.next(state.longest, 1.0 - state.s);
    while h >= 0.5 * pace.finest {
        match roller.advance(state, h, next) {
            Ok(()) => return Ok(()),
            Err(Failure::Finer) => h = pace.halve(h),
            Err(Failure::Stop(reason)) => return Err(reason),
        }
    }
    Err(Reason::Closure)
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[SLOT],
        summary: "the object moves straight, fingertips roll without slip (midpoint rule on the velocity \
            constraint)",
        references: &[
            "A. Sahbani, J.-P. Saut, V. Perdereau, An efficient algorithm for dexterous manipulation \
             planning, SSD 2007",
            "A. Cole, J. Hauser, S. Sastry, Kinematics and control of multifingered hands with rolling \
             contact, IEEE T-AC 1989",
            "D. J. Montana, The kinematics of contact and grasp, IJRR 1988",
            "B. Kiss, J. Lévine, B. Lantos, On motion planning for robotic manipulation with permanent \
             rolling contacts, IJRR 2002",
        ],
        schema: RollingSettings::schema,
        check: check_settings::<RollingSettings>,
        build: Build::LocalPlanner(|json, parts| {
            demand_fingertip(Fingertip::Ball, parts.hand)?;
            let settings = RollingSettings::from_json(json)?;
            Ok(Box::new(Rolling::for_object(settings, parts.hand, parts.object.contact_mesh())?))
        }),
    }
}
