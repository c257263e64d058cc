//! Distances of all pairs that may not touch, exact where it counts and certified in between.
//!
//! A pair's distance changes no faster than its bodies move. So from one exact distance follows a lower bound
//! for as long as the bodies have not moved by more than its excess over what matters: over the distance
//! demanded, and over the smallest one found yet, which is to be reported exactly. Only where that bound is
//! used up a new distance is computed. Between samples the bodies may move by m in sum: both ends together
//! must be farther than m from touching, else the step is bisected (conservative advancement: Mirtich,
//! "Impulse-based dynamic simulation of rigid body systems", PhD thesis, Berkeley 1996; Schwarzer, Saha,
//! Latombe, "Exact collision checking of robot paths", WAFR 2002).

use crate::bounds::{Bounds, Samples};
use crate::hand::Chains;
use crate::scene::Scene;
use crate::shape::{self, Core};
use crate::solid::{ANYWHERE, Gap};
use crate::touch::Touch;
use crate::track::{Frames, Leg, SAMPLES};
use crate::verdict::{Check, Gauge, Side};
use nalgebra::Point3;
use regrasp_api::{Body, BodyPair, MAX_FINGERS};
use regrasp_plan::{Extreme, HoldsAt, Place};

/// How often a step between samples is halved before the clearance there counts as not certified: what
/// remains is a hundredth of the step.
const HALVINGS: u32 = 7;
/// How far below the smallest distance found the distance of a pair may be between samples (m): what the
/// certificate gives away so that its figure is a bound over all times.
const GRAIN: f64 = 1e-4;
/// The same over a whole stretch.
const MOST_HALVINGS: usize = 10_000;

/// The distances of all pairs.
pub(crate) struct ClearanceCheck<'s> {
    hand: &'s Chains,
    scene: &'s Scene,
    gauge: Gauge,
    demanded: f64,
    smallest: f64,
    bounds: Bounds<'s>,
    /// For each pair a lower bound of its distance at the last state (m); minus infinity where nothing is
    /// known.
    lower: Vec<f64>,
    /// For each pair of object and segment where they were closest at their last exact distance, in O.
    nearest: Vec<Gap>,
    /// Room for lower bounds of all pairs, by which they are asked in turn.
    turns: Vec<(f64, usize)>,
    /// Room for halved steps.
    spare: Frames,
    /// How many more halvings there may be: a plan that needs as many is no plan of ours.
    halvings_left: usize,
}

/// A pair on one step of the plan.
#[derive(Clone, Copy)]
struct Step<'l, 'p> {
    leg: &'l Leg<'p>,
    state: usize,
    pair: usize,
}

impl<'s> ClearanceCheck<'s> {
    /// `smallest` is a distance (m) that some pair of the plan is known to have, infinite where none is: what
    /// is farther apart need not be exact.
    pub(crate) fn new(hand: &'s Chains, scene: &'s Scene, demanded: f64, smallest: f64) -> Self {
        Self {
            hand,
            scene,
            gauge: Gauge::new("clearance", "m", Side::Above, demanded),
            demanded,
            smallest,
            bounds: Bounds::new(scene),
            lower: vec![f64::NEG_INFINITY; scene.pairs.len()],
            nearest: vec![Gap::somewhere(ANYWHERE); scene.pairs.len()],
            turns: Vec::new(),
            spare: Frames::new(hand),
            halvings_left: MOST_HALVINGS,
        }
    }

    /// The smallest distance of a pair at a state (m), or the one known where none is smaller there.
    pub(crate) fn glance(&mut self, leg: &Leg<'_>, frames: &Frames) -> f64 {
        let turns = self.turns(leg, frames);
        for &(bound, pair) in &turns {
            if bound < self.smallest {
                self.smallest = self.smallest.min(self.exact(pair, frames, true));
            }
        }
        self.turns = turns;
        self.smallest
    }

    /// The pairs that are compared with their bounds, the likeliest to be closest first: one exact distance
    /// then spares most of the others.
    fn turns(&mut self, leg: &Leg<'_>, frames: &Frames) -> Vec<(f64, usize)> {
        let mut turns = std::mem::take(&mut self.turns);
        turns.clear();
        let pairs = (0..self.scene.pairs.len()).filter(|&pair| self.compared(leg, pair));
        turns.extend(pairs.map(|pair| (self.bounds.balls(pair, frames), pair)));
        turns.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        turns
    }

