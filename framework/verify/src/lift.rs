//! The moving fingertip of a regrasp: it touches the object at its two ends only, rising from there until it
//! is lifted.

use crate::clearance::ClearanceCheck;
use crate::hand::Chains;
use crate::scene::Scene;
use crate::solid::ANYWHERE;
use crate::touch::Touch;
use crate::track::{Frames, Leg, SAMPLES};
use crate::verdict::{Check, Gauge, Side};
use regrasp_api::{Body, Tolerances, Vec3};
use regrasp_plan::Place;

/// How often a step is halved before its clearance counts as not certified.
const HALVINGS: u32 = 10;

/// What is known of the moving fingertip at one instant.
#[derive(Clone, Copy, Debug)]
struct Instant {
    state: usize,
    fraction: f64,
    /// The ball's distance from what contacts live on (m).
    height: f64,
    /// The same, or its distance from the object's own surface if that is less (m).
    free: f64,
    p_OTip: Vec3,
}

/// The gauges of moving fingertips.
pub(crate) struct LiftCheck<'s> {
    hand: &'s Chains,
    scene: &'s Scene,
    tolerances: Tolerances,
    /// The height at which a finger counts as lifted (m).
    lift: f64,
    rise: Gauge,
    touch: Gauge,
    row: Vec<Instant>,
    facet: u32,
    spare: Frames,
}

impl<'s> LiftCheck<'s> {
    pub(crate) fn new(hand: &'s Chains, scene: &'s Scene, tolerances: &Tolerances, lift: f64) -> Self {
        Self {
            hand,
            scene,
            tolerances: *tolerances,
            lift,
            // A fall by less than a micrometre is how exactly joints interpolate a straight retreat.
            rise: Gauge::new("lift", "m", Side::AtMost, 1e-6),
            touch: Gauge::new("touch-travel", "m", Side::AtMost, tolerances.slip),
            row: Vec::new(),
            facet: ANYWHERE,
            spare: Frames::new(hand),
        }
    }

    /// Takes in one sample of a regrasp.
    pub(crate) fn sample(&mut self, finger: usize, state: usize, sample: usize, frames: &Frames) {
        let p_OTip = frames.p_OTip(finger);
        let touch = Touch::find(self.scene, &p_OTip, self.hand.tip_radius, self.facet);
        self.facet = touch.facet;
        let fraction = sample as f64 / SAMPLES as f64;
        let free = self.free(&touch, &p_OTip);
        self.row.push(Instant { state, fraction, height: touch.gap, free, p_OTip });
    }

    fn free(&self, touch: &Touch, p_OTip: &Vec3) -> f64 {
        if !self.scene.has_twin() {
            return touch.gap;
        }
        touch.gap.min(Touch::of_object(self.scene, p_OTip, self.hand.tip_radius, ANYWHERE).gap)
    }

    /// Judges the whole regrasp; says whether the finger was lifted.
    pub(crate) fn finish(
        &mut self,
        leg: &Leg<'_>,
        finger: usize,
        clearance: &mut ClearanceCheck<'_>,
    ) -> bool {
        let row = std::mem::take(&mut self.row);
        let last = row.len() - 1;
        let highest = row.iter().map(|i| i.height).fold(f64::NEG_INFINITY, f64::max);
        let lift = self.lift.min(highest);
        let lifted = |i: &Instant| i.height >= lift;
        let (mut from, mut to) = (0, last);
        if leg.states[0].holds(finger) {
            from = row.iter().position(lifted).unwrap_or(0);
            self.retreat(leg, finger, &mut row[..=from].iter());
        }
        if leg.states[leg.states.len() - 1].holds(finger) {
            to = row.iter().rposition(lifted).unwrap_or(last);
            self.retreat(leg, finger, &mut row[to..].iter().rev());
        }
        for instant in &row[from..=to.max(from)] {
            clearance.take_tip(finger, instant.free, || leg.between(instant.state, instant.fraction));
        }
        let tip = Body::Fingertip(regrasp_api::FingerIndex(finger as u8));
        let body = self.scene.bodies.iter().find(|solidity| solidity.body == tip);
        let (mut motion, mut of) = (0.0, None);
        for pair in row[from..=to.max(from)].windows(2) {
            if of != Some(pair[0].state) {
                of = Some(pair[0].state);
                let steps: Vec<f64> = leg.joint_steps(pair[0].state).collect();
                motion = body.map_or(0.0, |body| body.motion(&steps).0);
            }
            self.certify((leg, finger, motion), (&pair[0], &pair[1]), 0, clearance);
        }
        self.row = row;
        highest >= self.lift
    }

    /// Follows a fingertip from its contact until it is lifted (backwards in time for the contact at the
    /// end).
    fn retreat(&mut self, leg: &Leg<'_>, finger: usize, instants: &mut dyn Iterator<Item = &Instant>) {
        let Some(contact) = instants.next() else { return };
        let (mut highest, mut touching) = (contact.height, true);
        for instant in instants {
            let place = || Place { finger: Some(finger), ..leg.between(instant.state, instant.fraction) };
            // Below the highest point yet, so that many small falls are one large one.
            self.rise.note(highest - instant.height, place);
            touching &= instant.height <= self.tolerances.closure;
            if touching {
                self.touch.note((instant.p_OTip - contact.p_OTip).norm(), place);
            }
            highest = highest.max(instant.height);
        }
    }

    /// Makes sure that the lifted tip stays clear between two instants of a step, in all of which it moves so
    /// far at most (m).
    fn certify(
        &mut self,
        (leg, finger, motion): (&Leg<'_>, usize, f64),
        (a, b): (&Instant, &Instant),
        depth: u32,
        clearance: &mut ClearanceCheck<'_>,
    ) {
        let state = a.state;
        let (start, end) = (a.fraction, if b.state == state { b.fraction } else { 1.0 });
        let target = clearance.target();
        let bound = (a.free + b.free - motion * (end - start)) / 2.0;
        if bound > target || a.free.min(b.free) <= target {
            return; // Clear, or known not to be.
        }
        let fraction = (start + end) / 2.0;
        if depth == HALVINGS {
            clearance.take_tip(finger, bound, || leg.between(state, fraction));
            return;
        }
        self.spare.place(self.hand, leg, state, fraction);
        let p_OTip = self.spare.p_OTip(finger);
        let touch = Touch::find(self.scene, &p_OTip, self.hand.tip_radius, self.facet);
        let free = self.free(&touch, &p_OTip);
        clearance.take_tip(finger, free, || leg.between(state, fraction));
        let middle = Instant { state, fraction, height: touch.gap, free, p_OTip };
        let end = Instant { state, fraction: end, ..*b };
        self.certify((leg, finger, motion), (a, &middle), depth + 1, clearance);
        self.certify((leg, finger, motion), (&middle, &end), depth + 1, clearance);
    }

    /// Takes in what was gathered later in the plan.
    pub(crate) fn join(&mut self, later: Self) {
        self.rise.join(later.rise);
        self.touch.join(later.touch);
    }

    pub(crate) fn checks(self) -> [Check; 2] {
        [self.rise.check(), self.touch.check()]
    }
}
