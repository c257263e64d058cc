//! The efforts with which the fingers hold the object along a motion.

use crate::force::{ContactForce, Friction};
use crate::grip::{Grip, GripContact, Press, balanced, best_grip, margin};
use crate::settings::SimulationSettings;
use regrasp_api::{
    Configuration, FingerIndex, FingerJoints, FingerSet, Hand, ObjectModel, PerFinger, Rotation, Vec3,
};

/// The margin (of the weight) below which a grip is a poor one, and that which is striven for with all efforts.
///
/// Not more than that: fingers that squeeze hard make a grasp unstable (the contacts' forces turn with the object, against the motors'
/// stiffness), and joints at their limits have nothing left to correct with.
const POOR: f64 = 0.1;
const ENOUGH: f64 = 0.5;

/// The parts of the friction that forces rely on, the first that gives a good grip: where fingers press hard, a margin in newtons alone would let
/// forces slip that are one part in a hundred off their way.
const PARTS: [f64; 2] = [0.95, 1.0];

/// What part of a solved margin forces that are carried along must keep.
const KEPT: f64 = 0.8;

/// How the object is held at one configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// What each finger exerts on the object, given in H; `None` for fingers that do not hold it.
    pub forces: PerFinger<Option<ContactForce>>,
    /// The joints' efforts that exert this (N·m; N where prismatic): Jᵀ f, 0 for fingers that do not hold. The links' weight comes on top.
    pub efforts: PerFinger<FingerJoints>,
    /// The least distance of a force from its friction cone (N), see [`Friction::margin`], by the object's own friction. Where it is not positive, no forces
    /// within the cones and the joints' efforts hold the object, and these are the nearest.
    pub margin: f64,
}

/// Finds the grip at one configuration after another.
///
/// A grip that was solved is carried along while the contacts roll: its forces turn with the contacts' normals and the least change of
/// norm balances them again. They are solved anew where that costs more than a part of the margin, or leaves the bounds.
pub(crate) struct Holder<'a> {
    hand: &'a dyn Hand,
    object: &'a ObjectModel,
    /// The object's weight in H (N).
    weight: Vec3,
    friction: Friction,
    most: f64,
    share: f64,
    last: Option<Solved>,
}

struct Solved {
    contacts: Vec<GripContact>,
    grip: Grip,
    /// The friction that its forces rely on, and their margin by it when they were solved (N); 0 where they were found with all efforts, and are not
    /// carried along.
    friction: Friction,
    margin: f64,
}

impl<'a> Holder<'a> {
    /// For forces that rely on at most this friction, and an object of its own mass under gravity `g_H` (m/s²).
    pub fn new(
        (hand, object, g_H): (&'a dyn Hand, &'a ObjectModel, Vec3),
        friction: Friction,
        settings: &SimulationSettings,
    ) -> Self {
        let weight = g_H * object.mass;
        let most = settings.grip.unwrap_or((3.0 * weight.norm()).max(2.0));
        Self { hand, object, weight, friction, most, share: settings.effort_share, last: None }
    }

    /// How the fingers of `holding` hold the object at `q`; `None` where no forces of any direction do.
    pub fn hold(&mut self, q: &Configuration, holding: FingerSet) -> Option<Held> {
        let contacts = self.contacts(q, holding);
        let carried = self.last.take().and_then(|last| self.carry(last, &contacts));
        let solved = match carried {
            Some(carried) => carried,
            None => self.solve(&contacts)?,
        };
        let forces = &solved.grip.forces;
        let mut held = Held {
            forces: PerFinger::filled(q.joints.len(), None),
            efforts: PerFinger::from_fn(q.joints.len(), |f| FingerJoints::zeros(q.joints[f].len())),
            margin: margin(&contacts, forces, &self.friction),
        };
        for (contact, exerted) in contacts.iter().zip(forces) {
            held.forces[contact.finger] = Some(*exerted);
            held.efforts[contact.finger] = contact.efforts_of(exerted);
        }
        self.last = Some(solved);
        Some(held)
    }