    /// Takes in a stretch's first state: every pair anew, also whether one body lies inside the other.
    pub(crate) fn start(&mut self, leg: &Leg<'_>, state: usize, frames: &Frames) {
        for pair in 0..self.scene.pairs.len() {
            self.lower[pair] = f64::INFINITY;
            if self.compared(leg, pair) {
                let mut distance = self.bounds.balls(pair, frames);
                if distance <= self.smallest.max(self.demanded) {
                    distance = self.exact(pair, frames, true);
                    self.take(pair, distance, || leg.at(state));
                }
                self.lower[pair] = distance;
            }
        }
    }

    /// Whether the pair may not touch in this segment: a fingertip that holds the object may, and the one
    /// that moves in a regrasp is looked at on its own.
    fn compared(&self, leg: &Leg<'_>, pair: usize) -> bool {
        let (a, b) = self.scene.pairs[pair];
        match (self.scene.bodies[a].body, self.scene.bodies[b].body) {
            (Body::Object, Body::Fingertip(finger)) => {
                leg.moving != Some(finger.index()) && !leg.states[0].holds(finger.index())
            }
            _ => true,
        }
    }

    /// Takes in the step after `state`, sampled in `frames` ([`SAMPLES`] + 1 of them); `touches` are the
    /// contacts at the samples.
    pub(crate) fn step(
        &mut self,
        leg: &Leg<'_>,
        state: usize,
        frames: &[Frames],
        touches: &[[Option<Touch>; MAX_FINGERS]],
    ) {
        self.bounds.motions.step(self.scene, leg, state);
        for pair in 0..self.scene.pairs.len() {
            let motion = self.bounds.motions.of_pair(self.scene.pairs[pair]) * SAMPLES as f64;
            let floor = self.smallest.max(self.demanded);
            if motion == 0.0 || self.lower[pair] - motion > floor {
                self.lower[pair] -= motion;
                continue;
            }
            let seen = Samples { frames, touches };
            self.lower[pair] = self.span(Step { leg, state, pair }, (0, self.lower[pair]), SAMPLES, seen);
        }
    }

    /// Carries a pair's bound from one sample to another. In between no distance is below half of what both
    /// bounds leave of the motion (see the head of this file): where that is enough, nothing there is looked
    /// at; else the half-way sample is.
    fn span(
        &mut self,
        step: Step<'_, '_>,
        (from, before): (usize, f64),
        to: usize,
        seen: Samples<'_>,
    ) -> f64 {
        let bodies = self.scene.pairs[step.pair];
        let motion = self.bounds.motions.of_pair_between(self.scene, bodies, (from, to), seen.frames);
        let floor = self.smallest.max(self.demanded);
        if before - motion > floor {
            return before - motion;
        }
        let during = self.bound_during(step.pair, (from, to), seen, floor);
        if during > floor {
            return during;
        }
        let after = self.bound(step.pair, to, seen, floor);
        if after > floor && (before + after - motion) / 2.0 > floor {
            return after;
        }
        if to == from + 1 {
            return self.sample(step, before, (to, after), motion, seen.frames);
        }
        let middle = (from + to) / 2;
        let half_way = self.span(step, (from, before), middle, seen);
        self.span(step, (middle, half_way), to, seen)
    }

    /// Carries a pair's bound from the sample before to `sample`, with a new distance where the bound there
    /// is not enough.
    fn sample(
        &mut self,
        step: Step<'_, '_>,
        before: f64,
        (sample, mut after): (usize, f64),
        motion: f64,
        frames: &[Frames],
    ) -> f64 {
        let pair = step.pair;
        let place = |fraction: f64| step.leg.between(step.state, fraction);
        let end = sample as f64 / SAMPLES as f64;
        if after <= self.smallest.max(self.demanded) {
            after = self.exact(pair, &frames[sample], false);
            self.take(pair, after, || place(end));
        }
        let target = self.target();
        if before.min(after) > target && (before + after - motion) / 2.0 <= target {
            let before = self.exact(pair, &frames[sample - 1], false);
            let exact = self.exact(pair, &frames[sample], false);
            let start = (sample - 1) as f64 / SAMPLES as f64;
            self.certify(step, (start, before), (end, exact), (motion, 0));
        }
        after
    }

