//! The checks that look at where everything is at each sample, over one stretch of the plan.
//!
//! Stretches are the same whatever the number of threads, and know nothing of each other: what one finds does
//! not depend on which thread looks, and when. Found in order and joined, it is what the whole plan shows.

use crate::clearance::ClearanceCheck;
use crate::contact_checks::ContactChecks;
use crate::controller::ControllerCheck;
use crate::hand::Chains;
use crate::lift::LiftCheck;
use crate::object::weight_H;
use crate::scene::Scene;
use crate::slip::Event;
use crate::stability::{ConesCheck, HoldingCheck, HoldsCheck, StabilityCheck};
use crate::touch::Touch;
use crate::track::{Frames, Leg, SAMPLES};
use regrasp_api::{MAX_FINGERS, ObjectModel};
use regrasp_plan::{Criterion, Plan};

/// A transfer is divided into stretches of at least so many steps.
const STEPS: usize = 24;

/// Some steps of a segment: a whole regrasp, or a part of a transfer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stretch {
    pub(crate) leg: usize,
    /// Its first and its last state.
    pub(crate) from: usize,
    pub(crate) to: usize,
}

/// All stretches of a plan, in order.
pub(crate) fn stretches(legs: &[Leg<'_>]) -> Vec<Stretch> {
    let of_leg = |(leg, this): (usize, &Leg<'_>)| {
        let steps = this.states.len() - 1;
        // A moving finger is judged from its lift to its touch-down.
        let parts = if this.moving.is_some() { 1 } else { (steps / STEPS).max(1) };
        (0..parts).map(move |k| Stretch { leg, from: steps * k / parts, to: steps * (k + 1) / parts })
    };
    legs.iter().enumerate().flat_map(of_leg).collect()
}

/// What stretches are looked at with.
#[derive(Clone, Copy)]
pub(crate) struct Look<'w> {
    pub(crate) plan: &'w Plan,
    pub(crate) hand: &'w Chains,
    pub(crate) object: &'w ObjectModel,
    pub(crate) scene: &'w Scene,
    pub(crate) legs: &'w [Leg<'w>],
    /// Whether any state records forces.
    pub(crate) has_forces: bool,
    /// A distance that two bodies of the plan have which may not touch (m).
    pub(crate) smallest: f64,
}

/// What stretches of the plan show.
pub(crate) struct Seen<'w> {
    pub(crate) contacts: ContactChecks<'w>,
    pub(crate) clearance: ClearanceCheck<'w>,
    pub(crate) lift: LiftCheck<'w>,
    pub(crate) stability: StabilityCheck,
    /// In its place where contacts have cones of their own.
    pub(crate) cones: Option<ConesCheck>,
    /// In its place where the plan claims that joints' efforts hold the object; `None` within where the claim
    /// has no meaning.
    pub(crate) holding: Option<Option<HoldingCheck>>,
    pub(crate) holds: Option<HoldsCheck>,
    pub(crate) controller: ControllerCheck,
}

impl<'w> Look<'w> {
    /// Nothing seen yet.
    pub(crate) fn nothing(&self) -> Seen<'w> {
        let limits = &self.plan.scenario.problem.limits;
        let (tolerances, resolution) = (&limits.tolerances, &limits.resolution);
        // The lowest height that the scenario lets a finger lift to.
        let lift = resolution.retreat.into_iter().fold(resolution.lift, f64::min);
        let (claims, weight_H) = (&self.plan.claims, weight_H(self.plan, self.object));
        let friction = self.object.friction;
        Seen {
            contacts: ContactChecks::new(self.hand, self.scene, tolerances),
            clearance: ClearanceCheck::new(self.hand, self.scene, tolerances.clearance, self.smallest),
            lift: LiftCheck::new(self.hand, self.scene, tolerances, lift),
            stability: StabilityCheck::new(claims, weight_H),
            cones: ConesCheck::new(claims, weight_H),
            holding: self.holding(),
            holds: HoldsCheck::new(claims, (weight_H, self.object.mass, friction), self.has_forces),
            controller: ControllerCheck::new(self.hand, tolerances.closure),
        }
    }

    fn holding(&self) -> Option<Option<HoldingCheck>> {
        let claims = &self.plan.claims;
        let Criterion::Holding(load) = &claims.criterion else { return None };
        // Without an elliptic cone nothing can be checked, and the check of closure says so.
        claims.contact.cone?;
        Some(HoldingCheck::new(claims, load, weight_H(self.plan, self.object)))
    }

    /// Looks at one stretch.
    pub(crate) fn at(&self, stretch: Stretch) -> Seen<'w> {
        let leg = &self.legs[stretch.leg];
        let mut walk = Walk {
            hand: self.hand,
            scene: self.scene,
            leg,
            seen: self.nothing(),
            frames: vec![Frames::new(self.hand); SAMPLES + 1],
            touches: [[None; MAX_FINGERS]; SAMPLES + 1],
        };
        walk.begin(stretch.from);
        for state in stretch.from..stretch.to {
            walk.step(state);
        }
        walk.end();
        walk.seen
    }
}

