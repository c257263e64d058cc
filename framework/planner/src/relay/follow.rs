//! How far along a route fingers can follow their contacts: looks, not motions.

use super::route::Route;
use regrasp_api::{Contact, FingerIndex, FingerJoints, Fingertip, Pose, Rotation, Task, TipRule, Vec3};

/// The turn of the object (rad) between two looks. Our choice.
const LOOK: f64 = 0.25;
/// How many looks ahead: a little less than half a turn. Our choice.
const LOOKS: usize = 11;

/// A place of a finger: where it touches, if it does, and its joints there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    pub contact: Option<Contact>,
    pub joints: FingerJoints,
}

/// A finger at each of some looks in turn, as far as it can follow.
pub(crate) type Track = Vec<Touch>;

/// The poses ahead of a place, with their own places; that of the place itself first.
pub(crate) struct Looks {
    pub places: Vec<f64>,
    pub poses: Vec<Pose>,
}

impl Looks {
    /// Those ahead of `place`, as far as the object itself is free.
    pub fn ahead(task: &Task<'_>, route: &Route, place: f64) -> Self {
        let look = route.of_turn(LOOK);
        let mut looks = Self { places: vec![place], poses: vec![route.at(place)] };
        let mut next = place;
        while looks.places.len() <= LOOKS && next < route.end() {
            next = (next + look).min(route.end());
            let X_HO = route.at(next);
            if task.clearance.object_free(&X_HO).is_err() {
                break;
            }
            looks.places.push(next);
            looks.poses.push(X_HO);
        }
        looks
    }

    /// The finger at each look from the first on, as far as it can follow, the other fingers left aside; one
    /// that touches nothing stays.
    ///
    /// The fingertip rolls without slip: seen from the object its centre moves by r (δθ_F - δθ_O) × n, where
    /// the two δθ are the turns of fingertip and object from look to look (D. J. Montana, "The kinematics of
    /// contact and grasp", IJRR 1988).
    pub fn follow(&self, task: &Task<'_>, finger: FingerIndex, touch: Touch) -> Track {
        let mut track = vec![touch];
        let mut R_HF = task.hand.tip_kinematics(finger, &touch.joints).R_HF;
        for pair in self.poses.windows(2) {
            let at = track[track.len() - 1];
            let step = Step { task, finger, from: &pair[0], to: &pair[1] };
            let Some((there, R_there)) = step.take(&at, &R_HF) else { break };
            let tip = match there.contact {
                Some(_) => TipRule::Touches,
                None => TipRule::Clear(task.resolution.clearance),
            };
            if task.clearance.finger_free(finger, &there.joints, &pair[1], tip).is_err() {
                break;
            }
            track.push(there);
            R_HF = R_there;
        }
        track
    }
}

/// The step of a finger from one look to the next.
struct Step<'a> {
    task: &'a Task<'a>,
    finger: FingerIndex,
    from: &'a Pose,
    to: &'a Pose,
}

impl Step<'_> {
    /// The finger's place after the step, and the fingertip's orientation there; `None` where it cannot
    /// reach.
    fn take(&self, at: &Touch, R_HF: &Rotation) -> Option<(Touch, Rotation)> {
        let hand = self.task.hand;
        let Some(contact) = at.contact else { return Some((*at, *R_HF)) };
        let radius = hand.fingertip_radius();
        let p_OF = contact.tip_center(radius);
        let joints = self.inverse(&p_OF, &at.joints)?;
        let R_there = hand.tip_kinematics(self.finger, &joints).R_HF;
        if hand.fingertip() != Fingertip::Ball {
            return Some((Touch { joints, ..*at }, R_there));
        }
        let turn_F = (R_there * R_HF.inverse()).scaled_axis();
        let turn_O = (self.to.rotation * self.from.rotation.inverse()).scaled_axis();
        let n_H = self.to.rotation * contact.n_O;
        let drift_H = (turn_F - turn_O).cross(&n_H) * radius;
        let drifted = p_OF + self.to.rotation.inverse() * drift_H;
        let contact = self.task.surface.project(&drifted, Some(contact.facet)).contact;
        let joints = self.inverse(&contact.tip_center(radius), &joints)?;
        let R_there = hand.tip_kinematics(self.finger, &joints).R_HF;
        Some((Touch { contact: Some(contact), joints }, R_there))
    }

    fn inverse(&self, p_OF: &Vec3, near: &FingerJoints) -> Option<FingerJoints> {
        let p_HF = self.to.rotation * p_OF + self.to.translation.vector;
        self.task.hand.inverse(self.finger, &p_HF, near)
    }
}
