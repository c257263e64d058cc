//! Distances of all pairs that may not touch, exact where it counts and certified in between.
//!
//! A pair's distance changes no faster than its bodies move. So from one exact distance follows a lower bound
//! for as long as the bodies have not moved by more than its excess over what matters: over the distance
//! demanded, and over the smallest one found yet, which is to be reported exactly. Only where that bound is
//! used up a new distance is computed. Between samples the bodies may move by m in sum: both ends together
//! must be farther than m from touching, else the step is bisected (conservative advancement: Mirtich,
//! "Impulse-based dynamic simulation of rigid body systems", PhD thesis, Berkeley 1996; Schwarzer, Saha,
//! Latombe, "Exact collision checking of robot paths", WAFR 2002).

use crate::hand::Chains;
use crate::motion::Motions;
use crate::scene::Scene;
use crate::shape::{self, Core};
use crate::solid::{Gap, Solid};
use crate::touch::Touch;
use crate::track::{Frames, Leg, SAMPLES};
use crate::verdict::{Check, Gauge, Side};
use nalgebra::Point3;
use regrasp_api::{Body, BodyPair, MAX_FINGERS, Vec3};
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
    /// How far the bodies move over the step.
    motions: Motions,
    /// For each pair a lower bound of its distance at the last state (m); minus infinity where nothing is
    /// known.
    lower: Vec<f64>,
    /// For each pair of object and segment where they were closest at their last exact distance, in O.
    nearest: Vec<Gap>,
    /// For each pair of object and segment what the two planes between them were put up by.
    supports: Vec<[Supported; 2]>,
    /// Room for lower bounds of all pairs, by which they are asked in turn.
    bounds: Vec<(f64, usize)>,
    /// Room for halved steps.
    spare: Frames,
    /// How many more halvings there may be: a plan that needs as many is no plan of ours.
    halvings_left: usize,
}

/// How far the object reaches in a direction, remembered: the next one asked about is hardly another.
#[derive(Clone, Copy, Default)]
struct Supported {
    n_O: Vec3,
    support: f64,
}

