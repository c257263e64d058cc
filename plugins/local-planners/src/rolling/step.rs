//! One step of rolling: second-order Runge-Kutta, removal of drift, checks of the motion in between.

use super::{constraint::ContactJacobian, motion::Motion};
use crate::common::Levers;
use regrasp_api::{
    Configuration, Contact, FingerIndex, FingerJoints, FingerSet, PerFinger, Pose, Reason, Task,
    TipKinematics, Vec3,
};

/// How far the object has come, with the net slip of every contact (m, in O).
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub q: Configuration,
    pub s: f64,
    pub slip_O: PerFinger<Vec3>,
}

/// Why a step was not made.
pub(crate) enum Failure {
    /// The motion that it means strays too far from the contacts: try a shorter one.
    Finer,
    /// The end.
    Stop(Reason),
}

/// What stays the same during one transfer.
pub(crate) struct Roller<'a> {
    pub task: &'a Task<'a>,
    pub levers: &'a Levers,
    pub motion: Motion,
    pub holding: FingerSet,
    /// Fingertip radius (m).
    pub radius: f64,
    /// Largest closure residual (m) between states.
    pub closure: f64,
    /// Largest net slip (m).
    pub slip: f64,
}

/// Where one finger is at the end of a step.
struct Rolled {
    joints: FingerJoints,
    contact: Contact,
    slip_O: Vec3,
}

/// Two states of one finger, the motion between them and the object's pose halfway.
struct Span<'a> {
    finger: FingerIndex,
    joints: (&'a FingerJoints, &'a FingerJoints),
    contacts: (&'a Contact, &'a Contact),
    X_HO: (&'a Pose, &'a Pose),
    X_HMid: &'a Pose,
}

fn to_object(X_HO: &Pose, p_H: &Vec3) -> Vec3 {
    X_HO.rotation.inverse_transform_vector(&(p_H - X_HO.translation.vector))
}

fn to_hand(X_HO: &Pose, p_O: &Vec3) -> Vec3 {
    X_HO.rotation * p_O + X_HO.translation.vector
}

