//! One walk along the whole plan, which every check takes part in.

use crate::clearance::ClearanceCheck;
use crate::contact_checks::ContactChecks;
use crate::hand::Chains;
use crate::lift::LiftCheck;
use crate::scene::Scene;
use crate::stability::{ConesCheck, HoldingCheck, HoldsCheck, StabilityCheck};
use crate::touch::Touch;
use crate::track::{self, Frames, Leg, SAMPLES};
use crate::verdict::{Gauge, Verdict};
use crate::{claims, controller, ends, motion_checks, object, rates, surface};
use regrasp_api::{MAX_FINGERS, ObjectModel, Tolerances, Vec3};
use regrasp_plan::{Criterion, Place, Plan, PlanCertificate};

/// Verifies a plan. Whatever the plan holds, there is a verdict.
///
/// The checks, in this order:
///
/// | name | what must hold |
/// |---|---|
/// | `form` | hand, object and obstacles make sense and stand alone; each state fits the hand, every number is finite |
/// | `quaternions` | orientations have norm 1 |
/// | `times` | times increase |
/// | `velocities`, `accelerations` | each joint's rates stay within its limits at all times, from rest to rest: of the cubic through positions and velocities, or, without velocities, of straight lines whose changes count over the shorter step |
/// | `controller` | that cubic stays within half of the closure tolerance of the straight lines; only for plans with velocities |
/// | `joint-limits` | each joint stays within its limits |
/// | `driven-joints` | joints that others drive (`mimic`) are where their drivers have them; only for hands that have such joints |
/// | `continuity` | consecutive segments share their end states exactly |
/// | `rest` | in a regrasp the object and all fingers but one rest exactly |
/// | `contacts` | no finger starts or stops holding within a segment, but the one that a regrasp moves; resting contacts do not change |
/// | `closure` | holding fingertips touch the surface, where the plan says and on the fingertip where it says |
/// | `normals` | the plan's normals are those of the surface |
/// | `slip` | no contact slips in sum from its finger's touch-down to its lift, over however many segments; a regrasp that does not rise to the lift height counts as sliding; by the law of fixed points, none leaves its place on the object |
/// | `contact-jumps` | no contact point jumps in a transfer but in a dent, where the fingertip touches both sides at once |
/// | `contact-surface` | where contacts live on a twin of the mesh: a fingertip that touches it is no farther from the mesh, and enters it no deeper, than the bound that the plan states; at every sample of the motion, and all over the twin |
/// | `lift`, `touch-travel` | a moving fingertip rises until it is lifted, and does not slide while it touches |
/// | `clearance` | every pair that may not touch keeps its distance, also between the samples |
/// | `stability` | the fingers that hold prove force closure, or what else the plan claims: forces that hold the load, at every sample (where contacts have cones of their own, at every state); in a regrasp the others do, both ends included |
/// | `forces` | where the plan records forces: they belong to the fingers that hold, balance the object's weight, and keep to what the plan claims to hold by |
/// | `claims` | the contacts and the criterion claimed agree with the scenario |
/// | `start`, `goals`, `complete` | the plan starts at the start, reaches the goals that it claims, and these are all |
///
/// Cost: about 0.1 ms for a state of four fingers on one core.
pub fn verify(plan: &Plan) -> Verdict {
    let problem = &plan.scenario.problem;
    let (hand, object) = match prepare(plan) {
        Ok(parts) => parts,
        Err(note) => return refuse(note),
    };
    let legs = match track::legs(&plan.segments, &hand) {
        Ok(legs) => legs,
        Err(form) => return Verdict::new(vec![form.check()], None),
    };
    match Scene::new(problem, &object, &hand, &travel(&hand, &legs)) {
        Ok(scene) => Walk { plan, hand: &hand, object: &object, scene: &scene, legs: &legs }.verdict(),
        Err(note) => refuse(note),
    }
}

fn refuse(note: String) -> Verdict {
    let mut form = Gauge::faults("form");
    form.fault(|| Place { note: Some(note), ..Default::default() });
    Verdict::new(vec![form.check()], None)
}

pub(crate) fn prepare(plan: &Plan) -> Result<(Chains, ObjectModel), String> {
    let hand = Chains::new(&plan.scenario.problem.hand)?;
    object::check_limits(&plan.scenario.problem.limits)?;
    let mut object = object::object_of(plan)?;
    object.twin = surface::twin(plan, &object, hand.tip_radius)?;
    Ok((hand, object))
}

