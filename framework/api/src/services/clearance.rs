//! Collision and distance between hand, object and obstacles.

use crate::{Configuration, FingerIndex, FingerJoints, FingerSet, Pose};
use serde::{Deserialize, Serialize};

/// A body of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Body {
    /// The palm.
    Palm,
    /// The object.
    Object,
    /// The obstacle with this index.
    Obstacle(u16),
    /// A link of a finger, counted from the base.
    Link(FingerIndex, u8),
    /// A fingertip's ball.
    Fingertip(FingerIndex),
}

/// Two bodies.
pub type BodyPair = (Body, Body);

/// What a finger's tip may do with the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TipRule {
    /// It holds the object: tip and object are not compared.
    Touches,
    /// It must keep this distance (m) from the object, and at most the planner's clearance is asked of it.
    Clear(f64),
}

/// The exact distance of two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairDistance {
    /// The two bodies.
    pub pair: BodyPair,
    /// Their distance (m); 0 where they overlap.
    pub distance: f64,
}

/// Collision and distance.
///
/// The `*_free` calls are for the search: a conservative bound may decide; they answer "free" only where
/// every pair is truly farther apart than the clearance it was built with. Each returns the first pair that
/// is too close. Pairs that touch by construction (consecutive links, a link and its own fingertip) are never
/// compared.
pub trait Clearance: Send + Sync {
    /// The object against palm and obstacles.
    fn object_free(&self, X_HO: &Pose) -> Result<(), BodyPair>;

    /// One finger against palm, obstacles, its own links, and the object.
    fn finger_free(
        &self,
        finger: FingerIndex,
        joints: &FingerJoints,
        X_HO: &Pose,
        tip: TipRule,
    ) -> Result<(), BodyPair>;

    /// Two fingers against each other.
    fn fingers_free(
        &self,
        a: (FingerIndex, &FingerJoints),
        b: (FingerIndex, &FingerJoints),
    ) -> Result<(), BodyPair>;

    /// A whole configuration, tips that hold touching: every pair that involves a finger of `moved`, or the
    /// object if `object_moved`.
    fn configuration_free(
        &self,
        q: &Configuration,
        moved: FingerSet,
        object_moved: bool,
    ) -> Result<(), BodyPair>;

    /// One finger that moves while the object of `resting` and the fingers in `among` rest there: what rests
    /// is placed once, for the many postures of one regrasp.
    fn lone_finger<'a>(
        &'a self,
        finger: FingerIndex,
        resting: &'a Configuration,
        among: FingerSet,
    ) -> Box<dyn LoneFinger + 'a> {
        Box::new(Pairwise { clearance: self, finger, resting, among: among.without(finger) })
    }

    /// The exact distances of all pairs that may not touch, at most `limit` (m) apart; for what is shown to a
    /// user.
    fn distances(&self, q: &Configuration, limit: f64) -> Vec<PairDistance>;
}
const _: Option<&dyn Clearance> = None; // must stay object safe

/// One finger among resting bodies; see [`Clearance::lone_finger`].
pub trait LoneFinger {
    /// The finger at `joints` against palm, obstacles, its own links, the object and the resting fingers.
    fn free(&self, joints: &FingerJoints, tip: TipRule) -> Result<(), BodyPair>;
}
const _: Option<&dyn LoneFinger> = None; // must stay object safe

/// A lone finger checked pair by pair: right for every clearance, fast for none.
struct Pairwise<'a, C: ?Sized> {
    clearance: &'a C,
    finger: FingerIndex,
    resting: &'a Configuration,
    among: FingerSet,
}

impl<C: Clearance + ?Sized> LoneFinger for Pairwise<'_, C> {
    fn free(&self, joints: &FingerJoints, tip: TipRule) -> Result<(), BodyPair> {
        self.clearance.finger_free(self.finger, joints, &self.resting.X_HO, tip)?;
        self.among.iter().try_for_each(|other| {
            self.clearance.fingers_free((self.finger, joints), (other, &self.resting.joints[other]))
        })
    }
}