impl Supported {
    /// The largest of `n_O · v` over the solid's vertices (m), which are at most `reach` from the origin, or
    /// an upper bound of it that is no more than `enough`.
    fn support(&mut self, solid: &Solid, n_O: &Vec3, reach: f64, enough: f64) -> f64 {
        // Turned by so much, no vertex rises by more than that times its distance.
        let loose = self.support + reach * (n_O - self.n_O).norm();
        if loose <= enough {
            return loose;
        }
        *self = Self { n_O: *n_O, support: solid.support(n_O) };
        self.support
    }
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
            motions: Motions::new(scene),
            lower: vec![f64::NEG_INFINITY; scene.pairs.len()],
            nearest: vec![Gap::somewhere(0); scene.pairs.len()],
            supports: vec![Default::default(); scene.pairs.len()],
            bounds: Vec::new(),
            spare: Frames::new(hand),
            halvings_left: MOST_HALVINGS,
        }
    }

    /// The smallest distance of a pair at a state (m), or the one known where none is smaller there.
    pub(crate) fn glance(&mut self, leg: &Leg<'_>, frames: &Frames) -> f64 {
        for pair in 0..self.scene.pairs.len() {
            if self.compared(leg, pair) && self.balls(pair, frames) < self.smallest {
                self.smallest = self.smallest.min(self.exact(pair, frames, true));
            }
        }
        self.smallest
    }

    /// Takes in a stretch's first state: every pair anew, also whether one body lies inside the other.
    pub(crate) fn start(&mut self, leg: &Leg<'_>, state: usize, frames: &Frames) {
        for pair in 0..self.scene.pairs.len() {
            self.lower[pair] = f64::INFINITY;
            if self.compared(leg, pair) {
                let mut distance = self.balls(pair, frames);
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
        self.motions.step(self.scene, leg, state);
        for pair in 0..self.scene.pairs.len() {
            let motion = self.motions.of_pair(self.scene.pairs[pair]) * SAMPLES as f64;
            let floor = self.smallest.max(self.demanded);
            if motion == 0.0 || self.lower[pair] - motion > floor {
                self.lower[pair] -= motion;
                continue;
            }
            let step = Step { leg, state, pair };
            for (sample, touches) in touches.iter().enumerate().skip(1) {
                self.sample(step, sample, frames, touches);
            }
        }
    }

    /// Carries a pair's bound from the sample before to `sample`, with a new distance where the bound is used
    /// up.
    fn sample(
        &mut self,
        step: Step<'_, '_>,
        sample: usize,
        frames: &[Frames],
        touches: &[Option<Touch>; MAX_FINGERS],
    ) {
        let pair = step.pair;
        let motion = self.motions.of_pair_seen(self.scene, self.scene.pairs[pair], sample, frames);
        let floor = self.smallest.max(self.demanded);
        let before = self.lower[pair];
        if before - motion > floor {
            self.lower[pair] = before - motion;
            return;
        }
        let place = |fraction: f64| step.leg.between(step.state, fraction);
        let end = sample as f64 / SAMPLES as f64;
        let mut after = self.bound(pair, &frames[sample], touches, floor);
        if after <= floor {
            after = self.exact(pair, &frames[sample], false);
            self.take(pair, after, || place(end));
        }
        self.lower[pair] = after;
        let target = self.target();
        if before.min(after) > target && (before + after - motion) / 2.0 <= target {
            let before = self.exact(pair, &frames[sample - 1], false);
            let after = self.exact(pair, &frames[sample], false);
            let start = (sample - 1) as f64 / SAMPLES as f64;
            self.certify(step, (start, before), (end, after), (motion, 0));
        }
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
            *gap = Gap::somewhere(touch.filter(|_| !self.scene.has_twin()).map_or(0, |touch| touch.facet));
        }
        let mut bounds = std::mem::take(&mut self.bounds);
        bounds.clear();
        let pairs = 0..self.scene.pairs.len();
        bounds.extend(
            pairs.filter(|&pair| self.compared(leg, pair)).map(|pair| (self.balls(pair, frames), pair)),
        );
        // The likeliest first: one exact distance then spares most of the others.
        bounds.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut closest: Option<(f64, usize)> = None;
        for &(bound, pair) in &bounds {
            let least = closest.map_or(f64::INFINITY, |(distance, _)| distance);
            if bound >= least {
                break;
            }
            if let Some(distance) = self.exact_below(pair, frames, true, least).filter(|d| *d < least) {
                closest = Some((distance, pair));
            }
        }
        self.bounds = bounds;
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

    /// A lower bound of a pair's distance (m) from balls around both, or the box that one of them is.
    fn balls(&self, pair: usize, frames: &Frames) -> f64 {
        let (a, b) = self.scene.pairs[pair];
        let (first, second) = (&self.scene.bodies[a], &self.scene.bodies[b]);
        let (X_HA, X_HB) = (self.scene.pose(a, frames), self.scene.pose(b, frames));
        match (first.ball, second.ball) {
            (Some((p, r)), Some((q, s))) => {
                let [p, q] = [(X_HA, p), (X_HB, q)].map(|(X, p)| (X * Point3::from(p)).coords);
                let balls = (p - q).norm() - r - s;
                balls.max(first.core.box_to(X_HA, &q) - s).max(second.core.box_to(X_HB, &p) - r)
            }
            _ => f64::NEG_INFINITY,
        }
    }

    /// A cheap lower bound of a pair's distance (m): balls around both, or a plane between object and
    /// segment. Stops at the first above `floor`.
    fn bound(
        &mut self,
        pair: usize,
        frames: &Frames,
        touches: &[Option<Touch>; MAX_FINGERS],
        floor: f64,
    ) -> f64 {
        let (a, b) = self.scene.pairs[pair];
        let (first, second) = (&self.scene.bodies[a], &self.scene.bodies[b]);
        let (X_HA, X_HB) = (self.scene.pose(a, frames), self.scene.pose(b, frames));
        let mut bound = self.balls(pair, frames);
        if let (Body::Object, Core::Mesh(solid), Core::Segment(p, q)) =
            (first.body, &first.core, &second.core)
        {
            let X_AB = X_HA.inv_mul(X_HB);
            let ends = [p, q].map(|end| (X_AB * Point3::from(*end)).coords);
            let touch = match second.body {
                Body::Link(finger, _) => touches[finger.index()].map(|touch| touch.n_O),
                _ => None,
            };
            for (k, n) in [touch, Some(self.nearest[pair].direction)].into_iter().enumerate() {
                let Some(n) = n else { continue };
                let above = ends[0].dot(&n).min(ends[1].dot(&n)) - second.radius;
                let support =
                    self.supports[pair][k].support(solid, &n, self.scene.object_reach, above - floor);
                bound = bound.max(above - support);
                if bound > floor {
                    break;
                }
            }
        }
        bound
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
