//! How far a rolling fingertip slips, from states alone.

use regrasp_api::{Configuration, FingerIndex, Hand, Pose, Rotation, Vec3};

/// A fingertip that touches: where tip and object are, and the contact.
pub(super) struct Touch {
    p_HF: Vec3,
    R_HF: Rotation,
    X_HO: Pose,
    p_OC: Vec3,
    n_O: Vec3,
}

impl Touch {
    /// The touch of `finger` at `q`; `None` where it does not hold.
    pub fn new(hand: &dyn Hand, q: &Configuration, finger: FingerIndex) -> Option<Self> {
        let contact = q.contacts[finger]?;
        let tip = hand.tip_kinematics(finger, &q.joints[finger]);
        Some(Self { p_HF: tip.p_HF, R_HF: tip.R_HF, X_HO: q.X_HO, p_OC: contact.p_OC, n_O: contact.n_O })
    }

    /// How far (m, in O, along the surface) the tip's material point at this contact moves against the
    /// object's until `other`.
    fn shift(&self, other: &Self) -> Vec3 {
        let contact_H = self.X_HO.rotation * self.p_OC + self.X_HO.translation.vector;
        let p_FC = self.R_HF.inverse() * (contact_H - self.p_HF);
        let moved_H = other.p_HF + other.R_HF * p_FC;
        let moved_O = other.X_HO.rotation.inverse() * (moved_H - other.X_HO.translation.vector);
        let apart = moved_O - self.p_OC;
        apart - self.n_O * self.n_O.dot(&apart)
    }

    /// The slip (m, in O) on the way to `later`: half of each way of taking the contact, exact to second
    /// order.
    pub fn slip(&self, later: &Self) -> Vec3 {
        0.5 * (self.shift(later) - later.shift(self))
    }
}
