//! Grasps by themselves, nothing moving: form, limits, closure, normals, distances, stability, forces.

use crate::clearance::ClearanceCheck;
use crate::contact_checks::deviation;
use crate::hand::Chains;
use crate::object::weight_H;
use crate::scene::Scene;
use crate::series::SeriesError;
use crate::stability::{HoldingCheck, HoldsCheck, StabilityCheck};
use crate::surface::SurfaceCheck;
use crate::touch::Touch;
use crate::track::{Frames, Leg, state};
use crate::verdict::{Check, Gauge, Side};
use crate::walk::{prepare, travel};
use crate::{claims, motion_checks};
use regrasp_api::{BodyPair, MAX_FINGERS, Tolerances, Vec3};
use regrasp_plan::{Claims, Criterion, Place, Plan, StateRecord};
use std::{slice, thread};

/// Judges grasps of one problem.
///
/// The plan that it is made from says hand, object, obstacles and claims; it need not have any motion. All
/// that [`crate::verify`] asks of a state holds for each grasp, and nothing is shared between two of them.
pub struct GraspVerifier {
    hand: Chains,
    scene: Scene,
    claims: Claims,
    tolerances: Tolerances,
    weight_H: Vec3,
    mass: f64,
    friction: f64,
}

/// The figures of one grasp that is right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GraspFigures {
    /// Certified lower bound of the closure margin; where a load is claimed to be held, the smallest room of
    /// the forces that hold it. `None` where stability is not checked: the claimed cone is no elliptic one.
    pub margin: Option<f64>,
    /// The smallest distance of two bodies that may not touch (m), and the two.
    pub clearance: Option<(f64, BodyPair)>,
    /// The largest residual of closure (m).
    pub closure: f64,
    /// The friction that the recorded forces need, and the largest share of a joint's effort limit that they
    /// take; `None` where none are recorded.
    pub forces: Option<(f64, f64)>,
}

impl GraspVerifier {
    /// Prepares hand and scene; `Err` says what in the plan makes no sense, or which of its claims does not
    /// agree with its scenario.
    pub fn new(plan: &Plan) -> Result<Self, SeriesError> {
        let (hand, object) = prepare(plan).map_err(SeriesError::new)?;
        let scene = Scene::new(&plan.scenario.problem, &object, &hand, &travel(&hand, &[]));
        let scene = scene.map_err(SeriesError::new)?;
        let tolerances = plan.scenario.problem.limits.tolerances;
        let mut surface = SurfaceCheck::new(&scene, hand.tip_radius, tolerances.closure);
        surface.look_all_over(&scene, thread::available_parallelism().map_or(1, usize::from));
        for check in surface.check().into_iter().chain([claims::claims(plan, &object)]) {
            if !check.ok {
                let note = check.place.note.unwrap_or_default();
                return Err(SeriesError::new(format!("{}: {note}", check.name)));
            }
        }
        let (weight_H, mass, friction) = (weight_H(plan, &object), object.mass, object.friction);
        Ok(Self { hand, scene, claims: plan.claims.clone(), tolerances, weight_H, mass, friction })
    }

    /// A judge, one for each thread.
    pub fn judge(&self) -> GraspJudge<'_> {
        let holding = match &self.claims.criterion {
            Criterion::Holding(load) if self.claims.contact.cone.is_some() => {
                Some(HoldingCheck::new(&self.claims, load, self.weight_H))
            }
            _ => None,
        };
        GraspJudge {
            of: self,
            clearance: ClearanceCheck::new(&self.hand, &self.scene, self.tolerances.clearance, f64::INFINITY),
            frames: Frames::new(&self.hand),
            stability: StabilityCheck::new(&self.claims, self.weight_H),
            holding,
            holds: HoldsCheck::new(&self.claims, (self.weight_H, self.mass, self.friction), true),
        }
    }
}

/// Judges one grasp after the other. What it remembers changes the cost alone, never an answer.
pub struct GraspJudge<'v> {
    of: &'v GraspVerifier,
    clearance: ClearanceCheck<'v>,
    frames: Frames,
    stability: StabilityCheck,
    /// Where the claim is that joints' efforts hold the object; `None` within where it has no meaning.
    holding: Option<Option<HoldingCheck>>,
    holds: Option<HoldsCheck>,
}

type Touches = [Option<Touch>; MAX_FINGERS];

