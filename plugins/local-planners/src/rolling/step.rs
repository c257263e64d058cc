//! One step of rolling: the midpoint rule, removal of drift, net slip.

use super::constraint::ContactJacobian;
pub(crate) use super::roller::{Roller, to_hand, to_object};
use super::span::Span;
use crate::common::Second;
use regrasp_api::{
    Configuration, Contact, FingerIndex, FingerJoints, PerFinger, Pose, Reason, Rotation, TipKinematics, Vec3,
};

/// How far the object has come, and how every holding finger goes on from there.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub q: Configuration,
    /// The fraction of the motion made, in [0, 1].
    pub s: f64,
    /// Net slip of every contact since the start (m, in O).
    pub slip_O: PerFinger<Vec3>,
    /// Net spin of every contact about its normal since the start (rad), where it is bounded.
    pub spin: PerFinger<f64>,
    /// Orientation of every holding fingertip in O.
    pub R_OF: PerFinger<Rotation>,
    /// Joint speeds (per motion) with which the fingers roll on.
    pub rates: PerFinger<FingerJoints>,
    /// The longest step (part of the motion) within the bounds of travel; 0 at a singularity.
    pub longest: f64,
}

/// Why a step was not made.
pub(crate) enum Failure {
    /// The motion that it means strays too far from the contacts: try a shorter one.
    Finer,
    /// The end.
    Stop(Reason),
}