impl Seen<'_> {
    /// Takes in the next stretch; what contacts did comes back.
    pub(crate) fn join(&mut self, mut later: Self) -> Vec<Event> {
        let events = later.contacts.events();
        self.contacts.join(later.contacts);
        self.clearance.join(later.clearance);
        self.lift.join(later.lift);
        self.stability.join(later.stability);
        if let (Some(cones), Some(later)) = (&mut self.cones, later.cones) {
            cones.join(later);
        }
        if let (Some(Some(holding)), Some(Some(later))) = (&mut self.holding, later.holding) {
            holding.join(later);
        }
        if let (Some(holds), Some(later)) = (&mut self.holds, later.holds) {
            holds.join(later);
        }
        self.controller.join(later.controller);
        events
    }
}

/// A walk along one stretch.
struct Walk<'w> {
    hand: &'w Chains,
    scene: &'w Scene,
    leg: &'w Leg<'w>,
    seen: Seen<'w>,
    /// Where everything is at the samples of a step, its two states included.
    frames: Vec<Frames>,
    touches: [[Option<Touch>; MAX_FINGERS]; SAMPLES + 1],
}

impl Walk<'_> {
    /// The stretch's first state.
    fn begin(&mut self, state: usize) {
        let Self { hand, leg, seen, .. } = self;
        let (frames, touches) = (&mut self.frames[SAMPLES], &mut self.touches[SAMPLES]);
        frames.place(hand, leg, state, 0.0);
        *touches = seen.contacts.sample(leg, state, 0, frames);
        if state > 0 {
            // The stretch before has told where they are.
            seen.contacts.events();
        }
        seen.stability.sample(leg, state, 0, &frames.X_HO.rotation, touches);
        if let Some(cones) = &mut seen.cones {
            cones.state((leg, state), hand, frames, touches);
        }
        if let Some(Some(holding)) = &mut seen.holding {
            holding.sample((leg, state, 0), hand, frames, touches);
        }
        if let Some(holds) = seen.holds.as_mut().filter(|_| state == 0) {
            holds.state(leg, state, hand, frames);
        }
        seen.clearance.start(leg, state, frames);
        if let Some(finger) = leg.moving {
            seen.lift.sample(finger, state, 0, frames);
        }
    }

    /// The step after a state.
    fn step(&mut self, state: usize) {
        self.frames.swap(0, SAMPLES);
        self.touches.swap(0, SAMPLES);
        for sample in 1..=SAMPLES {
            self.sample(state, sample);
        }
        let Self { hand, leg, seen, frames, touches, .. } = self;
        if let Some(holds) = &mut seen.holds {
            holds.state(leg, state + 1, hand, &frames[SAMPLES]);
        }
        seen.clearance.step(leg, state, frames, touches);
        seen.controller.step(hand, self.scene, leg, state);
    }

    fn sample(&mut self, state: usize, sample: usize) {
        let Self { hand, leg, seen, .. } = self;
        let (before, after) = self.frames.split_at_mut(sample);
        let frames = &mut after[0];
        frames.place_after(&before[0], hand, leg, state, sample as f64 / SAMPLES as f64);
        // In a regrasp all that holds rests: its contacts are looked at where the plan states them.
        let stated = sample == SAMPLES;
        if leg.moving.is_none() || stated {
            let touches = seen.contacts.sample(leg, state, sample, frames);
            seen.stability.sample(leg, state, sample, &frames.X_HO.rotation, &touches);
            if let Some(cones) = seen.cones.as_mut().filter(|_| stated) {
                cones.state((leg, state + 1), hand, frames, &touches);
            }
            if let Some(Some(holding)) = &mut seen.holding {
                holding.sample((leg, state, sample), hand, frames, &touches);
            }
            self.touches[sample] = touches;
        } else {
            self.touches[sample] = self.touches[0];
        }
        if let Some(finger) = leg.moving {
            seen.lift.sample(finger, state, sample, frames);
        }
    }

    /// The end of a regrasp.
    fn end(&mut self) {
        let Self { leg, seen, frames, .. } = self;
        if let Some(finger) = leg.moving {
            let lifted = seen.lift.finish(leg, finger, &mut seen.clearance);
            seen.contacts.moved(leg, finger, lifted, &frames[SAMPLES]);
        }
    }
}