    /// Makes sure that the pair stays apart between two instants of a step, given as fraction and exact
    /// distance; `motion` is how far the two move in sum in between (m).
    fn certify(&mut self, step: Step<'_, '_>, from: (f64, f64), to: (f64, f64), (motion, depth): (f64, u32)) {
        let bound = (from.1 + to.1 - motion) / 2.0;
        if bound > self.target() {
            return;
        }
        let middle = (from.0 + to.0) / 2.0;
        let place = || step.leg.between(step.state, middle);
        if depth == HALVINGS || self.halvings_left == 0 {
            self.take(step.pair, bound, place);
            return;
        }
        self.halvings_left -= 1;
        let mut frames = std::mem::replace(&mut self.spare, Frames::empty());
        frames.place(self.hand, step.leg, step.state, middle);
        let distance = self.exact(step.pair, &frames, false);
        self.spare = frames;
        self.take(step.pair, distance, place);
        if distance > self.demanded {
            let half = (motion / 2.0, depth + 1);
            self.certify(step, from, (middle, distance), half);
            self.certify(step, (middle, distance), to, half);
        }
    }

    /// What distances between samples are certified to exceed: what is demanded, and the smallest one found
    /// less [`GRAIN`].
    pub(crate) fn target(&self) -> f64 {
        self.demanded.max(self.smallest - GRAIN)
    }

    fn take(&mut self, pair: usize, distance: f64, place: impl FnOnce() -> Place) {
        let (a, b) = self.scene.pairs[pair];
        let bodies = (self.scene.bodies[a].body, self.scene.bodies[b].body);
        self.smallest = self.smallest.min(distance);
        self.gauge.note(distance, || Place { pair: Some(bodies), ..place() });
    }

    /// Takes in the clearance of a moving fingertip above the object, where it counts as any other.
    pub(crate) fn take_tip(&mut self, finger: usize, distance: f64, place: impl FnOnce() -> Place) {
        self.smallest = self.smallest.min(distance);
        let pair = Some((Body::Object, Body::Fingertip(regrasp_api::FingerIndex(finger as u8))));
        self.gauge.note(distance, || Place { pair, ..place() });
    }

    /// The closest pair of those compared at a state, with its exact distance (m), beside the moving
    /// fingertip of a regrasp and the object. To the last digit it depends on the state alone, whose contacts
    /// `touches` are.
    pub(crate) fn closest(
        &mut self,
        leg: &Leg<'_>,
        frames: &Frames,
        touches: &[Option<Touch>; MAX_FINGERS],
    ) -> Option<(f64, BodyPair)> {
        for (gap, (_, b)) in self.nearest.iter_mut().zip(&self.scene.pairs) {
            // A finger is likely to be nearest where it touches.
            let touch = match self.scene.bodies[*b].body {
                Body::Link(finger, _) | Body::Fingertip(finger) => touches[finger.index()],
                _ => None,
            };
            *gap = Gap::somewhere(
                touch.filter(|_| !self.scene.has_twin()).map_or(ANYWHERE, |touch| touch.facet),
            );
        }
        let mut turns = self.turns(leg, frames);
        for (bound, pair) in &mut turns {
            *bound = bound.max(self.bounds.rods(*pair, frames));
        }
        turns.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut closest: Option<(f64, usize)> = None;
        for &(bound, pair) in &turns {
            let least = closest.map_or(f64::INFINITY, |(distance, _)| distance);
            if bound >= least {
                break;
            }
            if let Some(distance) = self.exact_below(pair, frames, true, least).filter(|d| *d < least) {
                closest = Some((distance, pair));
            }
        }
        self.turns = turns;
        closest.map(|(distance, pair)| {
            let (a, b) = self.scene.pairs[pair];
            (distance, (self.scene.bodies[a].body, self.scene.bodies[b].body))
        })
    }

