//! The efforts with which the fingers hold the object along a motion.

use crate::force::{ContactForce, Friction};
use crate::holding::{
    Balanced, Bearing, Forces, Press, Search, Smallest, share_between, share_of, smallest_share, stacked,
};
use crate::settings::SimulationSettings;
use crate::stage::Stage;
use nalgebra::Vector6;
use regrasp_api::{
    Configuration, EffortBounds, FingerIndex, FingerJoints, FingerSet, Hand, ObjectModel, PerFinger, Vec3,
};

/// How much of the friction that a stage leaves over its forces may rely on, so that efforts stay away from
/// their limits.
pub(crate) const EASE: f64 = 0.25;
/// How near the bounds of the smallest share are, relative to it, for one grasp by itself: what is taken is a
/// share some way above it.
const ROUGHLY: f64 = 0.1;
/// Shares of the friction below this are not striven for: nothing slips there, and squeezing harder has a
/// price.
pub(crate) const ENOUGH: f64 = 0.3;
/// Where even all friction holds nothing, what is tried is this much more than the smallest share that would.
pub(crate) const BEYOND: f64 = 1.05;

/// How the object is held at one configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// What each finger exerts on the object, given in H; `None` for fingers that do not hold it.
    pub forces: PerFinger<Option<ContactForce>>,
    /// The joints' efforts that exert this (N·m; N where prismatic): Jᵀ f, 0 for fingers that do not hold.
    /// The links' weight comes on top.
    pub efforts: PerFinger<FingerJoints>,
    /// The largest share of the friction that a force relies on (no unit). Above 1 no forces within cones and
    /// efforts hold the object, and these are the nearest.
    pub share: f64,
    /// The largest share of a joint's effort limit that the forces take (no unit).
    pub effort_share: f64,
    /// The least distance of a force from its friction cone (N), see [`Friction::margin`].
    pub margin: f64,
}

/// A grasp as its forces see it, in O.
struct Grip {
    fingers: Vec<FingerIndex>,
    bounds: Vec<EffortBounds>,
    bearings: Vec<Bearing>,
    wanted: Vector6<f64>,
}

/// Finds the forces of whole stages.
///
/// First the smallest share of the friction with which every state of the stage can be held, then for each
/// state the analytic centre of the forces that need a little more than that: unique and continuous along the
/// stage, inside the cones and the efforts.
pub(crate) struct Holder<'a> {
    hand: &'a dyn Hand,
    object: &'a ObjectModel,
    /// Gravity in H (m/s²).
    g_H: Vec3,
    friction: Friction,
    press: Press,
    relied: f64,
    length: f64,
}

impl<'a> Holder<'a> {
    /// For this friction, and an object of its own mass under gravity `g_H` (m/s²).
    pub fn new(
        (hand, object, g_H): (&'a dyn Hand, &'a ObjectModel, Vec3),
        friction: Friction,
        settings: &SimulationSettings,
    ) -> Self {
        let press = Press { max_normal_force: settings.grip, effort_share: settings.effort_share };
        let length = object.mesh.radius().max(1e-6);
        Self { hand, object, g_H, friction, press, relied: settings.relied, length }
    }

    /// How the fingers hold the object in each state of a stage, by the forces that it brings where it brings
    /// any; `None` where no forces of any friction do.
    pub fn stage(&self, stage: &Stage<'_>) -> Vec<Option<Held>> {
        let brought = |k: usize| stage.forces.get(k).and_then(Option::as_ref);
        let mut all = vec![None; stage.states.len()];
        for (k, (q, held)) in stage.states.iter().zip(&mut all).enumerate() {
            *held = brought(k).map(|forces| self.brought(q, stage.holding(q), forces));
        }
        if all.iter().any(Option::is_none) {
            let chosen = self.choose(stage, &[]);
            all.iter_mut().zip(chosen).for_each(|(held, chosen)| *held = held.take().or(chosen));
        }
        all
    }

