//! Lifting a fingertip off its contact, and backwards: touching down.

use super::flight::Flight;
use crate::common::largest_travel;
use regrasp_api::{Contact, FingerJoints, TipRule};

/// A posture on the way up, with the fingertip's distance (m) from the object and its height (m) along the
/// normal.
#[derive(Clone, Copy)]
struct Rung {
    joints: FingerJoints,
    height: f64,
    gap: f64,
}

/// How often the way between two rungs may be halved.
const HALVINGS: usize = 6;

impl Flight<'_> {
    /// Replaces `postures` by the way from `joints`, without it, straight up along the contact's normal to
    /// `height` (m); false where the finger cannot go.
    ///
    /// The fingertip's distance from the object rises all the way, also while the joints move straight
    /// between two of the postures, and is at least `lowest` (m) at the end.
    pub fn lift(
        &self,
        contact: &Contact,
        joints: &FingerJoints,
        (height, lowest): (f64, f64),
        postures: &mut Vec<FingerJoints>,
    ) -> bool {
        postures.clear();
        // The top first: it is what fails most.
        let top = self.task.hand.inverse(self.finger, &self.center(contact, height), joints);
        if !top.is_some_and(|top| self.free_in_air(&top)) {
            return false;
        }
        let steps = (height / self.task.resolution.regrasp_step).ceil().max(1.0) as usize;
        let touching = self.task.hand.tip_center(self.finger, joints);
        let mut rung = Rung { joints: *joints, height: 0.0, gap: self.gap(&touching, contact) };
        for step in 1..=steps {
            let to = height * step as f64 / steps as f64;
            match self.climb(contact, rung, to, HALVINGS, postures) {
                Some(next) => rung = next,
                None => return false,
            }
        }
        rung.gap >= lowest
    }

    /// One rung higher, to the height `to` (m), with more rungs in between where the joints' straight motion
    /// needs them.
    fn climb(
        &self,
        contact: &Contact,
        rung: Rung,
        to: f64,
        halvings: usize,
        postures: &mut Vec<FingerJoints>,
    ) -> Option<Rung> {
        let p_HF = self.center(contact, to);
        let joints = self.task.hand.inverse(self.finger, &p_HF, &rung.joints)?;
        let next = Rung { joints, height: to, gap: self.gap(&p_HF, contact) };
        if next.gap <= rung.gap {
            return None;
        }
        if !self.rises(contact, &rung, &next) {
            let halvings = halvings.checked_sub(1)?;
            let middle = self.climb(contact, rung, 0.5 * (rung.height + to), halvings, postures)?;
            return self.climb(contact, middle, to, halvings, postures);
        }
        // Along the normal of a convex object the gap is the height; half of it leaves room for a
        // neighbouring wall.
        let clear = (0.5 * to).min(self.clear());
        self.free(&joints, TipRule::Clear(clear)).then(|| {
            postures.push(joints);
            next
        })
    }

    /// Whether the gap rises while the joints move straight from one rung to the next.
    ///
    /// The gap differs from a straight line by a parabola, to leading order: it rises throughout as long as
    /// the parabola's height is less than a quarter of the difference.
    fn rises(&self, contact: &Contact, a: &Rung, b: &Rung) -> bool {
        let middle = self.task.hand.tip_center(self.finger, &a.joints.interpolate(&b.joints, 0.5));
        let bow = self.gap(&middle, contact) - 0.5 * (a.gap + b.gap);
        bow.abs() < 0.2 * (b.gap - a.gap)
            && self.travel(&a.joints, &b.joints) <= largest_travel(self.task.resolution)
    }
}
