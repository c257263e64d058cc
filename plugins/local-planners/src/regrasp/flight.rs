//! One finger that moves through free space while everything else rests.

use crate::common::{Levers, bisection, largest_travel};
use regrasp_api::{
    Configuration, Contact, FingerIndex, FingerJoints, FingerSet, LoneFinger, Reason, Task, TipRule, Vec3,
};

/// What stays the same during one regrasp.
pub(crate) struct Flight<'a> {
    pub task: &'a Task<'a>,
    pub levers: &'a Levers,
    pub from: &'a Configuration,
    pub finger: FingerIndex,
    /// Fingertip radius (m).
    pub radius: f64,
    /// The finger among everything that rests.
    lone: Box<dyn LoneFinger + 'a>,
}

impl<'a> Flight<'a> {
    pub fn new(task: &'a Task<'a>, levers: &'a Levers, from: &'a Configuration, finger: FingerIndex) -> Self {
        let lone = task.clearance.lone_finger(finger, from, FingerSet::first(from.joints.len()));
        Self { task, levers, from, finger, radius: task.hand.fingertip_radius(), lone }
    }

    /// The fingertip's centre (m, in H) at a height (m) above a contact.
    pub fn center(&self, contact: &Contact, height: f64) -> Vec3 {
        let X_HO = &self.from.X_HO;
        X_HO.rotation * contact.tip_center(self.radius + height) + X_HO.translation.vector
    }

    /// The distance (m) of a fingertip from the surface, given its centre in H and a contact nearby.
    pub fn gap(&self, p_HF: &Vec3, near: &Contact) -> f64 {
        let X_HO = &self.from.X_HO;
        let p_OF = X_HO.rotation.inverse_transform_vector(&(p_HF - X_HO.translation.vector));
        self.task.surface.project(&p_OF, Some(near.facet)).distance - self.radius
    }

    /// Whether the finger keeps clear of everything.
    pub fn free(&self, joints: &FingerJoints, tip: TipRule) -> bool {
        self.lone.free(joints, tip).is_ok()
    }

    /// The distance (m) that bodies keep which may not touch.
    pub fn clear(&self) -> f64 {
        self.task.tolerances.clearance + self.task.resolution.clearance
    }

    /// Whether the finger keeps clear of everything, its tip away from the object.
    pub fn free_in_air(&self, joints: &FingerJoints) -> bool {
        self.free(joints, TipRule::Clear(self.clear()))
    }

    /// A bound (m) of how far the finger's points travel between two postures.
    pub fn travel(&self, a: &FingerJoints, b: &FingerJoints) -> f64 {
        self.levers.between(self.finger, a, b)
    }

    /// Whether the straight motion of the joints between two free postures is free, looked at every `step`
    /// (m) of travel.
    pub fn free_between(&self, a: &FingerJoints, b: &FingerJoints, step: f64) -> bool {
        let count = self.count(a, b, step);
        bisection(count)
            .all(|halving| self.free_in_air(&a.interpolate(b, halving.middle as f64 / count as f64)))
    }

    fn count(&self, a: &FingerJoints, b: &FingerJoints, step: f64) -> usize {
        (self.travel(a, b) / step).ceil() as usize
    }

    /// Appends the straight motion of the joints from `a`, without it, to `b`; or says what bars it.
    pub fn straight(
        &self,
        a: &FingerJoints,
        b: &FingerJoints,
        postures: &mut Vec<FingerJoints>,
    ) -> Result<(), Reason> {
        let step = self.task.resolution.regrasp_step;
        if !self.free_between(a, b, step) {
            return Err(Reason::Collision);
        }
        let count = self.count(a, b, step);
        postures.extend((1..count).map(|i| a.interpolate(b, i as f64 / count as f64)));
        if count > 0 {
            postures.push(*b);
        }
        Ok(())
    }

    /// Puts straight motions where the finger travels too far from one posture to the next, from `first` on.
    pub fn bridge(
        &self,
        start: &FingerJoints,
        first: usize,
        postures: &mut Vec<FingerJoints>,
    ) -> Result<(), Reason> {
        let bound = largest_travel(self.task.resolution);
        let mut next = first;
        let mut a = *start;
        while let Some(&b) = postures.get(next) {
            if self.travel(&a, &b) > bound {
                let mut between = Vec::new();
                self.straight(&a, &b, &mut between)?;
                between.pop();
                let count = between.len();
                postures.splice(next..next, between);
                next += count;
            }
            a = b;
            next += 1;
        }
        Ok(())
    }
}
