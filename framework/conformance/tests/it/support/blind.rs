//! What liars among local planners see of a task: too little.

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

/// Sees nothing but what touches the object in a regrasp, and nothing at all otherwise.
pub struct FewBodies<'a> {
    pub true_one: &'a dyn Clearance,
    pub object_counts: bool,
}

impl FewBodies<'_> {
    fn judge(&self, found: Result<(), BodyPair>) -> Result<(), BodyPair> {
        found.or_else(|pair| {
            let object = pair.0 == Body::Object || pair.1 == Body::Object;
            if object && self.object_counts { Err(pair) } else { Ok(()) }
        })
    }
}

impl Clearance for FewBodies<'_> {
    fn object_free(&self, X_HO: &Pose) -> Result<(), BodyPair> {
        self.judge(self.true_one.object_free(X_HO))
    }
    fn finger_free(
        &self,
        finger: FingerIndex,
        joints: &FingerJoints,
        X_HO: &Pose,
        tip: TipRule,
    ) -> Result<(), BodyPair> {
        self.judge(self.true_one.finger_free(finger, joints, X_HO, tip))
    }
    fn fingers_free(
        &self,
        a: (FingerIndex, &FingerJoints),
        b: (FingerIndex, &FingerJoints),
    ) -> Result<(), BodyPair> {
        self.judge(self.true_one.fingers_free(a, b))
    }
    fn configuration_free(
        &self,
        q: &Configuration,
        moved: FingerSet,
        object_moved: bool,
    ) -> Result<(), BodyPair> {
        self.judge(self.true_one.configuration_free(q, moved, object_moved))
    }
    fn distances(&self, _: &Configuration, _: f64) -> Vec<PairDistance> {
        Vec::new()
    }
}

/// Sees no collision of fingers with each other.
pub struct LonelyFingers<'a>(pub &'a dyn Clearance);

impl Clearance for LonelyFingers<'_> {
    fn object_free(&self, X_HO: &Pose) -> Result<(), BodyPair> {
        self.0.object_free(X_HO)
    }
    fn finger_free(
        &self,
        finger: FingerIndex,
        joints: &FingerJoints,
        X_HO: &Pose,
        tip: TipRule,
    ) -> Result<(), BodyPair> {
        self.0.finger_free(finger, joints, X_HO, tip)
    }
    fn fingers_free(
        &self,
        _: (FingerIndex, &FingerJoints),
        _: (FingerIndex, &FingerJoints),
    ) -> Result<(), BodyPair> {
        Ok(())
    }
    fn configuration_free(
        &self,
        q: &Configuration,
        moved: FingerSet,
        object_moved: bool,
    ) -> Result<(), BodyPair> {
        self.0.configuration_free(q, moved, object_moved).or_else(|pair| match pair {
            (Body::Object | Body::Palm, _) | (_, Body::Object | Body::Palm) => Err(pair),
            _ => Ok(()),
        })
    }
    fn distances(&self, q: &Configuration, within: f64) -> Vec<PairDistance> {
        self.0.distances(q, within)
    }
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
