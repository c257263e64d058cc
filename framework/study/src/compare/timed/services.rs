//! Clearance behind the meter.

use super::{Meter, Source, Timed};
use regrasp_api::{
    BodyPair, Clearance, Configuration, FingerIndex, FingerJoints, FingerSet, LoneFinger, PairDistance, Pose,
    TipRule,
};

impl Clearance for Timed<'_, dyn Clearance + '_> {
    fn object_free(&self, X_HO: &Pose) -> Result<(), BodyPair> {
        self.leaf(|clearance| clearance.object_free(X_HO))
    }

    fn finger_free(
        &self,
        finger: FingerIndex,
        joints: &FingerJoints,
        X_HO: &Pose,
        tip: TipRule,
    ) -> Result<(), BodyPair> {
        self.leaf(|clearance| clearance.finger_free(finger, joints, X_HO, tip))
    }

    fn fingers_free(
        &self,
        a: (FingerIndex, &FingerJoints),
        b: (FingerIndex, &FingerJoints),
    ) -> Result<(), BodyPair> {
        self.leaf(|clearance| clearance.fingers_free(a, b))
    }

    fn configuration_free(
        &self,
        q: &Configuration,
        moved: FingerSet,
        object_moved: bool,
    ) -> Result<(), BodyPair> {
        self.leaf(|clearance| clearance.configuration_free(q, moved, object_moved))
    }

    fn lone_finger<'a>(
        &'a self,
        finger: FingerIndex,
        resting: &'a Configuration,
        among: FingerSet,
    ) -> Box<dyn LoneFinger + 'a> {
        let inner = self.leaf(|clearance| clearance.lone_finger(finger, resting, among));
        Box::new(TimedLoneFinger { inner, meter: self.meter })
    }

    fn distances(&self, q: &Configuration, limit: f64) -> Vec<PairDistance> {
        self.leaf(|clearance| clearance.distances(q, limit))
    }
}

struct TimedLoneFinger<'a> {
    inner: Box<dyn LoneFinger + 'a>,
    meter: &'a Meter<'a>,
}

impl LoneFinger for TimedLoneFinger<'_> {
    fn free(&self, joints: &FingerJoints, tip: TipRule) -> Result<(), BodyPair> {
        self.meter.leaf(Source::Clearance, || self.inner.free(joints, tip))
    }
}
