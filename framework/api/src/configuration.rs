//! Contacts, configurations of hand and object, and paths of them.

use crate::{FingerIndex, FingerJoints, FingerSet, PerFinger, Pose, Vec3};

/// A place where a fingertip touches, or could touch, the object.
///
/// Contacts live on the *offset surface* (object ⊕ fingertip ball): the fingertip's centre is `p_OC + radius
/// · n_O`. On a facet `n_O` is the facet's normal; on a convex edge or vertex it is any direction between
/// those of the facets that meet there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The facet that holds the point (one of several on an edge or vertex), or another coordinate of the
    /// surface plugin.
    pub facet: u32,
    /// The contact point in the object's frame (m).
    pub p_OC: Vec3,
    /// The unit normal in the object's frame, outward: from the object to the fingertip.
    pub n_O: Vec3,
}

impl Contact {
    /// The centre of a fingertip of the given radius (m) that touches here, in the object's frame (m).
    pub fn tip_center(&self, radius: f64) -> Vec3 {
        self.p_OC + self.n_O * radius
    }
}

/// A configuration q of hand and object: the pose, the joints and which fingers touch where.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// Pose of the object O in the hand's frame H.
    pub X_HO: Pose,
    /// Joint positions of every finger.
    pub joints: PerFinger<FingerJoints>,
    /// The contact of every finger that holds the object; `None` for a free finger.
    pub contacts: PerFinger<Option<Contact>>,
}

impl Configuration {
    /// The fingers that hold the object.
    pub fn holding(&self) -> FingerSet {
        self.contacts.iter().filter(|(_, contact)| contact.is_some()).map(|(finger, _)| finger).collect()
    }

    /// Where the fingertip centre of `finger` must be for its contact, in the hand's frame (m); `None` if it
    /// is free.
    pub fn contact_tip_center(&self, finger: FingerIndex, radius: f64) -> Option<Vec3> {
        let contact = self.contacts[finger]?;
        Some(self.X_HO * nalgebra::Point3::from(contact.tip_center(radius))).map(|p| p.coords)
    }
}

/// A path: consecutive configurations between which joints and position move linearly, orientation by slerp.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// The states, first to last.
    pub states: Vec<Configuration>,
}

impl Path {
    /// Starts afresh at `from`, keeping the allocation.
    pub fn restart(&mut self, from: &Configuration) {
        self.states.clear();
        self.states.push(from.clone());
    }

    /// The same motion backwards: the stored states reversed, never integrated again.
    pub fn reverse(&mut self) {
        self.states.reverse();
    }
}
