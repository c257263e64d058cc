//! What tables say of one state.

use crate::Scene;
use regrasp_api::{Configuration, FingerIndex, FingerJoints, Hand, PerFinger, Vec3};
use regrasp_physics::ContactForce;
use regrasp_plan::SegmentKind;

/// One state of the motion.
pub(crate) struct Row<'a> {
    /// Its number among all states.
    pub state: usize,
    pub segment: usize,
    pub kind: SegmentKind,
    pub time: f64,
    pub q: &'a Configuration,
    /// The joints' velocities (rad/s; m/s where prismatic), where the plan has them.
    pub velocities: Option<&'a PerFinger<FingerJoints>>,
}

/// A contact in both frames (m), and what the finger exerts there on the object (in H).
pub(crate) struct Touch {
    pub point_O: Vec3,
    pub normal_O: Vec3,
    pub point_H: Vec3,
    pub normal_H: Vec3,
    pub exerted: Option<ContactForce>,
}

impl Scene<'_> {
    /// The states in turn.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        let segments = self.motion.segments.iter();
        let velocities =
            segments.flat_map(|segment| (0..segment.states.len()).map(|k| segment.velocities.get(k)));
        self.states().zip(velocities).enumerate().map(|(state, ((segment, time, q), velocities))| Row {
            state,
            segment,
            kind: self.motion.segments[segment].kind,
            time,
            q,
            velocities,
        })
    }

    /// Where and how a finger touches the object; `None` where it does not.
    pub(crate) fn touch(&self, row: &Row<'_>, finger: FingerIndex) -> Option<Touch> {
        let contact = row.q.contacts[finger]?;
        Some(Touch {
            point_O: contact.p_OC,
            normal_O: contact.n_O,
            point_H: (row.q.X_HO * nalgebra::Point3::from(contact.p_OC)).coords,
            normal_H: row.q.X_HO * contact.n_O,
            exerted: self.forces.force(row.state, finger),
        })
    }

    /// Centre of a fingertip's ball (m, in H).
    pub(crate) fn tip(&self, row: &Row<'_>, finger: FingerIndex) -> Vec3 {
        self.hand.tip_center(finger, &row.q.joints[finger])
    }
}

impl Row<'_> {
    /// The velocities of all joints in a row; `None` where the plan has none.
    pub fn velocities(&self) -> Option<Vec<f64>> {
        Some(self.velocities?.iter().flat_map(|(_, v)| v.to_vec()).collect())
    }

    /// The segment's kind as plan files call it.
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            SegmentKind::Transfer => "transfer",
            SegmentKind::Regrasp(_) => "regrasp",
        }
    }

    /// The finger that moves in a regrasp.
    pub fn moving(&self) -> Option<FingerIndex> {
        match self.kind {
            SegmentKind::Transfer => None,
            SegmentKind::Regrasp(finger) => Some(finger),
        }
    }

    /// Position (m) and orientation w, x, y, z of the object in H.
    pub fn object(&self) -> ([f64; 3], [f64; 4]) {
        let q = self.q.X_HO.rotation.quaternion();
        (self.q.X_HO.translation.vector.into(), [q.w, q.i, q.j, q.k])
    }
}

/// The columns of the object's pose, the same in every table.
pub(crate) fn object_head() -> [String; 7] {
    ["x", "y", "z", "qw", "qx", "qy", "qz"].map(|name| format!("object.{name}"))
}
