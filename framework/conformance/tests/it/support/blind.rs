//! What liars and careless authors see of a task: too little.

use regrasp_api::*;
use regrasp_conformance::fixtures::{four_finger, free_fingertips, three_finger};
use regrasp_conformance::reference::EdgeClosure;
use regrasp_world::ChainHand;

/// The kit's hand with joints that move farther.
pub fn wide(hand: &dyn Hand) -> ChainHand {
    let prismatic = hand.finger(FingerIndex(0)).joints[0].kind == JointKind::Prismatic;
    let mut description = match hand.finger_count() {
        _ if prismatic => free_fingertips(),
        3 => three_finger(),
        _ => four_finger(),
    };
    description.fingertip = hand.fingertip();
    for joint in description.finger.iter_mut().flat_map(|finger| &mut finger.joint) {
        (joint.lower, joint.upper) = (joint.lower - 0.05, joint.upper + 0.05);
    }
    ChainHand::new(description).unwrap()
}

/// A clearance that looks at some pairs of bodies alone.
pub struct Blinkered<'a> {
    pub all: &'a dyn Clearance,
    pub sees: fn(&BodyPair) -> bool,
}

impl Blinkered<'_> {
    fn judge(&self, found: Result<(), BodyPair>) -> Result<(), BodyPair> {
        found.or_else(|pair| if (self.sees)(&pair) { Err(pair) } else { Ok(()) })
    }
}

impl Clearance for Blinkered<'_> {
    fn object_free(&self, X_HO: &Pose) -> Result<(), BodyPair> {
        self.judge(self.all.object_free(X_HO))
    }
    fn finger_free(
        &self,
        finger: FingerIndex,
        joints: &FingerJoints,
        X_HO: &Pose,
        tip: TipRule,
    ) -> Result<(), BodyPair> {
        self.judge(self.all.finger_free(finger, joints, X_HO, tip))
    }
    fn fingers_free(
        &self,
        a: (FingerIndex, &FingerJoints),
        b: (FingerIndex, &FingerJoints),
    ) -> Result<(), BodyPair> {
        self.judge(self.all.fingers_free(a, b))
    }
    fn configuration_free(
        &self,
        q: &Configuration,
        moved: FingerSet,
        object_moved: bool,
    ) -> Result<(), BodyPair> {
        self.judge(self.all.configuration_free(q, moved, object_moved))
    }
    fn distances(&self, q: &Configuration, limit: f64) -> Vec<PairDistance> {
        self.all.distances(q, limit).into_iter().filter(|found| (self.sees)(&found.pair)).collect()
    }
}

/// Whether a pair is of the object and something else.
pub fn is_of_object(pair: &BodyPair) -> bool {
    pair.0 == Body::Object || pair.1 == Body::Object
}

/// Whether a pair is of bodies of fingers.
pub fn is_of_fingers(pair: &BodyPair) -> bool {
    use Body::{Fingertip, Link};
    matches!(pair, (Fingertip(_) | Link(..), Fingertip(_) | Link(..)))
}

/// Takes every grasp for stable.
pub struct AnyGrasp;

impl StabilityTest for AnyGrasp {
    fn test(&self, _: &Grasp<'_>, _: &mut Hint, _: &mut Context<'_>) -> Result<Stability, CallError> {
        Ok(Stability::Stable)
    }
    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        EdgeClosure.assess(grasp, length, center_O, context)
    }
}