/// How far from zero each joint comes, by its limits or by the plan.
pub(crate) fn travel(hand: &Chains, legs: &[Leg<'_>]) -> Vec<f64> {
    let mut travel: Vec<f64> = hand.joints().map(|joint| joint.lower.abs().max(joint.upper.abs())).collect();
    for state in legs.iter().flat_map(|leg| &leg.states) {
        travel.iter_mut().zip(&state.joints).for_each(|(most, q)| *most = most.max(q.abs()));
    }
    travel
}

/// The object's weight in the hand's frame (N).
pub(crate) fn weight_H(plan: &Plan, object: &ObjectModel) -> Vec3 {
    Vec3::from(plan.scenario.problem.gravity) * object.mass
}

struct Walk<'w> {
    plan: &'w Plan,
    hand: &'w Chains,
    object: &'w ObjectModel,
    scene: &'w Scene,
    legs: &'w [Leg<'w>],
}

/// The checks that look at where everything is at each sample.
struct Sampled<'w> {
    contacts: ContactChecks<'w>,
    clearance: ClearanceCheck<'w>,
    lift: LiftCheck<'w>,
    stability: StabilityCheck,
    /// In its place where contacts have cones of their own.
    cones: Option<ConesCheck>,
    /// In its place where the plan claims that joints' efforts hold the object; `None` within where the claim
    /// has no meaning.
    holding: Option<Option<HoldingCheck>>,
    holds: Option<HoldsCheck>,
}

