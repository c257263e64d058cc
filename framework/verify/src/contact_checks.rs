//! What happens at the contacts: closure, normals, the surface that they live on; and what their slip is
//! measured from.

use crate::hand::Chains;
use crate::scene::Scene;
use crate::slip::{Event, Hold, SlipCheck};
use crate::solid::ANYWHERE;
use crate::surface::SurfaceCheck;
use crate::touch::Touch;
use crate::track::{Frames, Leg, SAMPLES};
use crate::verdict::{Check, Gauge, Side};
use nalgebra::Point3;
use regrasp_api::{MAX_FINGERS, Tolerances, Vec3};
use regrasp_plan::{ContactRecord, Extreme, Place};

/// The gauges of all contacts.
pub(crate) struct ContactChecks<'s> {
    hand: &'s Chains,
    scene: &'s Scene,
    closure: Gauge,
    normals: Gauge,
    events: Vec<Event>,
    facets: [u32; MAX_FINGERS],
    surface: SurfaceCheck,
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
    pub(crate) fn new(hand: &'s Chains, scene: &'s Scene, tolerances: &Tolerances) -> Self {
        Self {
            surface: SurfaceCheck::new(scene, hand.tip_radius, tolerances.closure),
            hand,
            scene,
            closure: Gauge::new("closure", "m", Side::AtMost, tolerances.closure),
            normals: Gauge::new("normals", "rad", Side::AtMost, tolerances.normal),
            events: Vec::new(),
            facets: [ANYWHERE; MAX_FINGERS],
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
                self.follow(finger, touch, (state, sample), frames);
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

    /// Remembers where a finger holds, for its slip.
    fn follow(&mut self, finger: usize, touch: Touch, (state, sample): (usize, usize), frames: &Frames) {
        let X_OL = frames.X_HO.inv_mul(frames.last_link(&self.hand.fingers[finger]));
        let p_OTip = frames.p_OTip(finger);
        let Touch { p_OC, n_O, .. } = touch;
        self.events.push(Event::Holds(Hold { finger, state, sample, p_OC, n_O, p_OTip, X_OL }));
    }

    /// Takes in the end of a regrasp: where the finger was lifted, its slip counts anew; else it has slid to
    /// where it is now.
    pub(crate) fn moved(&mut self, leg: &Leg<'_>, finger: usize, lifted: bool, frames: &Frames) {
        let last = leg.states.len() - 1;
        if lifted {
            self.events.push(Event::Lifted { finger });
        } else if leg.states[last].holds(finger) {
            let touch = self.touch(finger, frames);
            self.follow(finger, touch, (last, 0), frames);
        }
    }

    /// What the contacts did, in the order of the motion; what is told once is not told again.
    pub(crate) fn events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// Takes in what was gathered later in the plan.
    pub(crate) fn join(&mut self, later: Self) {
        self.closure.join(later.closure);
        self.normals.join(later.normals);
        self.surface.join(later.surface);
    }

    /// Looks all over the surface that contacts live on.
    pub(crate) fn look_all_over(&mut self, threads: usize) {
        self.surface.look_all_over(self.scene, threads);
    }

    /// Largest closure residual, for the certificate.
    pub(crate) fn extreme(&self) -> Option<Extreme> {
        self.closure.extreme()
    }

    /// Closure, normals, then those of `slip`, and the contact surface.
    pub(crate) fn checks(self, slip: SlipCheck) -> Vec<Check> {
        let checks = [self.closure, self.normals].map(Gauge::check).into_iter().chain(slip.checks());
        checks.chain(self.surface.check()).collect()
    }
}
