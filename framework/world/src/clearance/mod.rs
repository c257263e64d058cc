//! Collision and distance between hand, object, palm and obstacles.
//!
//! The search asks "farther apart than the clearance?". Rods (segments with a thickness) answer among
//! themselves in closed form; boxes, convex primitives and meshes answer by bounds from both sides; only
//! where those leave a doubt (a shell of the width of the object's faceting error) does parry3d decide. So
//! the answers are exact: nothing free is refused because of a bound, and nothing close is passed.

mod apart;
mod block;
mod body;
mod border;
mod convex;
mod exact;
mod field;
mod finger;
mod fixed;
mod hull;
mod lone;
mod object;
mod report;
mod rod;

pub(crate) use exact::MeshSolid;
pub(crate) use field::Field;
pub(crate) use fixed::Palm;

use crate::error::WorldError;
use crate::hand::{ChainHand, LinkFrame};
use body::Placed;
use finger::{FingerBodies, PlacedFinger};
use fixed::Fixed;
use object::ObjectBody;
use regrasp_api::{
    Body, BodyPair, Clearance, Configuration, FingerIndex, FingerJoints, FingerSet, Hand, LoneFinger,
    ObjectModel, ObstacleDescription, PairDistance, Pose, TipRule,
};
use smallvec::SmallVec;
use std::sync::Arc;

/// Rounding (m) that a bound must exceed to count.
const ROUNDING: f64 = 1e-12;

/// Collision and distance of one hand, one object and obstacles, with a fixed clearance.
///
/// Never compared: consecutive links of a finger (those between which no link has a shape), a fingertip and
/// its own link, the palm and a finger's first link if they touch in the resting posture, and two parts of
/// one body.
pub struct SceneClearance {
    fingers: Vec<FingerBodies>,
    fixed: Vec<Fixed>,
    object: ObjectBody,
    clear: f64,
}

impl SceneClearance {
    /// Prepares the bodies; `clearance` (m) is what the `*_free` calls keep between them. Meshes are given in
    /// place.
    pub fn new(
        hand: Arc<ChainHand>,
        object: &ObjectModel,
        obstacles: &[ObstacleDescription],
        clearance: f64,
    ) -> Result<Self, WorldError> {
        let mut fingers = (0..hand.finger_count() as u8)
            .map(|finger| FingerBodies::new(&hand, FingerIndex(finger)))
            .collect::<Result<Vec<_>, _>>()?;
        let wide = fingers.iter().map(FingerBodies::thickest).fold(0.0, f64::max) + clearance;
        let palm = Placed::read_all(hand.palm_shapes(), "hand.palm")?;
        let mut fixed: Vec<_> = palm.into_iter().map(|placed| Fixed::new(Body::Palm, placed, wide)).collect();
        for (i, obstacle) in obstacles.iter().enumerate() {
            let placed = Placed::read(&obstacle.shape, &obstacle.pose, &format!("obstacle[{i}]"))?;
            fixed.push(Fixed::new(Body::Obstacle(i as u16), placed, wide));
        }
        let clear = clearance + ROUNDING;
        for finger in &mut fingers {
            finger.find_palm_contacts(&fixed, clear);
        }
        Ok(Self { object: ObjectBody::new(object, wide), fingers, fixed, clear })
    }

    fn place(&self, finger: FingerIndex, joints: &FingerJoints) -> PlacedFinger {
        self.fingers[finger.index()].place(joints)
    }

    /// One placed finger against palm, obstacles and its own links.
    fn finger_clear_of_scene(&self, placed: &PlacedFinger) -> Result<(), BodyPair> {
        let bodies = &self.fingers[placed.finger.index()];
        for fixed in self.fixed.iter().filter(|fixed| !fixed.clear_of_bounds(&placed.bounds, self.clear)) {
            bodies.clear_of_fixed(placed, fixed, self.clear)?;
        }
        bodies.clear_of_itself(placed, self.clear)
    }

    fn finger_clear_of_object(
        &self,
        placed: &PlacedFinger,
        X_HO: &Pose,
        frame: &LinkFrame,
        tip: TipRule,
    ) -> Result<(), BodyPair> {
        let bodies = &self.fingers[placed.finger.index()];
        bodies.clear_of_object(placed, &self.object, (X_HO, frame), self.clear, tip)
    }

    fn pair_clear(&self, a: &PlacedFinger, b: &PlacedFinger) -> Result<(), BodyPair> {
        if a.bounds.clear_of(&b.bounds, self.clear) {
            return Ok(());
        }
        finger::clear_of_each_other(
            (&self.fingers[a.finger.index()], a),
            (&self.fingers[b.finger.index()], b),
            self.clear,
        )
    }
}

impl Clearance for SceneClearance {
    fn object_free(&self, X_HO: &Pose) -> Result<(), BodyPair> {
        let frame = LinkFrame::from(X_HO);
        match self.fixed.iter().find(|fixed| !fixed.clear_of_object(&self.object, X_HO, &frame, self.clear)) {
            None => Ok(()),
            Some(fixed) => Err(ordered(Body::Object, fixed.body)),
        }
    }

    fn finger_free(
        &self,
        finger: FingerIndex,
        joints: &FingerJoints,
        X_HO: &Pose,
        tip: TipRule,
    ) -> Result<(), BodyPair> {
        let placed = self.place(finger, joints);
        self.finger_clear_of_object(&placed, X_HO, &X_HO.into(), tip)?;
        self.finger_clear_of_scene(&placed)
    }

    fn fingers_free(
        &self,
        (a, joints_a): (FingerIndex, &FingerJoints),
        (b, joints_b): (FingerIndex, &FingerJoints),
    ) -> Result<(), BodyPair> {
        self.pair_clear(&self.place(a, joints_a), &self.place(b, joints_b))
    }

    fn configuration_free(
        &self,
        q: &Configuration,
        moved: FingerSet,
        object_moved: bool,
    ) -> Result<(), BodyPair> {
        let frame = LinkFrame::from(&q.X_HO);
        let placed: SmallVec<[PlacedFinger; 4]> =
            q.joints.iter().map(|(finger, joints)| self.place(finger, joints)).collect();
        for finger in placed.iter() {
            let is_moved = moved.contains(finger.finger);
            if is_moved || object_moved {
                let tip = tip_rule(q.contacts[finger.finger].is_some(), self.clear);
                self.finger_clear_of_object(finger, &q.X_HO, &frame, tip)?;
            }
            if is_moved {
                self.finger_clear_of_scene(finger)?;
            }
        }
        for (i, a) in placed.iter().enumerate() {
            for b in &placed[i + 1..] {
                if moved.contains(a.finger) || moved.contains(b.finger) {
                    self.pair_clear(a, b)?;
                }
            }
        }
        if object_moved { self.object_free(&q.X_HO) } else { Ok(()) }
    }

    fn lone_finger<'a>(
        &'a self,
        finger: FingerIndex,
        resting: &'a Configuration,
        among: FingerSet,
    ) -> Box<dyn LoneFinger + 'a> {
        Box::new(lone::Lone::new(self, finger, resting, among.without(finger)))
    }

    fn distances(&self, q: &Configuration, limit: f64) -> Vec<PairDistance> {
        report::distances(self, q, limit)
    }
}

fn tip_rule(holds: bool, clear: f64) -> TipRule {
    if holds { TipRule::Touches } else { TipRule::Clear(clear) }
}

/// A pair in the order of its bodies.
fn ordered(a: Body, b: Body) -> BodyPair {
    if a <= b { (a, b) } else { (b, a) }
}

#[cfg(test)]
mod tests;
