//! One grasp with all that is known of it.

use regrasp_api::{Configuration, FingerJoints, FingerSet, PerFinger, Vec3};

/// A verified grasp.
#[derive(Clone, Debug, PartialEq)]
pub struct BulkGrasp {
    /// Object pose, joints and contacts.
    pub q: Configuration,
    /// The number of the pose that was drawn: grasps of one number differ in fingers and contacts alone.
    pub pose: u64,
    /// The verifier's margin: a certified lower bound of the closure margin about the centre of mass, torques
    /// over the object's radius; the room of forces where a load is to be held; NaN where the verifier does
    /// not know the contact model.
    pub margin: f64,
    /// The smallest distance of two bodies that may not touch (m).
    pub clearance: f64,
    /// The fingers that may be lifted, the others being stable.
    pub liftable: FingerSet,
    /// What holds the object's weight, where forces within cones and efforts do.
    pub held: Option<HeldBy>,
}

/// Forces that hold the object's weight.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldBy {
    /// What each finger exerts on the object, in O (N).
    pub forces_O: PerFinger<Option<Vec3>>,
    /// The joints' efforts that exert this (N·m; N where prismatic).
    pub efforts: PerFinger<FingerJoints>,
    /// The coefficient of friction that they need.
    pub friction: f64,
    /// The largest share of a joint's effort limit that they take.
    pub effort_share: f64,
}
