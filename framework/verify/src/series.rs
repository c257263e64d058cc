//! Margin and clearance state by state: what a certificate gives only the extremes of.

use crate::clearance::ClearanceCheck;
use crate::contact_checks::ContactChecks;
use crate::hand::Chains;
use crate::object::weight_H;
use crate::scene::Scene;
use crate::stability::StabilityCheck;
use crate::track::{self, Frames, Leg};
use crate::walk::{prepare, travel};
use regrasp_api::{Body, BodyPair, FingerIndex, MAX_FINGERS};
use regrasp_plan::Plan;
use std::fmt;

/// The figures of one state of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateFigures {
    /// Certified lower bound of the closure margin of the fingers that hold; where the plan claims
    /// equilibrium, the smallest room of forces that hold the load (fraction of the largest normal force). 0
    /// or less where stability is not proved, `None` where it is not checked.
    pub margin: Option<f64>,
    /// The smallest distance of two bodies that may not touch (m), and the two. The fingertip that a regrasp
    /// moves counts while it is lifted.
    pub clearance: Option<(f64, BodyPair)>,
}

/// Why a plan has no figures along its motion: it does not fit its own hand, or its scene makes no sense.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeriesError(String);

impl fmt::Display for SeriesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

impl std::error::Error for SeriesError {}

impl SeriesError {
    pub(crate) fn new(note: String) -> Self {
        Self(note)
    }
}

/// The figures of every state, segment after segment; `Err` says what in the plan makes no sense.
///
/// At the states alone: between them a clearance can be smaller. Cost: below 0.5 ms a state of four fingers,
/// nearly all of it for the margin in transfers (a conic program for each grasp).
pub fn series(plan: &Plan) -> Result<Vec<Vec<StateFigures>>, SeriesError> {
    let problem = &plan.scenario.problem;
    let (hand, object) = prepare(plan).map_err(SeriesError)?;
    let unsound = |_| SeriesError("some states do not fit the hand; `verify` names them".into());
    let legs = track::legs(&plan.segments, &hand).map_err(unsound)?;
    let scene = Scene::new(problem, &object, &hand, &travel(&hand, &legs)).map_err(SeriesError)?;
    let tolerances = &problem.limits.tolerances;
    let mut figures = Figures {
        hand: &hand,
        lift: problem.limits.resolution.retreat.into_iter().fold(problem.limits.resolution.lift, f64::min),
        contacts: ContactChecks::new(&hand, &scene, tolerances),
        stability: StabilityCheck::new(&plan.claims, weight_H(plan, &object)),
        clearance: ClearanceCheck::new(&hand, &scene, tolerances.clearance, f64::INFINITY),
        frames: Frames::new(&hand),
    };
    Ok(legs.iter().map(|leg| figures.segment(leg)).collect())
}

/// What the figures are taken with.
struct Figures<'s> {
    hand: &'s Chains,
    /// The height at which a finger counts as lifted (m).
    lift: f64,
    contacts: ContactChecks<'s>,
    stability: StabilityCheck,
    clearance: ClearanceCheck<'s>,
    frames: Frames,
}

impl Figures<'_> {
    fn segment(&mut self, leg: &Leg<'_>) -> Vec<StateFigures> {
        self.stability.start();
        let mut figures: Vec<_> = (0..leg.states.len()).map(|state| self.state(leg, state)).collect();
        if let Some(finger) = leg.moving {
            self.add_tip(leg, finger, &mut figures);
        }
        figures
    }

    fn state(&mut self, leg: &Leg<'_>, state: usize) -> StateFigures {
        self.frames.place(self.hand, leg, state, 0.0);
        let mut touches = [None; MAX_FINGERS];
        for (finger, touch) in touches.iter_mut().enumerate().take(self.hand.fingers.len()) {
            *touch = leg.states[state].holds(finger).then(|| self.contacts.touch(finger, &self.frames));
        }
        StateFigures {
            margin: self.stability.figure(leg, &self.frames.X_HO.rotation, &touches),
            clearance: self.clearance.closest(leg, &self.frames, &touches),
        }
    }

    /// Takes in the moving fingertip between its first and its last lifted state.
    fn add_tip(&mut self, leg: &Leg<'_>, finger: usize, figures: &mut [StateFigures]) {
        let heights: Vec<f64> = (0..leg.states.len()).map(|state| self.height(leg, finger, state)).collect();
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let lifted = |height: &f64| *height >= self.lift.min(highest);
        let holds = |state: usize| leg.states[state].holds(finger);
        let first = if holds(0) { heights.iter().position(lifted).unwrap_or(0) } else { 0 };
        let last = heights.len() - 1;
        let last = if holds(last) { heights.iter().rposition(lifted).unwrap_or(last) } else { last };
        let pair = (Body::Object, Body::Fingertip(FingerIndex(finger as u8)));
        for state in first..=last {
            let clearance = &mut figures[state].clearance;
            if clearance.is_none_or(|(least, _)| heights[state] < least) {
                *clearance = Some((heights[state], pair));
            }
        }
    }

    /// How far a fingertip is above the object (m).
    fn height(&mut self, leg: &Leg<'_>, finger: usize, state: usize) -> f64 {
        self.frames.place(self.hand, leg, state, 0.0);
        self.contacts.touch(finger, &self.frames).gap
    }
}
