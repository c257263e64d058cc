//! What happens at the contacts: closure, normals, slip by the claimed law, and whether the contact point
//! moves continuously.

use crate::hand::Chains;
use crate::scene::Scene;
use crate::surface::SurfaceCheck;
use crate::touch::Touch;
use crate::track::{Frames, Leg, SAMPLES};
use crate::verdict::{Check, Gauge, Side};
use nalgebra::Point3;
use regrasp_api::{LONGEST_JUMP, MAX_FINGERS, Pose, Tolerances, Vec3};
use regrasp_plan::{ContactRecord, Extreme, HoldsAt, Place, TransferLaw};

/// The gauges of all contacts.
pub(crate) struct ContactChecks<'s> {
    hand: &'s Chains,
    scene: &'s Scene,
    closure: Gauge,
    normals: Gauge,
    slip: Gauge,
    jumps: Gauge,
    law: TransferLaw,
    rolling: [Option<Rolling>; MAX_FINGERS],
    facets: [u32; MAX_FINGERS],
    surface: SurfaceCheck,
}

/// How one contact has moved since its finger touched down.
#[derive(Clone, Copy)]
struct Rolling {
    /// Where it touched first, and where its centre was then (m, in O).
    first: (Touch, Vec3),
    /// The last sample.
    touch: Touch,
    p_OTip: Vec3,
    /// The last link at the last even sample, and the contact half-way from there to the next.
    X_OL: Pose,
    half_way: Option<Contact>,
    /// The sum of the differences of the two material points' displacements, tangential parts, in O (m).
    slip_O: Vec3,
}

/// A contact at one instant: the last link, the point and the normal, in O.
#[derive(Clone, Copy)]
struct Contact {
    X_OL: Pose,
    p_OC: Vec3,
    n_O: Vec3,
}

impl Contact {
    /// How far (m, in O) the material point of the fingertip that is the contact at this instant slips while
    /// its link moves from `from` to `to`: its displacement relative to the object, whose own points rest in
    /// O, along the tangent plane. The midpoint rule, second order.
    fn slip(&self, from: &Pose, to: &Pose) -> Vec3 {
        let p_L = self.X_OL.inverse_transform_point(&Point3::from(self.p_OC));
        tangential(&(to * p_L - from * p_L), &self.n_O)
    }
}

fn tangential(v: &Vec3, n: &Vec3) -> Vec3 {
    v - n * n.dot(v)
}

impl Rolling {
    /// How far (m) contact point or fingertip's centre are from where they began on the object, whichever is
    /// more.
    fn strayed(&self) -> f64 {
        let (touch, p_OTip) = &self.first;
        (self.touch.p_OC - touch.p_OC).norm().max((self.p_OTip - p_OTip).norm())
    }
}

/// How far a contact as it is stated is from where the fingertip really touches.
pub(crate) struct Deviation {
    /// Of the point on the object (m).
    pub(crate) on_object: f64,
    /// Of the point on the fingertip (m).
    pub(crate) on_fingertip: f64,
    /// Of the normal: the angle (rad), or what its length lacks.
    pub(crate) normal: f64,
}

/// Compares a stated contact with the touch of its finger.
pub(crate) fn deviation(
    hand: &Chains,
    frames: &Frames,
    finger: usize,
    claimed: &ContactRecord,
    touch: &Touch,
) -> Deviation {
    let (p_OC, n_O) = (Vec3::from(claimed.point_O), Vec3::from(claimed.normal_O));
    let R_HF = frames.last_link(&hand.fingers[finger]).rotation;
    let p_HC = frames.p_HTip[finger] + R_HF * Vec3::from(claimed.point_F);
    let angle = n_O.cross(&touch.n_O).norm().atan2(n_O.dot(&touch.n_O));
    Deviation {
        on_object: (p_OC - touch.p_OC).norm(),
        on_fingertip: (frames.X_HO * Point3::from(p_OC) - Point3::from(p_HC)).norm(),
        normal: angle.max((n_O.norm() - 1.0).abs()),
    }
}

impl<'s> ContactChecks<'s> {
    pub(crate) fn new(hand: &'s Chains, scene: &'s Scene, tolerances: &Tolerances, law: TransferLaw) -> Self {
        Self {
            surface: SurfaceCheck::new(scene, hand.tip_radius, tolerances.closure),
            hand,
            scene,
            closure: Gauge::new("closure", "m", Side::AtMost, tolerances.closure),
            normals: Gauge::new("normals", "rad", Side::AtMost, tolerances.normal),
            slip: Gauge::new("slip", "m", Side::AtMost, tolerances.slip),
            jumps: Gauge::new(
                "contact-jumps",
                "m",
                Side::AtMost,
                tolerances.closure.max(LONGEST_JUMP * hand.tip_radius),
            ),
            law,
            rolling: [None; MAX_FINGERS],
            facets: [0; MAX_FINGERS],
        }
    }

