//! The forces of a whole motion whose contacts have cones of their own, of edges or elliptic.

use crate::hold::{BEYOND, EASE, ENOUGH};
use crate::holding::{
    Edged, EdgesBalanced, LARGEST, LEAST, Press, Weights, balance, centre_of_weights, may_start, stacked,
    start,
};
use crate::{PhysicsError, SimulationSettings, Stage};
use nalgebra::Vector6;
use regrasp_api::{Cone, Configuration, EffortBounds, FingerIndex, Hand, ObjectModel, PerFinger, Vec3};

/// How near the bounds of the smallest share are, relative to it.
const NEAR: f64 = 0.02;

/// For each state of a stage the cone of each contact, at all of the friction.
pub type StageCones = Vec<Vec<Option<Cone<'static>>>>;

/// The forces that hold an object in one state.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeForces {
    /// The force of each finger on the object, in O (N); `None` for fingers that do not hold it.
    pub forces: PerFinger<Option<Vec3>>,
    /// The share of the friction that the forces rely on at most (no unit); above 1 no forces within cones
    /// and efforts hold the object, and these are near.
    pub share: f64,
}

/// The forces without torques about the contacts' normals that need least of the friction within the joints'
/// efforts, chosen as [`crate::grasp_forces`] chooses them; `None` for states that none of any friction hold.
///
/// `cones` are those of each stage's states. An elliptic cone is replaced by edges on it.
pub fn edge_forces(
    (hand, object, g_H): (&dyn Hand, &ObjectModel, Vec3),
    stages: &[Stage<'_>],
    cones: &[StageCones],
    settings: &SimulationSettings,
) -> Result<Vec<Vec<Option<EdgeForces>>>, PhysicsError> {
    settings.validate()?;
    let press = Press { max_normal_force: settings.grip, effort_share: settings.effort_share };
    let length = object.mesh.radius().max(1e-6);
    let chooser = Chooser { hand, object, g_H, press, relied: settings.relied, length };
    Ok(stages.iter().zip(cones).map(|(stage, cones)| chooser.choose(stage, cones)).collect())
}

struct Chooser<'a> {
    hand: &'a dyn Hand,
    object: &'a ObjectModel,
    /// Gravity in H (m/s²).
    g_H: Vec3,
    press: Press,
    relied: f64,
    length: f64,
}

/// One contact that holds.
struct Pressing {
    finger: FingerIndex,
    /// From the centre of mass (m).
    r_O: Vec3,
    n_O: Vec3,
    cone: Cone<'static>,
    bounds: EffortBounds,
}

/// A grasp as its forces see it, in O.
struct Grip {
    fingers: usize,
    contacts: Vec<Pressing>,
    wanted: Vector6<f64>,
    press: Press,
    length: f64,
}

/// The smallest share of the friction that holds a grip, and weights that do.
#[derive(Clone)]
struct Need {
    share: f64,
    weights: Weights,
}

