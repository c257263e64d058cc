//! The motion that two consecutive states mean: does the contact stay closed in between?

use super::roller::{Roller, to_object};
use regrasp_api::{Contact, FingerIndex, FingerJoints, Pose, TipKinematics, Vec3, interpolate};

/// Two states of one finger and what is known halfway.
pub(crate) struct Span<'a> {
    pub finger: FingerIndex,
    pub joints: (&'a FingerJoints, &'a FingerJoints),
    pub contacts: (&'a Contact, &'a Contact),
    pub X_HO: (&'a Pose, &'a Pose),
    /// Joints close to the mean of the ends', with their kinematics.
    pub middle: (&'a FingerJoints, &'a TipKinematics),
    /// The object's pose halfway.
    pub X_HMid: &'a Pose,
}

/// What part of the closure bound may be left unknown (linearised kinematics).
const UNKNOWN: f64 = 0.05;

impl Roller<'_> {
    /// Whether the contact opens or presses in by more than the bound while joints move linearly and the
    /// object by slerp.
    pub fn opens(&self, span: &Span<'_>) -> bool {
        let gap = self.gap(span, &to_object(span.X_HMid, &self.middle(span))).abs();
        let bound = self.closure * (1.0 - UNKNOWN);
        gap > bound || (gap > 0.5 * bound && self.opens_aside(span))
    }

    /// The fingertip's centre (m, in H) when the joints are halfway.
    ///
    /// The integrator has looked nearby; where that is near enough, its derivatives carry the rest of the
    /// way.
    fn middle(&self, span: &Span<'_>) -> Vec3 {
        let ((a, b), (near, tip)) = (span.joints, span.middle);
        let middle = a.interpolate(b, 0.5);
        let (mut p_HF, mut turned) = (tip.p_HF, 0.0);
        for (j, (q, near)) in middle.iter().zip(near.iter()).enumerate() {
            p_HF += tip.J_v.column(j) * (q - near);
            turned += (q - near).abs();
        }
        // The second derivatives of the kinematics are bounded by the levers.
        let unknown = 0.5 * self.levers.between(span.finger, &middle, near) * turned;
        if unknown > UNKNOWN * self.closure {
            return self.task.hand.tip_center(span.finger, &middle);
        }
        p_HF
    }

    /// The gap (m) between a fingertip with its centre at `p_OF` and the object.
    fn gap(&self, span: &Span<'_>, p_OF: &Vec3) -> f64 {
        let (a, b) = span.contacts;
        if same_facet(a, b) {
            // A facet is flat and convex: between two of its points there is no other closest point.
            return a.n_O.dot(&(p_OF - a.p_OC)) - self.radius;
        }
        self.task.surface.project(p_OF, Some(a.facet)).distance - self.radius
    }

    /// Whether the contact opens too far a quarter of the way from an end, where the normal turned on an edge
    /// in between.
    ///
    /// The gap of a single bend is concave along the step: at half the bound in the middle it may reach the
    /// bound elsewhere; from middle and quarter points on, 4/3 of what they show bounds it.
    fn opens_aside(&self, span: &Span<'_>) -> bool {
        if same_facet(span.contacts.0, span.contacts.1) {
            return false;
        }
        [0.25, 0.75].into_iter().any(|t| {
            let joints = span.joints.0.interpolate(span.joints.1, t);
            let X_HO = interpolate(span.X_HO.0, span.X_HO.1, t);
            let p_OF = to_object(&X_HO, &self.task.hand.tip_center(span.finger, &joints));
            self.gap(span, &p_OF).abs() > 0.75 * self.closure
        })
    }
}

fn same_facet(a: &Contact, b: &Contact) -> bool {
    a.facet == b.facet && (a.n_O - b.n_O).norm_squared() < 1e-20
}
