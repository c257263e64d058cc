//! Whether the plan starts where it must and reaches its goals in turn.

use crate::track::{Leg, State};
use crate::verdict::{COMPLETE, Check, Gauge, Side};
use regrasp_api::{FingerGrasp, Pose, PoseDescription, Tolerances, Vec3, angle_between};
use regrasp_plan::{Place, Plan};

/// How far a contact may lie from the one that a scenario gives (m): its numbers are rounded, and projected
/// to the surface.
const GIVEN_CONTACT: f64 = 1e-3;
/// The same for joints of a holding finger (rad; m), which follow from the contact: they choose among several
/// postures.
const GIVEN_JOINT: f64 = 0.05;
/// The same for joints of a free finger, which nothing else determines.
const GIVEN_FREE_JOINT: f64 = 1e-6;

/// The first state is the scenario's start.
pub(crate) fn start(plan: &Plan, legs: &[Leg<'_>], tolerances: &Tolerances) -> Check {
    let mut gauge = Gauge::new("start", "of the tolerance", Side::AtMost, 1.0);
    let start = &plan.scenario.problem.start;
    if let Some(leg) = legs.first() {
        compare(&mut gauge, &leg.states[0], (&start.pose, &start.grasp), tolerances, || leg.at(0));
    }
    gauge.check()
}

/// The goals that the plan claims are reached where it claims, and they are all goals.
pub(crate) fn goals(plan: &Plan, legs: &[Leg<'_>], tolerances: &Tolerances) -> [Check; 2] {
    let mut reached = Gauge::new("goals", "of the tolerance", Side::AtMost, 1.0);
    let goals = &plan.scenario.problem.goal;
    let mut before = 0;
    for (g, &done) in plan.goals_reached.iter().enumerate() {
        let place = |note: &str| {
            let note = (!note.is_empty()).then(|| note.into());
            Place { goal: Some(g), note, ..Default::default() }
        };
        let (Some(goal), true) = (goals.get(g), (before..=legs.len()).contains(&done)) else {
            reached.note(f64::INFINITY, || place("no such goal or segment, or not in turn"));
            continue;
        };
        before = done;
        // After no segment at all it is the first one's first state.
        let state = match done.checked_sub(1) {
            Some(last) => legs[last].states.last(),
            None => legs.first().and_then(|leg| leg.states.first()),
        };
        match state {
            Some(state) => {
                let place =
                    || Place { segment: done.checked_sub(1), time: Some(state.record.time), ..place("") };
                compare(&mut reached, state, (&goal.pose, &goal.grasp), tolerances, place);
            }
            None => {
                compare_poses(&mut reached, &plan.scenario.problem.start.pose, &goal.pose, tolerances, || {
                    place("")
                })
            }
        }
    }
    [reached.check(), complete(plan)]
}

/// All goals of the scenario are claimed.
fn complete(plan: &Plan) -> Check {
    let mut gauge = Gauge::new(COMPLETE, "goals missing", Side::AtMost, 0.0);
    let reached = plan.goals_reached.len();
    let missing = plan.scenario.problem.goal.len().saturating_sub(reached);
    gauge.note(missing as f64, || Place { goal: (missing > 0).then_some(reached), ..Default::default() });
    gauge.check()
}

/// A plan without segments: its start must be its goal.
fn compare_poses(
    gauge: &mut Gauge,
    start: &PoseDescription,
    goal: &PoseDescription,
    tolerances: &Tolerances,
    place: impl Fn() -> Place,
) {
    match start.pose() {
        Ok(X_HO) => compare_pose(gauge, &X_HO, goal, tolerances, place),
        Err(_) => gauge.note(f64::NAN, place),
    }
}

/// Notes pose, contacts and joints as fractions of what they may differ by.
fn compare(
    gauge: &mut Gauge,
    state: &State<'_>,
    (pose, grasp): (&PoseDescription, &Option<Vec<FingerGrasp>>),
    tolerances: &Tolerances,
    place: impl Fn() -> Place,
) {
    compare_pose(gauge, &state.X_HO, pose, tolerances, &place);
    let Some(grasp) = grasp else { return };
    if grasp.len() != state.record.contacts.len() {
        gauge.note(f64::INFINITY, || Place { note: Some("a grasp for another hand".into()), ..place() });
        return;
    }
    for (finger, wished) in grasp.iter().enumerate() {
        let place = |note: &str| Place { finger: Some(finger), note: Some(note.into()), ..place() };
        let contact = &state.record.contacts[finger];
        let distance = match (&wished.contact, contact) {
            (Some(wished), Some(is)) => (Vec3::from(*wished) - Vec3::from(is.point_O)).norm(),
            (None, None) => 0.0,
            _ => f64::INFINITY,
        };
        gauge.note(distance / GIVEN_CONTACT, || place("contact"));
        let Some(wished) = &wished.joints else { continue };
        let joints = &state.record.joints[finger];
        let differences = wished.iter().zip(joints).map(|(a, b)| (a - b).abs());
        let largest =
            if wished.len() == joints.len() { differences.fold(0.0, f64::max) } else { f64::INFINITY };
        let allowed = if contact.is_some() { GIVEN_JOINT } else { GIVEN_FREE_JOINT };
        gauge.note(largest / allowed, || place("joints"));
    }
}

fn compare_pose(
    gauge: &mut Gauge,
    X_HO: &Pose,
    wished: &PoseDescription,
    tolerances: &Tolerances,
    place: impl Fn() -> Place,
) {
    let Ok(wished) = wished.pose() else {
        gauge.note(f64::NAN, || Place { note: Some("a pose without meaning".into()), ..place() });
        return;
    };
    let distance = (X_HO.translation.vector - wished.translation.vector).norm();
    let angle = angle_between(&X_HO.rotation, &wished.rotation);
    let note = |what: &str| Place { note: Some(what.into()), ..place() };
    gauge.note(distance / tolerances.goal_position, || note("position"));
    gauge.note(angle / tolerances.goal_angle, || note("orientation"));
}
