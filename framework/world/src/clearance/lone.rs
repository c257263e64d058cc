//! One finger that moves among resting bodies.

use super::SceneClearance;
use super::finger::PlacedFinger;
use crate::hand::LinkFrame;
use regrasp_api::{BodyPair, Configuration, FingerIndex, FingerJoints, FingerSet, LoneFinger, Pose, TipRule};
use smallvec::SmallVec;

/// A finger of a scene, with the object and the other fingers placed once.
pub(super) struct Lone<'a> {
    scene: &'a SceneClearance,
    finger: FingerIndex,
    X_HO: &'a Pose,
    frame: LinkFrame,
    others: SmallVec<[PlacedFinger; 4]>,
}

impl<'a> Lone<'a> {
    pub fn new(
        scene: &'a SceneClearance,
        finger: FingerIndex,
        resting: &'a Configuration,
        among: FingerSet,
    ) -> Self {
        let others = among.iter().map(|other| scene.place(other, &resting.joints[other])).collect();
        Self { scene, finger, X_HO: &resting.X_HO, frame: LinkFrame::from(&resting.X_HO), others }
    }
}

impl LoneFinger for Lone<'_> {
    fn free(&self, joints: &FingerJoints, tip: TipRule) -> Result<(), BodyPair> {
        let placed = self.scene.place(self.finger, joints);
        self.scene.finger_clear_of_object(&placed, self.X_HO, &self.frame, tip)?;
        self.others.iter().try_for_each(|other| self.scene.pair_clear(&placed, other))?;
        self.scene.finger_clear_of_scene(&placed)
    }
}