    /// Takes in the sample `sample` of [`SAMPLES`] after `state`; returns where the holding fingers touch.
    pub(crate) fn sample(
        &mut self,
        leg: &Leg<'_>,
        state: usize,
        sample: usize,
        frames: &Frames,
    ) -> [Option<Touch>; MAX_FINGERS] {
        let mut touches = [None; MAX_FINGERS];
        let at = state + sample / SAMPLES;
        for (finger, found) in touches.iter_mut().enumerate().take(self.hand.fingers.len()) {
            let Some(claimed) = &leg.states[at].record.contacts[finger] else { continue };
            let touch = self.touch(finger, frames);
            let fraction = sample as f64 / SAMPLES as f64;
            let place = || Place { finger: Some(finger), ..leg.between(state, fraction) };
            self.closure.note(touch.gap.abs(), place);
            self.surface.contact(self.scene, finger, &frames.p_OTip(finger), place);
            if sample.is_multiple_of(SAMPLES) {
                self.compare(
                    claimed,
                    &touch,
                    frames,
                    || Place { finger: Some(finger), ..leg.at(at) },
                    finger,
                );
            }
            // In a regrasp what holds rests: its slip is what it was.
            if leg.moving.is_none() || sample == 0 {
                self.follow(finger, touch, sample, frames, place);
            }
            *found = Some(touch);
        }
        touches
    }

    /// Where a fingertip comes closest to the object, whether it holds it or not.
    pub(crate) fn touch(&mut self, finger: usize, frames: &Frames) -> Touch {
        let near = self.facets[finger];
        let touch = Touch::find(self.scene, &frames.p_OTip(finger), self.hand.tip_radius, near);
        self.facets[finger] = touch.facet;
        touch
    }

    /// Holds a contact as the plan states it against where the fingertip really is.
    fn compare(
        &mut self,
        claimed: &ContactRecord,
        touch: &Touch,
        frames: &Frames,
        place: impl Fn() -> Place,
        finger: usize,
    ) {
        let off = deviation(self.hand, frames, finger, claimed, touch);
        self.closure.note(off.on_object, &place);
        self.closure.note(off.on_fingertip, &place);
        self.normals.note(off.normal, place);
    }

    /// Measures the slip since touch-down: what rolling adds up, or how far a fixed point has strayed from
    /// where it was then.
    fn follow(
        &mut self,
        finger: usize,
        touch: Touch,
        sample: usize,
        frames: &Frames,
        place: impl Fn() -> Place,
    ) {
        let X_OL = frames.X_HO.inv_mul(frames.last_link(&self.hand.fingers[finger]));
        let p_OTip = frames.p_OTip(finger);
        let Some(mut now) = self.rolling[finger] else {
            let slip_O = Vec3::zeros();
            let first = (touch, p_OTip);
            self.rolling[finger] = Some(Rolling { first, touch, p_OTip, X_OL, half_way: None, slip_O });
            self.slip.note(0.0, place);
            return;
        };
        // Closest points of a convex surface move no farther than the centre does: more is a jump over a
        // concave edge, where the ball touches on both sides. Over a mild one it rolls on: the grasps before
        // and behind are both looked at, and the material points of neither side move.
        let step = (p_OTip - now.p_OTip).norm();
        self.jumps.note(((touch.p_OC - now.touch.p_OC).norm() - step).max(0.0), &place);
        if sample == 0 {
            // A segment begins where the last one ended, but for a finger that moved without being lifted.
            now.slip_O += tangential(&(p_OTip - now.p_OTip), &touch.n_O);
            (now.X_OL, now.half_way) = (X_OL, None);
        } else if let Some(half_way) = now.half_way.take() {
            now.slip_O += half_way.slip(&now.X_OL, &X_OL);
            now.X_OL = X_OL;
        } else {
            now.half_way = Some(Contact { X_OL, p_OC: touch.p_OC, n_O: touch.n_O });
        }
        (now.touch, now.p_OTip) = (touch, p_OTip);
        let slip = match self.law {
            TransferLaw::FixedPoint => now.strayed(),
            _ => now.slip_O.norm(),
        };
        self.slip.note(slip, place);
        self.rolling[finger] = Some(now);
    }

    /// Takes in the end of a regrasp: where the finger was lifted, its slip counts anew; else it has slid to
    /// where it is now.
    pub(crate) fn moved(&mut self, leg: &Leg<'_>, finger: usize, lifted: bool, frames: &Frames) {
        let last = leg.states.len() - 1;
        if lifted {
            self.rolling[finger] = None;
        } else if leg.states[last].holds(finger) {
            let touch = self.touch(finger, frames);
            self.follow(finger, touch, 0, frames, || Place { finger: Some(finger), ..leg.at(last) });
        }
    }

    /// Largest closure residual and slip, for the certificate.
    pub(crate) fn extremes(&self) -> (Option<Extreme>, Option<Extreme>) {
        let extreme =
            |gauge: &Gauge| Some(Extreme::new(gauge.worst()?, gauge.place().clone(), HoldsAt::Samples));
        (extreme(&self.closure), extreme(&self.slip))
    }

    pub(crate) fn checks(self) -> Vec<Check> {
        let checks = [self.closure, self.normals, self.slip, self.jumps].map(Gauge::check);
        checks.into_iter().chain(self.surface.check()).collect()
    }
}