    /// The exact distance of a pair (m); not positive where the bodies overlap.
    fn exact(&mut self, pair: usize, frames: &Frames, contained: bool) -> f64 {
        self.exact_below(pair, frames, contained, f64::INFINITY).unwrap_or(f64::INFINITY)
    }

    /// The same; `None`, which costs less, where it is not below `most` (m).
    fn exact_below(&mut self, pair: usize, frames: &Frames, contained: bool, most: f64) -> Option<f64> {
        let (a, b) = self.scene.pairs[pair];
        let (first, second) = (&self.scene.bodies[a], &self.scene.bodies[b]);
        let (X_HA, X_HB) = (self.scene.pose(a, frames), self.scene.pose(b, frames));
        let cores = match (&first.core, &second.core) {
            (Core::Mesh(solid), Core::Segment(p, q)) => {
                let X_AB = X_HA.inv_mul(X_HB);
                let [p, q] = [p, q].map(|end| (X_AB * Point3::from(*end)).coords);
                let cores = most + first.radius + second.radius;
                let found = solid.gap_below(&p, &q, self.nearest[pair].facet, cores);
                let gap = found.unwrap_or_else(|farther| farther);
                self.nearest[pair] = gap;
                match found {
                    _ if contained && solid.swallows(&p, &q, &gap) => 0.0,
                    Ok(gap) => gap.distance,
                    Err(_) => return None,
                }
            }
            _ => shape::distance(&first.core, X_HA, &second.core, X_HB, contained),
        };
        Some(cores - first.radius - second.radius)
    }

    /// A lower bound of a pair's distance at a sample (m) that is cheap: from balls or boxes around both, or
    /// a plane between object and segment; between rods and balls the distance itself. Stops at the first
    /// above `floor`.
    fn bound(&mut self, pair: usize, sample: usize, seen: Samples<'_>, floor: f64) -> f64 {
        let frames = &seen.frames[sample];
        let balls = self.bounds.balls(pair, frames);
        if balls > floor {
            return balls;
        }
        let (a, b) = self.scene.pairs[pair];
        let (first, second) = (&self.scene.bodies[a], &self.scene.bodies[b]);
        match (&first.core, &second.core) {
            (Core::Mesh(_), Core::Segment(..)) if first.body == Body::Object => {
                balls.max(self.bounds.planes((pair, &self.nearest[pair]), (sample, sample), seen, floor))
            }
            (Core::Point(_) | Core::Segment(..), Core::Point(_) | Core::Segment(..)) => {
                self.exact(pair, frames, false)
            }
            _ => balls.max(self.bounds.boxes(pair, (sample, sample), seen)),
        }
    }

    /// A lower bound of a pair's distance at two samples and all the time between (m), where one of them is a
    /// rod or a ball and the other one does not move, or is the object: by what does not bend between
    /// samples, and how far the rod may be from its straight way.
    fn bound_during(&mut self, pair: usize, span: (usize, usize), seen: Samples<'_>, floor: f64) -> f64 {
        let (a, b) = self.scene.pairs[pair];
        let (first, second) = (&self.scene.bodies[a], &self.scene.bodies[b]);
        match (&first.core, &second.core) {
            (Core::Mesh(_), Core::Segment(..)) if first.body == Body::Object => {
                self.bounds.planes((pair, &self.nearest[pair]), span, seen, floor)
            }
            _ => self.bounds.boxes(pair, span, seen),
        }
    }

    /// A lower bound of all distances at all times, for the certificate: at samples none is smaller than the
    /// smallest found, and between them none is more than [`GRAIN`] below it.
    pub(crate) fn extreme(&self) -> Option<Extreme> {
        let certified = |worst: f64| (worst - GRAIN).max(worst.min(self.demanded));
        let worst = self.gauge.worst()?;
        Some(Extreme::new(certified(worst), self.gauge.place().clone(), HoldsAt::EveryTime))
    }

    /// Takes in what was gathered later in the plan.
    pub(crate) fn join(&mut self, later: Self) {
        self.smallest = self.smallest.min(later.smallest);
        self.gauge.join(later.gauge);
    }

    pub(crate) fn check(self) -> Check {
        self.gauge.check()
    }
}