impl GraspJudge<'_> {
    /// Judges a grasp; the first check that it fails where it is wrong. Forces that the state records must
    /// hold the object; they also help to prove that it is stable.
    ///
    /// Cost: some 20 µs for four fingers where forces are recorded; where not, a conic program on top.
    pub fn judge(&mut self, record: &StateRecord) -> Result<GraspFigures, Box<Check>> {
        let here = state(record, &self.of.hand).map_err(|note| fault("form", note))?;
        let leg = Leg { index: 0, moving: None, states: vec![here] };
        let (hand, legs) = (&self.of.hand, slice::from_ref(&leg));
        pass(motion_checks::quaternions(legs))?;
        pass(motion_checks::joint_limits(hand, legs))?;
        motion_checks::driven_joints(hand, legs).map_or(Ok(()), pass)?;
        self.frames.place(hand, &leg, 0, 0.0);
        let (touches, closure) = self.touches(&leg)?;
        let clearance = self.clearance.closest(&leg, &self.frames, &touches);
        let distance = clearance.map_or(f64::INFINITY, |(distance, _)| distance);
        gauge("clearance", "m", Side::Above, self.of.tolerances.clearance, distance)?;
        let forces = self.forces(&leg)?;
        let margin = self.stability(&leg, &touches)?;
        Ok(GraspFigures { margin, clearance, closure, forces })
    }

    /// Where the fingers touch that hold the object, and the largest residual of closure.
    fn touches(&mut self, leg: &Leg<'_>) -> Result<(Touches, f64), Box<Check>> {
        let GraspVerifier { hand, scene, tolerances, .. } = self.of;
        let (mut touches, mut closure) = ([None; MAX_FINGERS], 0.0_f64);
        for (finger, claimed) in leg.states[0].record.contacts.iter().enumerate() {
            let Some(claimed) = claimed else { continue };
            let p_OTip = self.frames.p_OTip(finger);
            let touch = Touch::find(scene, &p_OTip, hand.tip_radius, 0);
            let off = deviation(hand, &self.frames, finger, claimed, &touch);
            let residual = touch.gap.abs().max(off.on_object).max(off.on_fingertip);
            gauge("closure", "m", Side::AtMost, tolerances.closure, residual)?;
            gauge("normals", "rad", Side::AtMost, tolerances.normal, off.normal)?;
            if scene.has_twin() {
                let gap = Touch::of_object(scene, &p_OTip, hand.tip_radius, 0).gap.abs();
                gauge("contact-surface", "m", Side::AtMost, scene.bound + tolerances.closure, gap)?;
            }
            closure = closure.max(residual);
            touches[finger] = Some(touch);
        }
        Ok((touches, closure))
    }

    fn forces(&self, leg: &Leg<'_>) -> Result<Option<(f64, f64)>, Box<Check>> {
        let alone = self.holds.as_ref().and_then(|holds| holds.alone(leg, 0, &self.of.hand, &self.frames));
        alone.transpose().map_err(|note| fault("forces", note))
    }

    /// The margin with which the grasp is proved to be what the plan claims.
    fn stability(&mut self, leg: &Leg<'_>, touches: &Touches) -> Result<Option<f64>, Box<Check>> {
        let recorded = leg.states[0].record.forces.as_deref().unwrap_or_default();
        let forces: Vec<Vec3> = recorded.iter().flatten().map(|&force| Vec3::from(force)).collect();
        let (hand, frames) = (&self.of.hand, &self.frames);
        let margin = match &mut self.holding {
            Some(None) => return Err(fault("stability", "the claimed criterion has no meaning")),
            Some(Some(holding)) => Some(
                holding.figure(leg, hand, frames, touches, &forces).unwrap_or_else(|slack| slack.min(0.0)),
            ),
            None if forces.is_empty() => self.stability.figure(leg, &frames.X_HO.rotation, touches),
            None => self.stability.figure_from(leg, &frames.X_HO.rotation, touches, &forces),
        };
        margin.map_or(Ok(()), |margin| gauge("stability", "force", Side::Above, 0.0, margin))?;
        Ok(margin)
    }
}

fn pass(check: Check) -> Result<(), Box<Check>> {
    if check.ok { Ok(()) } else { Err(Box::new(check)) }
}

/// Refuses a value on the wrong side of its limit.
fn gauge(
    name: &'static str,
    unit: &'static str,
    side: Side,
    limit: f64,
    value: f64,
) -> Result<(), Box<Check>> {
    let good = match side {
        Side::AtMost => value <= limit,
        Side::Above => value > limit,
    };
    if good {
        return Ok(());
    }
    let mut gauge = Gauge::new(name, unit, side, limit);
    gauge.note(value, Place::default);
    Err(Box::new(gauge.check()))
}

fn fault(name: &'static str, note: &str) -> Box<Check> {
    let mut gauge = Gauge::faults(name);
    gauge.fault(|| Place { note: Some(note.into()), ..Default::default() });
    Box::new(gauge.check())
}
