//! A grasp as a row of 64-bit words, for files that only grow.

use crate::grasp::{BulkGrasp, HeldBy};
use nalgebra::{Quaternion, Translation3};
use regrasp_api::{
    Configuration, Contact, FingerIndex, FingerJoints, FingerSet, Hand, PerFinger, Pose, Rotation, Vec3,
};

/// How many joints each finger has: what the length of a row follows from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    joints: Vec<usize>,
}

/// Words beside those of joints and fingers: pose, sets of fingers, margin, clearance, whether it is held,
/// friction, share of efforts, and the object's pose.
const FIXED: usize = 7 + 7;
/// Words of each finger: facet, point, normal, force.
const OF_FINGER: usize = 1 + 3 + 3 + 3;
/// The facet of a finger that does not touch.
const FREE: u64 = u64::MAX;

impl Layout {
    /// Of a hand's grasps.
    pub fn of(hand: &dyn Hand) -> Self {
        let joints = |finger: usize| hand.finger(FingerIndex(finger as u8)).joints.len();
        Self { joints: (0..hand.finger_count()).map(joints).collect() }
    }

    /// Fingers of the hand.
    pub fn fingers(&self) -> usize {
        self.joints.len()
    }

    /// Joints of the hand.
    pub fn joints(&self) -> usize {
        self.joints.iter().sum()
    }

    /// Words of a row.
    pub(crate) fn words(&self) -> usize {
        FIXED + 2 * self.joints() + OF_FINGER * self.fingers()
    }

    /// Appends the row of a grasp.
    pub(crate) fn encode(&self, grasp: &BulkGrasp, words: &mut Vec<u64>) {
        let mut float = |x: f64| words.push(x.to_bits());
        let X = &grasp.q.X_HO;
        let turn = X.rotation.quaternion();
        [turn.w, turn.i, turn.j, turn.k].into_iter().for_each(&mut float);
        X.translation.vector.iter().copied().for_each(&mut float);
        let (friction, effort_share) =
            grasp.held.as_ref().map_or((f64::NAN, f64::NAN), |held| (held.friction, held.effort_share));
        [grasp.margin, grasp.clearance, friction, effort_share].into_iter().for_each(&mut float);
        words.extend([grasp.pose, u64::from(grasp.liftable.bits()), u64::from(grasp.held.is_some())]);
        for finger in grasp.q.joints.fingers() {
            let contact = grasp.q.contacts[finger];
            let force = grasp.held.as_ref().and_then(|held| held.forces_O[finger]);
            words.push(contact.map_or(FREE, |contact| u64::from(contact.facet)));
            let vectors = [contact.map(|contact| contact.p_OC), contact.map(|contact| contact.n_O), force];
            words.extend(
                vectors
                    .iter()
                    .flat_map(|v| v.unwrap_or_default().iter().map(|x| x.to_bits()).collect::<Vec<_>>()),
            );
            words.extend(grasp.q.joints[finger].iter().map(|x| x.to_bits()));
            let none = FingerJoints::zeros(self.joints[finger.index()]);
            let efforts = grasp.held.as_ref().map_or(none, |held| held.efforts[finger]);
            words.extend(efforts.iter().map(|x| x.to_bits()));
        }
    }

    /// The grasp of a row of [`Layout::words`] words.
    pub(crate) fn decode(&self, words: &[u64]) -> BulkGrasp {
        let float = |i: usize| f64::from_bits(words[i]);
        let vector = |i: usize| Vec3::new(float(i), float(i + 1), float(i + 2));
        let turn = Quaternion::new(float(0), float(1), float(2), float(3));
        let X_HO = Pose::from_parts(Translation3::from(vector(4)), Rotation::new_unchecked(turn));
        let count = self.fingers();
        let is_held = words[13] != 0;
        let mut q = Configuration {
            X_HO,
            joints: PerFinger::filled(count, FingerJoints::default()),
            contacts: PerFinger::filled(count, None),
        };
        let (mut forces_O, mut efforts) = (PerFinger::filled(count, None), q.joints);
        let mut place = FIXED;
        for finger in q.joints.fingers() {
            let joints = self.joints[finger.index()];
            let facet = words[place];
            let numbers = |from: usize| {
                let mut numbers = FingerJoints::zeros(joints);
                (0..joints).for_each(|j| numbers[j] = float(from + j));
                numbers
            };
            if facet != FREE {
                let (p_OC, n_O) = (vector(place + 1), vector(place + 4));
                q.contacts[finger] = Some(Contact { facet: facet as u32, p_OC, n_O });
                forces_O[finger] = is_held.then(|| vector(place + 7));
            }
            q.joints[finger] = numbers(place + OF_FINGER);
            efforts[finger] = numbers(place + OF_FINGER + joints);
            place += OF_FINGER + 2 * joints;
        }
        let held = || HeldBy { forces_O, efforts, friction: float(9), effort_share: float(10) };
        BulkGrasp {
            q,
            pose: words[11],
            margin: float(7),
            clearance: float(8),
            liftable: FingerSet::from_bits(words[12] as u8),
            held: is_held.then(held),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A grasp of two fingers with two and three joints, the second free; nothing about it is stable.
    pub(crate) fn grasp(x: f64, pose: u64) -> BulkGrasp {
        let contact = Contact { facet: 7, p_OC: Vec3::new(x, 0.2, 0.3), n_O: Vec3::z() };
        let rows = |k: f64| [FingerJoints::from_slice(&[k, 1.0]), FingerJoints::from_slice(&[2.0, k, 3.0])];
        let per = |rows: [FingerJoints; 2]| PerFinger::from_fn(2, |finger| rows[finger.index()]);
        let touches = |finger: FingerIndex| (finger.0 == 0).then_some(contact);
        let X_HO = Pose::new(Vec3::new(0.1, x, 0.3), Vec3::new(0.4, 0.5, 0.6));
        let forces_O = PerFinger::from_fn(2, |finger| (finger.0 == 0).then_some(Vec3::new(1.0, x, -2.0)));
        let held = HeldBy { forces_O, efforts: per(rows(5.0)), friction: 0.3, effort_share: 0.25 };
        let q = Configuration { X_HO, joints: per(rows(x)), contacts: PerFinger::from_fn(2, touches) };
        let liftable = FingerSet::from_bits(2);
        BulkGrasp { q, pose, margin: 0.1, clearance: 0.004, liftable, held: Some(held) }
    }

    pub(crate) fn layout() -> Layout {
        Layout { joints: vec![2, 3] }
    }

    #[test]
    fn rows_come_back_as_they_were() {
        for held in [true, false] {
            let mut wished = grasp(0.5, 3);
            wished.held = wished.held.filter(|_| held);
            let mut words = Vec::new();
            layout().encode(&wished, &mut words);
            assert_eq!(words.len(), layout().words());
            assert_eq!(layout().decode(&words), wished);
        }
    }
}