    /// The grip that relies on the least part of the friction; for each part first one within the bounds wished for, then one that takes the
    /// joints' whole efforts. Where even all friction and efforts give a poor one, that.
    fn solve(&self, contacts: &[GripContact]) -> Option<Solved> {
        let weight = self.weight.norm();
        let mut whole = contacts.to_vec();
        whole.iter_mut().flat_map(|contact| &mut contact.efforts).for_each(|effort| *effort /= self.share);
        let mut last = None;
        for friction in PARTS.map(|part| self.friction.part(part)) {
            let solved = |grip, margin| Solved { contacts: contacts.to_vec(), grip, friction, margin };
            let good = |grip: &Grip| grip.margin > POOR * weight;
            let wished = best_grip(contacts, &friction, &self.weight, Press::up_to(self.most));
            if let Some(grip) = wished.filter(good) {
                let margin = grip.margin;
                return Some(solved(grip, margin));
            }
            let grip = best_grip(&whole, &friction, &self.weight, Press::enough_for(ENOUGH * weight));
            let is_good = grip.as_ref().is_some_and(good);
            last = grip.map(|grip| solved(grip, 0.0)).or(last);
            if is_good {
                break;
            }
        }
        last
    }

    /// What was solved before, as far as it still serves.
    fn carry(&self, last: Solved, contacts: &[GripContact]) -> Option<Solved> {
        let fingers =
            |contacts: &[GripContact]| contacts.iter().map(|c| c.finger).collect::<Vec<FingerIndex>>();
        if last.contacts == contacts {
            return Some(last);
        }
        if last.margin <= 0.0 || fingers(&last.contacts) != fingers(contacts) {
            return None;
        }
        let turned =
            last.contacts.iter().zip(contacts).zip(&last.grip.forces).map(|((old, new), exerted)| {
                let turn = Rotation::rotation_between(&old.n, &new.n).unwrap_or_else(Rotation::identity);
                ContactForce { force: turn * exerted.force, spin: exerted.spin }
            });
        let turned: Vec<ContactForce> = turned.collect();
        let forces = balanced(contacts, &turned, &last.friction, &self.weight)?;
        let now = margin(contacts, &forces, &last.friction);
        let bounded = contacts.iter().zip(&forces).all(|(contact, force)| contact.allows(force, self.most));
        let good = bounded && now >= KEPT * last.margin;
        let grip = Grip { forces, margin: now };
        good.then(|| Solved { contacts: contacts.to_vec(), grip, ..last })
    }

    /// The contacts as the program of forces sees them, in H.
    fn contacts(&self, q: &Configuration, holding: FingerSet) -> Vec<GripContact> {
        let touching = q.contacts.iter().filter_map(|(finger, contact)| Some((finger, (*contact)?)));
        let held = touching.filter(|(finger, _)| holding.contains(*finger));
        held.map(|(finger, contact)| {
            let n = q.X_HO.rotation * contact.n_O;
            let joints = &self.hand.finger(finger).joints;
            let tip = self.hand.tip_kinematics(finger, &q.joints[finger]);
            let lever = n * self.hand.fingertip_radius();
            // The material point lies at -r n from the centre: v = J_v q' + J_w q' × (-r n).
            let column = |j: usize| -> Vec3 {
                let (v, w): (Vec3, Vec3) = (tip.J_v.column(j).into(), tip.J_w.column(j).into());
                v + lever.cross(&w)
            };
            GripContact {
                finger,
                r: q.X_HO.rotation * (contact.p_OC - self.object.p_OCm),
                n,
                columns: (0..joints.len()).map(column).collect(),
                spins: (0..joints.len()).map(|j| n.dot(&tip.J_w.column(j))).collect(),
                efforts: joints.iter().map(|joint| joint.effort * self.share).collect(),
            }
        })
        .collect()
    }
}