impl Roller<'_> {
    /// Before the first step.
    pub fn start(&self, from: &Configuration) -> State {
        let count = from.joints.len();
        let mut state = State {
            q: from.clone(),
            s: if self.motion.is_still() { 1.0 } else { 0.0 },
            slip_O: PerFinger::filled(count, Vec3::zeros()),
            spin: PerFinger::filled(count, 0.0),
            R_OF: PerFinger::filled(count, Rotation::identity()),
            rates: from.joints,
            longest: f64::INFINITY,
        };
        for finger in self.holding.iter() {
            let tip = self.task.hand.tip_kinematics(finger, &from.joints[finger]);
            self.aim(&mut state, finger, &tip);
        }
        state
    }

    /// Works out how the finger goes on from the state, its tip being `tip`.
    fn aim(&self, state: &mut State, finger: FingerIndex, tip: &TipKinematics) {
        let (X_HO, contact) = (&state.q.X_HO, touching(&state.q, finger));
        state.R_OF[finger] = X_HO.rotation.inverse() * tip.R_HF;
        let Some(rate) = self.speeds(X_HO, tip, &contact, state.rates[finger].len()) else {
            state.longest = 0.0;
            return;
        };
        let over_object = (velocity(tip, &rate) - self.motion.velocity(X_HO, &tip.p_HF)).norm();
        let of_finger = self.levers.travel(finger, rate.iter().copied());
        state.longest = state.longest.min(self.reach / over_object).min(self.travel / of_finger);
        state.rates[finger] = rate;
    }

    /// Joint speeds (per motion) with which the finger rolls; `None` at a singularity.
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

    /// Makes `next` the state a part `h` of the motion further, or says why there is none (then `next` means
    /// nothing). Collision and stability are not looked at.
    pub fn advance(&self, state: &State, h: f64, next: &mut State) -> Result<(), Failure> {
        next.clone_from(state);
        // The last step ends at 1 exactly, whatever the sum of the steps before it.
        next.s = if 1.0 - (state.s + h) < 1e-12 { 1.0 } else { state.s + h };
        next.q.X_HO = self.motion.pose(next.s);
        next.longest = f64::INFINITY;
        let X_HMid = self.motion.pose(0.5 * (state.s + next.s));
        for finger in self.holding.iter() {
            let (joints, contact) = self.roll(state, finger, (&X_HMid, &next.q.X_HO), next.s - state.s)?;
            next.q.joints[finger] = joints;
            next.q.contacts[finger] = Some(contact);
        }
        for finger in self.holding.iter() {
            let tip = self.task.hand.tip_kinematics(finger, &next.q.joints[finger]);
            self.aim(next, finger, &tip);
            let slip_O = self.slip_of(state, next, finger);
            next.slip_O[finger] += slip_O;
            if self.spin.is_finite() {
                next.spin[finger] += self.spin_of(state, next, finger);
            }
            if next.slip_O[finger].norm() > self.slip || next.spin[finger].abs() > self.spin {
                return Err(Failure::Stop(Reason::Slip));
            }
        }
        Ok(())
    }

    /// One finger's step: joints and contact at its end.
    ///
    /// The midpoint rule moves the fingertip's centre; then the centre is moved along the normal onto the
    /// offset surface and inverse kinematics gives the joints, so that closure never drifts.
    fn roll(
        &self,
        state: &State,
        finger: FingerIndex,
        (X_HMid, X_HEnd): (&Pose, &Pose),
        h: f64,
    ) -> Result<(FingerJoints, Contact), Failure> {
        let (hand, surface) = (self.task.hand, self.task.surface);
        let (start, contact) = (&state.q.joints[finger], touching(&state.q, finger));
        let middle = moved(start, &state.rates[finger], 0.5 * h);
        let tip = hand.tip_kinematics(finger, &middle);
        let touch = surface.project(&to_object(X_HMid, &tip.p_HF), Some(contact.facet)).contact;
        let rate = self.speeds(X_HMid, &tip, &touch, start.len()).ok_or(Failure::Stop(Reason::Reach))?;
        let near = moved(start, &rate, h);
        if !hand.within_limits(finger, &near) {
            return Err(Failure::Stop(Reason::Limits));
        }
        let p_HF = to_hand(&state.q.X_HO, &contact.tip_center(self.radius)) + velocity(&tip, &rate) * h;
        let end = surface.project(&to_object(X_HEnd, &p_HF), Some(touch.facet)).contact;
        if self.jumps(&contact, &touch) || self.jumps(&touch, &end) {
            return Err(Failure::Stop(Reason::Closure));
        }
        match self.second(&end) {
            Second::None => (),
            Second::Even => return Err(Failure::Finer),
            Second::Far => return Err(Failure::Stop(Reason::Closure)),
        }
        let p_HF = to_hand(X_HEnd, &end.tip_center(self.radius));
        let joints = hand.inverse(finger, &p_HF, &near).ok_or(Failure::Stop(Reason::Reach))?;
        let span = Span {
            finger,
            joints: (start, &joints),
            contacts: (&contact, &end),
            X_HO: (&state.q.X_HO, X_HEnd),
            middle: (&middle, &tip),
            X_HMid,
        };
        if self.opens(&span) { Err(Failure::Finer) } else { Ok((joints, end)) }
    }

    /// Spin (rad) over one step: how far the fingertip turns on the object about the contact's normal.
    fn spin_of(&self, a: &State, b: &State, finger: FingerIndex) -> f64 {
        let turn_O = (b.R_OF[finger] * a.R_OF[finger].inverse()).scaled_axis();
        turn_O.dot(&(touching(&a.q, finger).n_O + touching(&b.q, finger).n_O).normalize())
    }

    /// Slip (m, in O) over one step: how far the fingertip's material point at the contact moves along the
    /// object.
    ///
    /// In O the tip's centre moves by Δc while the tip turns by the vector θ; with the normal n half-way its
    /// point at the contact moves by Δc - θ × r n, whose tangential part rolling makes zero. Exact on a
    /// facet, of third order in θ elsewhere.
    fn slip_of(&self, a: &State, b: &State, finger: FingerIndex) -> Vec3 {
        let (at_a, at_b) = (touching(&a.q, finger), touching(&b.q, finger));
        let turn = (b.R_OF[finger] * a.R_OF[finger].inverse()).scaled_axis();
        let n_O = (at_a.n_O + at_b.n_O).normalize();
        let of_center = at_b.tip_center(self.radius) - at_a.tip_center(self.radius);
        let moved = of_center - turn.cross(&n_O) * self.radius;
        moved - n_O * n_O.dot(&moved)
    }
}

/// Velocity (m per motion), in H, of the tip's centre at these joint speeds.
fn velocity(tip: &TipKinematics, rate: &FingerJoints) -> Vec3 {
    rate.iter().enumerate().map(|(j, speed)| tip.J_v.column(j) * *speed).sum()
}

fn touching(q: &Configuration, finger: FingerIndex) -> Contact {
    q.contacts[finger].expect("only holding fingers roll")
}

fn moved(joints: &FingerJoints, rate: &FingerJoints, h: f64) -> FingerJoints {
    let mut joints = *joints;
    joints.iter_mut().zip(rate.iter()).for_each(|(q, speed)| *q += h * speed);
    joints
}