    /// Forces for all states of a stage; `drags` are the contacts' [`Friction::drag`] in each, none where
    /// there are none.
    pub fn choose(&self, stage: &Stage<'_>, drags: &[PerFinger<f64>]) -> Vec<Option<Held>> {
        let states = stage.states;
        let grips = |press: &Press| -> Vec<Grip> {
            let each = states.iter().enumerate();
            each.map(|(k, q)| self.grip(q, stage.holding(q), press, drags.get(k))).collect()
        };
        let mut made = grips(&self.press);
        let mut needed = needs(&made);
        if needed.iter().any(|need| need.as_ref().is_none_or(|need| need.share > self.relied)) {
            // Joints at their limits have nothing left to correct with, but dropping the object is worse.
            made = grips(&Press { effort_share: 1.0, ..self.press });
            needed = needs(&made);
        }
        let shares = needed.iter().flatten().map(|need| need.share).filter(|share| *share <= 1.0);
        let most = shares.fold(ENOUGH.min(self.relied), f64::max);
        let eased = most + EASE * (self.relied - most).max(0.0);
        let mut from = None;
        let each = states.iter().zip(&made).zip(&needed);
        each.map(|((q, grip), need)| {
            let need = need.as_ref()?;
            let share = if need.share <= 1.0 { eased } else { need.share * BEYOND };
            let forces = centre(grip, share, from.as_ref()).unwrap_or(need.forces);
            from = Some(forces);
            Some(self.found(q, grip, &forces))
        })
        .collect()
    }

    /// How all fingers that touch hold the object at rest: by the analytic centre of the forces that need at
    /// most `share` of the friction; where there are none, of those that need little more than the least, and
    /// `None` where that is more than may be relied on.
    pub fn one(&self, q: &Configuration, share: f64) -> Option<Held> {
        let holding = q.holding();
        let grip = self.grip(q, holding, &self.press, None);
        if let Some(forces) = centre(&grip, share, None) {
            return Some(self.found(q, &grip, &forces));
        }
        let most = self.relied;
        let need = |grip: &Grip, low: f64| {
            share_between(&grip.bearings, &grip.wanted, (low.min(most), most), (most, ROUGHLY))
        };
        let (grip, need) = match need(&grip, share) {
            Some(need) => (grip, need),
            // Joints at their limits have nothing left to correct with, but dropping the object is worse.
            None => {
                let roomy = self.grip(q, holding, &Press { effort_share: 1.0, ..self.press }, None);
                let need = need(&roomy, 0.0)?;
                (roomy, need)
            }
        };
        let eased = need.share + EASE * (most - need.share).max(0.0);
        let forces = centre(&grip, eased, Some(&need.forces)).unwrap_or(need.forces);
        Some(self.found(q, &grip, &forces))
    }

    fn grip(
        &self,
        q: &Configuration,
        holding: FingerSet,
        press: &Press,
        drags: Option<&PerFinger<f64>>,
    ) -> Grip {
        let to_O = q.X_HO.rotation.inverse();
        let weight = to_O * self.g_H * self.object.mass;
        let wanted = stacked(&-weight, &Vec3::zeros());
        let mut grip = Grip { fingers: vec![], bounds: vec![], bearings: vec![], wanted };
        for (finger, contact) in q.contacts.iter() {
            let (Some(contact), true) = (contact, holding.contains(finger)) else { continue };
            let bounds = EffortBounds::at(self.hand, finger, &q.joints[finger], &q.X_HO, &contact.n_O);
            let r_O = contact.p_OC - self.object.p_OCm;
            let place = (&r_O, &contact.n_O);
            let friction = drags.map_or(self.friction, |drags| self.friction.dragging(drags[finger]));
            grip.bearings.push(Bearing::new(place, &friction, &bounds, press, self.length));
            grip.fingers.push(finger);
            grip.bounds.push(bounds);
        }
        grip
    }