impl Roller<'_> {
    /// Joint speeds (per motion) with which the finger rolls, given its tip and contact.
    fn speeds(
        &self,
        X_HO: &Pose,
        tip: &TipKinematics,
        contact: &Contact,
        joints: usize,
    ) -> Option<FingerJoints> {
        let n_H = X_HO.rotation * contact.n_O;
        let v_H = self.motion.velocity(X_HO, &to_hand(X_HO, &contact.p_OC));
        ContactJacobian::new(tip, joints, &n_H, self.radius).speeds(&v_H)
    }

    /// Speeds of every joint at `state`, and the largest part of the motion over which no fingertip travels farther over the object
    /// than `reach` (m) and no finger farther than `travel` (m).
    pub fn rates(
        &self,
        state: &State,
        reach: f64,
        travel: f64,
    ) -> Result<(PerFinger<FingerJoints>, f64), Reason> {
        let (mut rates, mut part) = (state.q.joints, f64::INFINITY);
        let X_HO = &state.q.X_HO;
        for finger in self.holding.iter() {
            let (joints, contact) = (&state.q.joints[finger], touching(&state.q, finger));
            let tip = self.task.hand.tip_kinematics(finger, joints);
            let rate = self.speeds(X_HO, &tip, &contact, joints.len()).ok_or(Reason::Reach)?;
            let v_H: Vec3 = (0..rate.len()).map(|j| tip.J_v.column(j) * rate[j]).sum();
            let over_object = (v_H - self.motion.velocity(X_HO, &tip.p_HF)).norm();
            let of_finger = self.levers.travel(finger, rate.iter().copied());
            part = part.min(reach / over_object).min(travel / of_finger);
            rates[finger] = rate;
        }
        Ok((rates, part))
    }

    /// The state a part `h` of the motion further, or why there is none. Collision and stability are not looked at.
    pub fn advance(&self, state: &State, rates: &PerFinger<FingerJoints>, h: f64) -> Result<State, Failure> {
        let mut next = state.clone();
        // The last step ends at 1 exactly, whatever the sum of the steps before it.
        next.s = if 1.0 - (state.s + h) < 1e-12 { 1.0 } else { state.s + h };
        let X_HMid = self.motion.pose(0.5 * (state.s + next.s));
        next.q.X_HO = self.motion.pose(next.s);
        for finger in self.holding.iter() {
            let rolled =
                self.roll(state, finger, &rates[finger], (&X_HMid, &next.q.X_HO), next.s - state.s)?;
            next.q.joints[finger] = rolled.joints;
            next.q.contacts[finger] = Some(rolled.contact);
            next.slip_O[finger] += rolled.slip_O;
            if next.slip_O[finger].norm() > self.slip {
                return Err(Failure::Stop(Reason::Slip));
            }
        }
        Ok(next)
    }

    /// One finger's step: midpoint rule, then the tip is moved along the normal onto the offset surface.
    fn roll(
        &self,
        state: &State,
        finger: FingerIndex,
        rate: &FingerJoints,
        (X_HMid, X_HEnd): (&Pose, &Pose),
        h: f64,
    ) -> Result<Rolled, Failure> {
        let hand = self.task.hand;
        let (start, contact) = (&state.q.joints[finger], touching(&state.q, finger));
        let middle = moved(start, rate, 0.5 * h);
        let tip = hand.tip_kinematics(finger, &middle);
        let touch = self.task.surface.project(&to_object(X_HMid, &tip.p_HF), Some(contact.facet)).contact;
        let rate = self.speeds(X_HMid, &tip, &touch, start.len()).ok_or(Failure::Stop(Reason::Reach))?;
        let end = moved(start, &rate, h);
        if !hand.within_limits(finger, &end) {
            return Err(Failure::Stop(Reason::Limits));
        }
        let p_OF = to_object(X_HEnd, &hand.tip_center(finger, &end));
        let touch = self.task.surface.project(&p_OF, Some(touch.facet)).contact;
        let p_OF = touch.tip_center(self.radius);
        if self.jumps(&contact, &touch) {
            return Err(Failure::Stop(Reason::Closure));
        }
        let joints =
            hand.inverse(finger, &to_hand(X_HEnd, &p_OF), &end).ok_or(Failure::Stop(Reason::Reach))?;
        let span = Span {
            finger,
            joints: (start, &joints),
            contacts: (&contact, &touch),
            X_HO: (&state.q.X_HO, X_HEnd),
            X_HMid,
        };
        let slip_O = self.slip_between(&span, h)?;
        Ok(Rolled { joints, contact: touch, slip_O })
    }

    /// Whether the contact point jumped, as it does where the fingertip leaves one facet of a concave edge for the other.
    ///
    /// On a convex object the closest point never moves farther than the fingertip's centre (projection onto a convex set is
    /// nonexpansive); what is beyond that is the jump. Jumps too short to count as slip pass.
    fn jumps(&self, a: &Contact, b: &Contact) -> bool {
        let of_center = (b.tip_center(self.radius) - a.tip_center(self.radius)).norm();
        (b.p_OC - a.p_OC).norm() - of_center > self.slip
    }

    /// The slip (m, in O) of the interpolated motion over one step by the midpoint rule, if the contact stays closed throughout.
    fn slip_between(&self, span: &Span<'_>, h: f64) -> Result<Vec3, Failure> {
        let (a, b) = span.joints;
        let tip = self.task.hand.tip_kinematics(span.finger, &a.interpolate(b, 0.5));
        let (touch, gap) = self.touch_between(span, &to_object(span.X_HMid, &tip.p_HF));
        if gap.abs() > self.closure || (gap.abs() > 0.5 * self.closure && self.opens_aside(span)) {
            return Err(Failure::Finer);
        }
        let n_H = span.X_HMid.rotation * touch.n_O;
        let mut motion = *b;
        motion.iter_mut().zip(a.iter()).for_each(|(b, a)| *b -= a);
        let of_tip = ContactJacobian::new(&tip, a.len(), &n_H, self.radius).velocity(&motion);
        let of_object = self.motion.velocity(span.X_HMid, &to_hand(span.X_HMid, &touch.p_OC)) * h;
        let slip_O = span.X_HMid.rotation.inverse_transform_vector(&(of_tip - of_object));
        Ok(slip_O - touch.n_O * touch.n_O.dot(&slip_O))
    }

    /// Contact and gap (m) of a fingertip centre between the span's ends.
    fn touch_between(&self, span: &Span<'_>, p_OF: &Vec3) -> (Contact, f64) {
        let (a, b) = span.contacts;
        if same_facet(a, b) {
            // A facet is flat and convex: between two of its points there is no other closest point.
            let distance = a.n_O.dot(&(p_OF - a.p_OC));
            return (Contact { p_OC: p_OF - a.n_O * distance, ..*a }, distance - self.radius);
        }
        let projection = self.task.surface.project(p_OF, Some(a.facet));
        (projection.contact, projection.distance - self.radius)
    }

    /// Whether the contact opens too far a quarter of the way from an end, where the normal turned on an edge in between.
    ///
    /// The gap of a single bend is concave along the step: at half the bound in the middle it may reach the bound elsewhere; from
    /// the quarter points on, 4/3 of what they show bounds it.
    fn opens_aside(&self, span: &Span<'_>) -> bool {
        if same_facet(span.contacts.0, span.contacts.1) {
            return false;
        }
        [0.25, 0.75].into_iter().any(|t| {
            let joints = span.joints.0.interpolate(span.joints.1, t);
            let X_HO = regrasp_api::interpolate(span.X_HO.0, span.X_HO.1, t);
            let p_OF = to_object(&X_HO, &self.task.hand.tip_center(span.finger, &joints));
            self.touch_between(span, &p_OF).1.abs() > 0.75 * self.closure
        })
    }
}

fn same_facet(a: &Contact, b: &Contact) -> bool {
    a.facet == b.facet && (a.n_O - b.n_O).norm_squared() < 1e-20
}

fn touching(q: &Configuration, finger: FingerIndex) -> Contact {
    q.contacts[finger].expect("only holding fingers roll")
}

fn moved(joints: &FingerJoints, rate: &FingerJoints, h: f64) -> FingerJoints {
    let mut joints = *joints;
    joints.iter_mut().zip(rate.iter()).for_each(|(q, speed)| *q += h * speed);
    joints
}
