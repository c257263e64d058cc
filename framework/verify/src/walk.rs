//! The verdict on a plan: its motion looked at stretch by stretch, and all else.

use crate::clearance::ClearanceCheck;
use crate::hand::Chains;
use crate::order::in_order;
use crate::scene::Scene;
use crate::slip::SlipCheck;
use crate::stability::{ConesCheck, HoldingCheck, HoldsCheck};
use crate::stretch::{Look, Seen, Stretch, stretches};
use crate::track::{self, Frames, Leg};
use crate::verdict::{Gauge, Verdict};
use crate::{claims, ends, motion_checks, object, rates, surface};
use regrasp_api::ObjectModel;
use regrasp_plan::{Place, Plan, PlanCertificate};

/// Where there are fewer stretches for each thread, fewer threads look.
const FEWEST: usize = 2;

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
    verify_on(plan, 1)
}

/// [`verify`] on so many threads: the verdict is the same for any number of them.
pub fn verify_on(plan: &Plan, threads: usize) -> Verdict {
    let problem = &plan.scenario.problem;
    let (hand, object) = match prepare(plan) {
        Ok(parts) => parts,
        Err(note) => return refuse(note),
    };
    let legs = match track::legs(&plan.segments, &hand) {
        Ok(legs) => legs,
        Err(form) => return Verdict::new(vec![form.check()], None),
    };
    let scene = match Scene::new(problem, &object, &hand, &travel(&hand, &legs)) {
        Ok(scene) => scene,
        Err(note) => return refuse(note),
    };
    let has_forces = legs.iter().flat_map(|leg| &leg.states).any(|state| state.record.forces.is_some());
    let (hand, object, scene, legs) = (&hand, &object, &scene, &legs[..]);
    let mut look = Look { plan, hand, object, scene, legs, has_forces, smallest: f64::INFINITY };
    let stretches = stretches(legs);
    look.smallest = smallest(&look, &stretches) + ROUNDING;
    let mut seen = look.nothing();
    let mut slip = SlipCheck::new(hand, &problem.limits.tolerances, plan.claims.transfer_law);
    seen.contacts.look_all_over(threads);
    let threads = threads.min(stretches.len() / FEWEST);
    in_order(
        stretches.len(),
        threads,
        |k| look.at(stretches[k]),
        |k, next| {
            let leg = &legs[stretches[k].leg];
            seen.join(next).iter().for_each(|event| slip.take(leg, event));
        },
    );
    gather(&look, seen, slip)
}

/// What is added to the smallest distance (m): its pair must be met again, however the bounds of balls are
/// rounded.
const ROUNDING: f64 = 1e-9;

/// The smallest distance at the first states of stretches (m).
fn smallest(look: &Look<'_>, stretches: &[Stretch]) -> f64 {
    let Look { plan, hand, scene, legs, .. } = *look;
    let demanded = plan.scenario.problem.limits.tolerances.clearance;
    let mut clearance = ClearanceCheck::new(hand, scene, demanded, f64::INFINITY);
    let mut frames = Frames::new(hand);
    let glance = |stretch: &Stretch| {
        let leg = &legs[stretch.leg];
        frames.place(hand, leg, stretch.from, 0.0);
        clearance.glance(leg, &frames)
    };
    stretches.iter().map(glance).last().unwrap_or(f64::INFINITY)
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

fn gather(look: &Look<'_>, mut seen: Seen<'_>, slip: SlipCheck) -> Verdict {
    let Look { plan, hand, object, legs, .. } = *look;
    let tolerances = &plan.scenario.problem.limits.tolerances;
    let certificate = PlanCertificate {
        closure_margin: match &seen.cones {
            Some(cones) => cones.extreme(),
            None => seen.stability.extreme(),
        },
        clearance: seen.clearance.extreme(),
        slip: slip.extreme(),
        closure_residual: seen.contacts.extreme(),
        holds: seen.holds.as_ref().and_then(HoldsCheck::holds),
    };
    let mut checks = vec![Gauge::faults("form").check()];
    checks.push(motion_checks::quaternions(legs));
    checks.push(motion_checks::times(legs));
    checks.extend(rates::rates(hand, legs));
    checks.extend(seen.controller.check());
    checks.push(motion_checks::joint_limits(hand, legs));
    checks.extend(motion_checks::driven_joints(hand, legs));
    checks.push(motion_checks::continuity(legs));
    checks.push(motion_checks::rest(hand, legs));
    checks.push(motion_checks::contacts(hand, legs));
    checks.extend(seen.contacts.checks(slip));
    checks.extend(seen.lift.checks());
    checks.push(seen.clearance.check());
    checks.push(match seen.holding {
        None => seen.cones.map_or_else(|| seen.stability.check(), ConesCheck::check),
        Some(None) => HoldingCheck::no_meaning(),
        Some(Some(holding)) => holding.check_made(),
    });
    checks.extend(seen.holds.map(HoldsCheck::check));
    checks.push(claims::claims(plan, object));
    checks.push(ends::start(plan, legs, tolerances));
    checks.extend(ends::goals(plan, legs, tolerances));
    Verdict::new(checks, Some(certificate))
}