    fn found(&self, q: &Configuration, grip: &Grip, forces: &Forces) -> Held {
        let in_O: Vec<_> = grip.bearings.iter().zip(forces).map(|(b, x)| b.force(x)).collect();
        self.held(q, grip, &in_O, share_of(&grip.bearings, forces))
    }

    /// What forces (N, in O) that were chosen before ask for.
    fn brought(&self, q: &Configuration, holding: FingerSet, forces: &PerFinger<Option<Vec3>>) -> Held {
        let grip = self.grip(q, holding, &self.press, None);
        let of_finger = |&finger: &FingerIndex| ContactForce::pure(forces[finger].unwrap_or_default());
        let in_O: Vec<_> = grip.fingers.iter().map(of_finger).collect();
        let share = |(&finger, exerted): (&FingerIndex, &ContactForce)| {
            q.contacts[finger].map_or(0.0, |contact| self.friction.share(&contact.n_O, &exerted.force))
        };
        let share = grip.fingers.iter().zip(&in_O).map(share).fold(0.0, f64::max);
        self.held(q, &grip, &in_O, share)
    }

    fn held(&self, q: &Configuration, grip: &Grip, forces: &[ContactForce], share: f64) -> Held {
        let mut held = Held {
            forces: PerFinger::filled(q.joints.len(), None),
            efforts: PerFinger::from_fn(q.joints.len(), |f| FingerJoints::zeros(q.joints[f].len())),
            share,
            effort_share: 0.0,
            margin: f64::INFINITY,
        };
        for (i, &finger) in grip.fingers.iter().enumerate() {
            let in_O = forces[i];
            let exerted = ContactForce { force: q.X_HO.rotation * in_O.force, spin: in_O.spin };
            let efforts = grip.bounds[i].efforts_of(&in_O.force, in_O.spin);
            let limits = grip.bounds[i].joints().iter().map(|joint| joint.limit);
            let taken = efforts.iter().zip(limits).map(|(effort, limit)| effort.abs() / limit);
            held.effort_share = taken.fold(held.effort_share, f64::max);
            if let Some(contact) = q.contacts[finger] {
                held.margin = held.margin.min(self.friction.margin(&contact.n_O, &in_O));
            }
            held.forces[finger] = Some(exerted);
            held.efforts[finger] = efforts;
        }
        held
    }
}

/// The smallest share of each state, as far as it tells of the stage: a state that can do with what an
/// earlier one needs counts with the share of the forces that were found.
fn needs(grips: &[Grip]) -> Vec<Option<Smallest>> {
    let mut most: Option<f64> = None;
    let mut before: Option<Smallest> = None;
    let each = grips.iter().map(|grip| {
        let bearings = &grip.bearings[..];
        if let (Some(share), Some(last)) = (most.filter(|share| *share <= 1.0), &before) {
            let search = Search { bearings, share };
            let start = if search.inside(&last.forces) { last.forces } else { search.start() };
            if let Balanced::Yes(forces) = search.any(&start, &grip.wanted) {
                before = Some(Smallest { share: share_of(bearings, &forces), forces });
                return before;
            }
        }
        let found = smallest_share(bearings, &grip.wanted, most.filter(|s| *s <= 1.0).unwrap_or(1.0))?;
        most = Some(most.unwrap_or(0.0).max(found.share));
        before = Some(found);
        Some(found)
    });
    each.collect()
}

/// The centre of the forces that need at most `share` of the friction, from those of the state before where
/// they are inside.
fn centre(grip: &Grip, share: f64, from: Option<&Forces>) -> Option<Forces> {
    let search = Search { bearings: &grip.bearings, share };
    let start = from.filter(|from| search.inside(from)).copied();
    match search.centre(&start.unwrap_or_else(|| search.start()), &grip.wanted) {
        Balanced::Yes(forces) => Some(forces),
        _ => None,
    }
}
