//! What can be seen from the plan's numbers alone: times, limits, continuity, rest, contact sets.

use crate::hand::Chains;
use crate::track::Leg;
use crate::verdict::{Check, Gauge, Side};
use regrasp_plan::{ContactRecord, Place, StateRecord};

/// What rounding may add to a fraction of a limit.
const ROUNDING: f64 = 1e-9;

/// Orientations are unit quaternions.
pub(crate) fn quaternions(legs: &[Leg<'_>]) -> Check {
    let mut gauge = Gauge::new("quaternions", "", Side::AtMost, 1e-9);
    for leg in legs {
        for (k, state) in leg.states.iter().enumerate() {
            let norm = state.record.object.orientation.iter().map(|x| x * x).sum::<f64>().sqrt();
            gauge.note((norm - 1.0).abs(), || leg.at(k));
        }
    }
    gauge.check()
}

/// Times increase within each segment.
pub(crate) fn times(legs: &[Leg<'_>]) -> Check {
    let mut gauge = Gauge::new("times", "s", Side::Above, 0.0);
    for leg in legs {
        for (k, pair) in leg.states.windows(2).enumerate() {
            gauge.note(pair[1].record.time - pair[0].record.time, || leg.at(k));
        }
    }
    gauge.check()
}

/// Every joint stays within its limits; between states it does because it moves linearly.
pub(crate) fn joint_limits(hand: &Chains, legs: &[Leg<'_>]) -> Check {
    let mut gauge = Gauge::new("joint-limits", "rad", Side::AtMost, ROUNDING);
    for leg in legs {
        for (k, state) in leg.states.iter().enumerate() {
            for (j, (&q, joint)) in state.joints.iter().zip(hand.joints()).enumerate() {
                let excess = (q - joint.upper).max(joint.lower - q);
                gauge.note(excess, || joint_place(hand, leg, k, j));
            }
        }
    }
    gauge.check()
}

/// Driven joints are where their drivers have them; between states they are because all move linearly. `None`
/// for a hand without such joints.
pub(crate) fn driven_joints(hand: &Chains, legs: &[Leg<'_>]) -> Option<Check> {
    hand.fingers.iter().any(|chain| !chain.driven.is_empty()).then(|| {
        let mut gauge = Gauge::new("driven-joints", "rad", Side::AtMost, ROUNDING);
        for leg in legs {
            for (k, state) in leg.states.iter().enumerate() {
                for (chain, driven) in hand.fingers.iter().flat_map(|c| c.driven.iter().map(move |d| (c, d)))
                {
                    let q = &state.joints[chain.first..];
                    let wanted = driven.multiplier * q[driven.driver] + driven.offset;
                    let place = || joint_place(hand, leg, k, chain.first + driven.joint);
                    gauge.note((q[driven.joint] - wanted).abs(), place);
                }
            }
        }
        gauge.check()
    })
}

pub(crate) fn joint_place(hand: &Chains, leg: &Leg<'_>, state: usize, joint: usize) -> Place {
    let (finger, joint) = hand.owner(joint);
    Place { finger: Some(finger), joint: Some(joint), ..leg.at(state) }
}

/// Consecutive segments share their end states exactly.
pub(crate) fn continuity(legs: &[Leg<'_>]) -> Check {
    let mut gauge = Gauge::new("continuity", "largest difference", Side::AtMost, 0.0);
    for pair in legs.windows(2) {
        if let (Some(end), Some(start)) = (pair[0].states.last(), pair[1].states.first()) {
            gauge.note(difference(end.record, start.record), || pair[1].at(0));
        }
    }
    gauge.check()
}

/// The largest difference of any number of two states; infinite where one has a contact that the other lacks.
fn difference(a: &StateRecord, b: &StateRecord) -> f64 {
    let numbers = |s: &StateRecord| {
        let pose = s.object.position.into_iter().chain(s.object.orientation);
        let velocities = s.velocities.iter().flatten().flatten().copied();
        pose.chain([s.time]).chain(s.joints.concat()).chain(velocities).collect::<Vec<_>>()
    };
    if a.velocities.is_some() != b.velocities.is_some() || a.cones != b.cones {
        return f64::INFINITY;
    }
    let contacts = a.contacts.iter().zip(&b.contacts).map(|(a, b)| contact_difference(a, b));
    largest(&numbers(a), &numbers(b)).max(contacts.fold(0.0, f64::max))
}

fn contact_difference(a: &Option<ContactRecord>, b: &Option<ContactRecord>) -> f64 {
    match (a, b) {
        (None, None) => 0.0,
        (Some(a), Some(b)) => {
            let point = largest(&a.point_O, &b.point_O).max(largest(&a.normal_O, &b.normal_O));
            point.max(largest(&a.point_F, &b.point_F))
        }
        _ => f64::INFINITY,
    }
}

fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// In a regrasp the object and all fingers but one rest, exactly.
pub(crate) fn rest(hand: &Chains, legs: &[Leg<'_>]) -> Check {
    let mut gauge = Gauge::new("rest", "largest difference", Side::AtMost, 0.0);
    for leg in legs {
        let Some(moving) = leg.moving else { continue };
        for (k, pair) in leg.states.windows(2).enumerate() {
            let [a, b] = [&pair[0].record.object, &pair[1].record.object];
            let turned = largest(&a.orientation, &b.orientation);
            gauge.note(largest(&a.position, &b.position).max(turned), || leg.at(k));
            for finger in (0..hand.fingers.len()).filter(|&finger| finger != moving) {
                let (a, b) = (&pair[0].record.joints[finger], &pair[1].record.joints[finger]);
                gauge.note(largest(a, b), || Place { finger: Some(finger), ..leg.at(k) });
            }
        }
    }
    gauge.check()
}

/// The same fingers hold all through a segment, resting ones at the same contact; the moving one at the
/// segment's ends at most.
pub(crate) fn contacts(hand: &Chains, legs: &[Leg<'_>]) -> Check {
    let mut gauge = Gauge::faults("contacts");
    for leg in legs {
        for finger in 0..hand.fingers.len() {
            let place =
                |k: usize, note: &str| Place { finger: Some(finger), note: Some(note.into()), ..leg.at(k) };
            let contact = |k: usize| &leg.states[k].record.contacts[finger];
            for k in 1..leg.states.len() {
                let last = k + 1 == leg.states.len();
                if leg.moving == Some(finger) {
                    if !last && contact(k).is_some() {
                        gauge.fault(|| {
                            place(k, "the moving finger holds the object in the middle of a regrasp")
                        });
                    }
                } else if contact(k).is_some() != contact(0).is_some() {
                    gauge.fault(|| place(k, "a finger starts or stops holding within a segment"));
                } else if leg.moving.is_some() && contact_difference(contact(k), contact(0)) > 0.0 {
                    gauge.fault(|| place(k, "the contact of a resting finger changes"));
                }
            }
        }
    }
    gauge.check()
}