impl Walk<'_> {
    fn verdict(&self) -> Verdict {
        let limits = &self.plan.scenario.problem.limits;
        let (tolerances, resolution) = (&limits.tolerances, &limits.resolution);
        // The lowest height that the scenario lets a finger lift to.
        let lift = resolution.retreat.into_iter().fold(resolution.lift, f64::min);
        let mut sampled = Sampled {
            contacts: ContactChecks::new(self.hand, self.scene, tolerances, self.plan.claims.transfer_law),
            clearance: ClearanceCheck::new(self.hand, self.scene, tolerances.clearance),
            lift: LiftCheck::new(self.hand, self.scene, tolerances, lift),
            stability: StabilityCheck::new(&self.plan.claims, weight_H(self.plan, self.object)),
            cones: ConesCheck::new(&self.plan.claims, weight_H(self.plan, self.object)),
            holding: self.holding(),
            holds: self.holds(),
        };
        let mut frames = vec![Frames::new(self.hand); SAMPLES + 1];
        let mut touches = [[None; MAX_FINGERS]; SAMPLES + 1];
        for leg in self.legs {
            self.segment(leg, &mut sampled, &mut frames, &mut touches);
        }
        self.gather(sampled, tolerances)
    }

    fn holding(&self) -> Option<Option<HoldingCheck>> {
        let claims = &self.plan.claims;
        let Criterion::Holding(load) = &claims.criterion else { return None };
        // Without an elliptic cone nothing can be checked, and the check of closure says so.
        claims.contact.cone?;
        Some(HoldingCheck::new(claims, load, weight_H(self.plan, self.object)))
    }

    fn holds(&self) -> Option<HoldsCheck> {
        let mut states = self.plan.segments.iter().flat_map(|segment| &segment.states);
        let has_forces = states.any(|state| state.forces.is_some());
        HoldsCheck::new(&self.plan.claims, weight_H(self.plan, self.object), self.object.mass, has_forces)
    }

    /// The segment's first state.
    fn begin(
        &self,
        leg: &Leg<'_>,
        sampled: &mut Sampled<'_>,
        frames: &mut Frames,
        touches: &mut [Option<Touch>; MAX_FINGERS],
    ) {
        sampled.stability.start();
        sampled.holding.iter_mut().flatten().for_each(HoldingCheck::start);
        sampled.lift.start();
        frames.place(self.hand, leg, 0, 0.0);
        *touches = sampled.contacts.sample(leg, 0, 0, frames);
        sampled.stability.sample(leg, 0, 0, &frames.X_HO.rotation, touches);
        if let Some(cones) = &mut sampled.cones {
            cones.state(leg, 0, &frames.X_HO.rotation, touches);
        }
        if let Some(Some(holding)) = &mut sampled.holding {
            holding.sample((leg, 0, 0), self.hand, frames, touches);
        }
        if let Some(holds) = &mut sampled.holds {
            holds.state(leg, 0, self.hand, frames);
        }
        sampled.clearance.start(leg, frames);
        if let Some(finger) = leg.moving {
            sampled.lift.sample(finger, 0, 0, frames);
        }
    }

    fn segment(
        &self,
        leg: &Leg<'_>,
        sampled: &mut Sampled<'_>,
        frames: &mut [Frames],
        touches: &mut [[Option<Touch>; MAX_FINGERS]; SAMPLES + 1],
    ) {
        self.begin(leg, sampled, &mut frames[SAMPLES], &mut touches[SAMPLES]);
        for state in 0..leg.states.len() - 1 {
            frames.swap(0, SAMPLES);
            touches.swap(0, SAMPLES);
            for sample in 1..=SAMPLES {
                frames[sample].place(self.hand, leg, state, sample as f64 / SAMPLES as f64);
                // In a regrasp all that holds rests: its contacts are looked at where the plan states them.
                let stated = sample == SAMPLES;
                if leg.moving.is_none() || stated {
                    touches[sample] = sampled.contacts.sample(leg, state, sample, &frames[sample]);
                    let R_HO = &frames[sample].X_HO.rotation;
                    sampled.stability.sample(leg, state, sample, R_HO, &touches[sample]);
                    if let Some(cones) = sampled.cones.as_mut().filter(|_| stated) {
                        cones.state(leg, state + 1, R_HO, &touches[sample]);
                    }
                    if let Some(Some(holding)) = &mut sampled.holding {
                        holding.sample((leg, state, sample), self.hand, &frames[sample], &touches[sample]);
                    }
                } else {
                    touches[sample] = touches[0];
                }
                if let Some(finger) = leg.moving {
                    sampled.lift.sample(finger, state, sample, &frames[sample]);
                }
            }
            if let Some(holds) = &mut sampled.holds {
                holds.state(leg, state + 1, self.hand, &frames[SAMPLES]);
            }
            sampled.clearance.step(leg, state, frames, touches);
        }
        if let Some(finger) = leg.moving {
            let lifted = sampled.lift.finish(leg, finger, &mut sampled.clearance);
            sampled.contacts.moved(leg, finger, lifted, &frames[SAMPLES]);
        }
    }

    fn gather(&self, mut sampled: Sampled<'_>, tolerances: &Tolerances) -> Verdict {
        let (closure_residual, slip) = sampled.contacts.extremes();
        let certificate = PlanCertificate {
            closure_margin: match &sampled.cones {
                Some(cones) => cones.extreme(),
                None => sampled.stability.extreme(),
            },
            clearance: sampled.clearance.extreme(),
            slip,
            closure_residual,
            holds: sampled.holds.as_ref().and_then(HoldsCheck::holds),
        };
        let mut checks = vec![Gauge::faults("form").check()];
        checks.push(motion_checks::quaternions(self.legs));
        checks.push(motion_checks::times(self.legs));
        checks.extend(rates::rates(self.hand, self.legs));
        checks.extend(controller::controller(self.hand, self.scene, self.legs, tolerances.closure));
        checks.push(motion_checks::joint_limits(self.hand, self.legs));
        checks.extend(motion_checks::driven_joints(self.hand, self.legs));
        checks.push(motion_checks::continuity(self.legs));
        checks.push(motion_checks::rest(self.hand, self.legs));
        checks.push(motion_checks::contacts(self.hand, self.legs));
        checks.extend(sampled.contacts.checks());
        checks.extend(sampled.lift.checks());
        checks.push(sampled.clearance.check());
        checks.push(match sampled.holding {
            None => sampled.cones.map_or_else(|| sampled.stability.check(), ConesCheck::check),
            Some(None) => HoldingCheck::no_meaning(),
            Some(Some(holding)) => holding.check_made(),
        });
        checks.extend(sampled.holds.map(HoldsCheck::check));
        checks.push(claims::claims(self.plan, self.object));
        checks.push(ends::start(self.plan, self.legs, tolerances));
        checks.extend(ends::goals(self.plan, self.legs, tolerances));
        Verdict::new(checks, Some(certificate))
    }
}
