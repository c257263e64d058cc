//! A grasp with the joints behind it.

use super::force::Contact;
use crate::hand::{Chains, Joint};
use crate::track::Frames;
use regrasp_api::{JointKind, Vec3};

/// One joint behind a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Row {
    /// Velocity of the fingertip's point at the contact per joint speed, in O.
    pub(crate) column_O: Vec3,
    /// Angular velocity about the inward normal per joint speed.
    pub(crate) spin: f64,
    /// Largest effort (N·m; N).
    pub(crate) limit: f64,
}

impl Row {
    /// Effort over its limit per unit of normal, tangential (a vector) and torsional force in the contact's
    /// scaled coordinates, times `unit` (N).
    pub(crate) fn of(&self, contact: &Contact, length: f64, unit: f64) -> (f64, Vec3, f64) {
        let scale = unit / self.limit;
        let column = self.column_O * scale;
        let spin = self.spin * length * scale;
        (column.dot(&contact.n) + spin * contact.drag, contact.stretch(&column), spin * contact.gamma)
    }
}

/// A grasp with what the joints behind it can do.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Held {
    pub(crate) contacts: Vec<Contact>,
    pub(crate) rows: Vec<Vec<Row>>,
}

impl Chains {
    /// What the joints of a finger can do at its contact at `p_OC` (m) with the inward unit normal `n_O`.
    ///
    /// A revolute joint moves the fingertip's point at p with axis × (p - origin), a prismatic one with its
    /// axis.
    pub(crate) fn rows(&self, finger: usize, frames: &Frames, p_OC: &Vec3, n_O: &Vec3) -> Vec<Row> {
        let chain = &self.fingers[finger];
        let to_O = frames.X_HO.rotation.inverse();
        let p_HC = frames.X_HO.rotation * p_OC + frames.X_HO.translation.vector;
        let row = |(j, joint): (usize, &Joint)| {
            let X_HJ = &frames.X_HL[chain.first + j];
            let axis_H = X_HJ.rotation * joint.axis.into_inner();
            let (velocity_H, turn_O) = match joint.kind {
                JointKind::Revolute => (axis_H.cross(&(p_HC - X_HJ.translation.vector)), to_O * axis_H),
                JointKind::Prismatic => (axis_H, Vec3::zeros()),
            };
            Row { column_O: to_O * velocity_H, spin: turn_O.dot(n_O), limit: joint.effort }
        };
        chain.joints.iter().enumerate().map(row).collect()
    }
}