impl Chooser<'_> {
    fn choose(&self, stage: &Stage<'_>, cones: &StageCones) -> Vec<Option<EdgeForces>> {
        let grips = |press: Press| -> Vec<Grip> {
            let each = stage.states.iter().zip(cones);
            each.map(|(q, cones)| self.grip(stage, q, cones, press)).collect()
        };
        let mut made = grips(self.press);
        let mut needed = needs(&made);
        if needed.iter().any(|need| need.as_ref().is_none_or(|need| need.share > self.relied)) {
            // As for elliptic cones: joints at their limits before the object falls.
            made = grips(Press { effort_share: 1.0, ..self.press });
            needed = needs(&made);
        }
        let shares = needed.iter().flatten().map(|need| need.share).filter(|share| *share <= 1.0);
        let most = shares.fold(ENOUGH.min(self.relied), f64::max);
        let eased = most + EASE * (self.relied - most).max(0.0);
        let mut from: Option<Weights> = None;
        let each = made.iter().zip(needed);
        each.map(|(grip, need)| {
            let need = need?;
            let share = if need.share <= 1.0 { eased } else { need.share * BEYOND };
            let centred = grip.search(share, from.as_ref(), centre_of_weights);
            let (share, weights) = centred.map_or((need.share, need.weights), |weights| (share, weights));
            let forces = grip.forces(share, &weights);
            from = Some(weights);
            Some(EdgeForces { forces, share })
        })
        .collect()
    }

    fn grip(
        &self,
        stage: &Stage<'_>,
        q: &Configuration,
        cones: &[Option<Cone<'static>>],
        press: Press,
    ) -> Grip {
        let weight = q.X_HO.rotation.inverse() * self.g_H * self.object.mass;
        let holding = stage.holding(q);
        let pressing = |finger: FingerIndex| {
            let contact = q.contacts[finger].filter(|_| holding.contains(finger))?;
            Some(Pressing {
                finger,
                r_O: contact.p_OC - self.object.p_OCm,
                n_O: contact.n_O,
                cone: cones.get(finger.index())?.as_ref()?.without_torsion(),
                bounds: EffortBounds::at(self.hand, finger, &q.joints[finger], &q.X_HO, &contact.n_O),
            })
        };
        Grip {
            fingers: q.contacts.len(),
            contacts: q.contacts.fingers().filter_map(pressing).collect(),
            wanted: stacked(&-weight, &Vec3::zeros()),
            press,
            length: self.length,
        }
    }
}

impl Grip {
    /// The contacts at a share of their friction.
    fn edged(&self, share: f64) -> Vec<Edged> {
        let one = |contact: &Pressing| {
            let Pressing { r_O, n_O, cone, bounds, .. } = contact;
            Edged::new((r_O, n_O), cone, (share, 0.0), bounds, &self.press, self.length)
        };
        self.contacts.iter().map(one).collect()
    }

    /// The weights that `how` finds at a share of the friction, from others where it may begin there.
    fn search(
        &self,
        share: f64,
        from: Option<&Weights>,
        how: fn(&[Edged], &Weights, &Vector6<f64>) -> EdgesBalanced,
    ) -> Option<Weights> {
        let edged = self.edged(share);
        let own = || start(&edged);
        let from = from.filter(|from| may_start(&edged, from)).cloned().unwrap_or_else(own);
        match how(&edged, &from, &self.wanted) {
            EdgesBalanced::Yes(weights) => Some(weights),
            _ => None,
        }
    }

    /// The smallest share at which weights are found, beginning at `from`.
    fn need(&self, from: f64) -> Option<Need> {
        let find = |share: f64| self.search(share, None, balance).map(|weights| Need { share, weights });
        let (mut low, mut share) = (0.0, from);
        let mut best = loop {
            if let Some(found) = find(share) {
                break found;
            }
            if share >= LARGEST {
                return None;
            }
            (low, share) = (share, (2.0 * share).min(LARGEST));
        };
        while best.share - low > NEAR * best.share && best.share > LEAST {
            let middle = 0.5 * (low + best.share);
            match find(middle) {
                Some(found) => best = found,
                None => low = middle,
            }
        }
        Some(best)
    }

    /// The forces of weights at a share of the friction.
    fn forces(&self, share: f64, weights: &Weights) -> PerFinger<Option<Vec3>> {
        let mut forces = PerFinger::filled(self.fingers, None);
        for ((edged, contact), weights) in self.edged(share).iter().zip(&self.contacts).zip(weights) {
            forces[contact.finger] = Some(edged.force(weights).force);
        }
        forces
    }
}

/// The smallest share of each state, as far as it tells of the stage: a state that can do with what an
/// earlier one needs counts with that.
fn needs(grips: &[Grip]) -> Vec<Option<Need>> {
    let mut most: Option<f64> = None;
    let mut before: Option<Weights> = None;
    let each = grips.iter().map(|grip| {
        let known = most.filter(|share| *share <= 1.0);
        if let (Some(share), Some(last)) = (known, &before)
            && let Some(weights) = grip.search(share, Some(last), balance)
        {
            before = Some(weights.clone());
            return Some(Need { share, weights });
        }
        let found = grip.need(known.unwrap_or(1.0))?;
        most = Some(most.unwrap_or(0.0).max(found.share));
        before = Some(found.weights.clone());
        Some(found)
    });
    each.collect()
}
