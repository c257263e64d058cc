//! The efforts with which the fingers hold the object along a motion.

use crate::grip::{Grip, GripContact, best_grip, margin, residual_forces};
use crate::settings::SimulationSettings;
use regrasp_api::{
    Configuration, FingerIndex, FingerJoints, FingerSet, Hand, ObjectModel, PerFinger, Rotation, Vec3,
};

/// What part of a solved margin forces that are carried along must keep.
const KEPT: f64 = 0.8;

/// Finds the grip at one configuration after another.
///
/// A grip that was solved is carried along while the contacts roll: its forces turn with the contacts' normals and the least change of
/// norm balances them again. They are solved anew where that costs more than a part of the margin, or leaves the bounds.
pub(crate) struct Holder<'a> {
    hand: &'a dyn Hand,
    object: &'a ObjectModel,
    /// The object's weight in H (N).
    weight: Vec3,
    mu: f64,
    most: f64,
    share: f64,
    last: Option<Solved>,
}

struct Solved {
    contacts: Vec<GripContact>,
    grip: Grip,
    /// The margin when it was solved (N).
    margin: f64,
}

impl<'a> Holder<'a> {
    /// For an object that the fingers take to have friction `mu` (no unit) and its own mass, under gravity `g_H` (m/s²).
    pub fn new(
        (hand, object, g_H): (&'a dyn Hand, &'a ObjectModel, Vec3),
        mu: f64,
        settings: &SimulationSettings,
    ) -> Self {
        let weight = g_H * object.mass;
        let most = settings.grip.unwrap_or((3.0 * weight.norm()).max(2.0));
        Self { hand, object, weight, mu, most, share: settings.effort_share, last: None }
    }

    /// The joints' efforts (N·m; N) with which the fingers of `holding` hold the object at `q`, and their margin (N): 0 or less where no forces
    /// within the cones and the efforts hold it. `None` where no forces of any direction do.
    pub fn efforts(
        &mut self,
        q: &Configuration,
        holding: FingerSet,
    ) -> Option<(PerFinger<FingerJoints>, f64)> {
        let contacts = self.contacts(q, holding);
        let carried = self.last.take().and_then(|last| self.carry(last, &contacts));
        let (grip, margin) = match carried {
            Some(carried) => carried,
            None => {
                let grip = self.solve(&contacts)?;
                let margin = grip.margin;
                (grip, margin)
            }
        };
        let mut efforts = q.joints;
        for finger in q.joints.fingers() {
            efforts[finger] = FingerJoints::zeros(q.joints[finger].len());
        }
        for (contact, force) in contacts.iter().zip(&grip.forces) {
            efforts[contact.finger] = contact.efforts_of(force);
        }
        let now = grip.margin;
        self.last = Some(Solved { contacts, grip, margin });
        Some((efforts, now))
    }

    /// The best grip within the bounds wished for; where none is inside the cones, the best that the joints' whole efforts allow.
    fn solve(&self, contacts: &[GripContact]) -> Option<Grip> {
        let wished = best_grip(contacts, self.mu, &self.weight, Some(self.most));
        if wished.as_ref().is_some_and(|grip| grip.margin > 0.0) {
            return wished;
        }
        let mut contacts = contacts.to_vec();
        contacts.iter_mut().flat_map(|contact| &mut contact.efforts).for_each(|effort| *effort /= self.share);
        best_grip(&contacts, self.mu, &self.weight, None)
    }

    fn carry(&self, last: Solved, contacts: &[GripContact]) -> Option<(Grip, f64)> {
        let fingers =
            |contacts: &[GripContact]| contacts.iter().map(|c| c.finger).collect::<Vec<FingerIndex>>();
        if fingers(&last.contacts) != fingers(contacts) {
            return None;
        }
        let turned = last.contacts.iter().zip(contacts).zip(&last.grip.forces).map(|((old, new), force)| {
            Rotation::rotation_between(&old.n, &new.n).map_or(*force, |turn| turn * force)
        });
        let mut forces: Vec<Vec3> = turned.collect();
        residual_forces(contacts, &forces, &self.weight)?
            .iter()
            .zip(&mut forces)
            .for_each(|(change, force)| *force -= change);
        let margin = margin(contacts, &forces, self.mu);
        if last.margin <= 0.0 {
            return None;
        }
        let bounded = contacts.iter().zip(&forces).all(|(contact, force)| contact.allows(force, self.most));
        (bounded && margin >= KEPT * last.margin).then_some((Grip { forces, margin }, last.margin))
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
                efforts: joints.iter().map(|joint| joint.effort * self.share).collect(),
            }
        })
        .collect()
    }
}
