//! Plans made to deceive: each spends a tolerance many times over, and each must be refused by the check that
//! is meant.

use crate::common;

use common::*;
use regrasp_api::*;
use regrasp_plan::*;
use regrasp_verify::{Verdict, verify};
use regrasp_world::ChainHand;

/// The plan made by hand with a motion changed by `make`, and timed anew.
fn attack(make: impl FnOnce(&ChainHand, &mut Motion)) -> Verdict {
    let mut plan = plan(8);
    let hand = ChainHand::new(plan.scenario.problem.hand.clone()).unwrap();
    let mut motion = motion(&plan).unwrap();
    make(&hand, &mut motion);
    assign_times(&mut motion, &hand, &TimingLimits::default()).unwrap();
    plan.segments = records(&motion, &hand).unwrap();
    plan.goals_reached = vec![];
    plan.scenario.problem.goal.clear();
    verify(&plan)
}

fn refused_by(verdict: &Verdict) -> Vec<&'static str> {
    verdict.failures().map(|check| check.name).collect()
}

/// Drags the fingertip of `NORTH` along x over the last segment, by `distance` (m) in all.
fn drag(hand: &ChainHand, motion: &mut Motion, distance: f64) {
    let states = &mut motion.segments[2].states;
    let last = states.len() - 1;
    for (k, q) in states.iter_mut().enumerate() {
        let mut contact = q.contacts[NORTH].unwrap();
        contact.p_OC.x += distance * k as f64 / last as f64;
        q.contacts[NORTH] = Some(contact);
        q.joints[NORTH] = reach(hand, q, NORTH, &contact, 0.0);
    }
}

#[test]
fn slip_in_pieces_is_summed_over_the_segments() {
    let verdict = attack(|hand, motion| {
        drag(hand, motion, 4e-4);
        let states = motion.segments.pop().unwrap().states;
        for pair in states.windows(2) {
            motion.segments.push(Segment::new(SegmentKind::Transfer, pair.to_vec()));
        }
    });
    assert_eq!(refused_by(&verdict), ["slip"]);
    assert!(verdict.check("slip").unwrap().worst.unwrap() > 1.5e-4, "no segment slips by half of that");
}

#[test]
fn slip_goes_on_while_other_fingers_regrasp() {
    let verdict = attack(|hand, motion| {
        drag(hand, motion, 4e-4);
        let mut states = motion.segments.pop().unwrap().states;
        let rest = states.split_off(4);
        let between = regrasp(hand, &states[3], FingerIndex(3), Vec3::zeros());
        motion.segments.push(Segment::new(SegmentKind::Transfer, states));
        // The other finger comes back to where it was.
        let mut first = between.states.last().unwrap().clone();
        motion.segments.push(between);
        for q in rest {
            motion.segments.push(Segment::new(SegmentKind::Transfer, vec![first, q.clone()]));
            first = q;
        }
    });
    assert_eq!(refused_by(&verdict), ["slip"]);
}

/// Ten "regrasps" of `NORTH` by 80 µm each, along its face, at this height (m).
fn hops(hand: &ChainHand, motion: &mut Motion, height: f64, free_between: bool) {
    motion.segments.truncate(1);
    let mut q = motion.segments[0].states.last().unwrap().clone();
    for _ in 0..10 {
        let (from, mut moving) = (q.contacts[NORTH].unwrap(), q.clone());
        let to = Contact { p_OC: from.p_OC + Vec3::z() * -8e-5, ..from };
        moving.contacts[NORTH] = None;
        let mut at = |contact: &Contact, height: f64| {
            moving.joints[NORTH] = reach(hand, &moving, NORTH, contact, height);
            moving.clone()
        };
        let states = vec![q.clone(), at(&from, height), at(&to, height)];
        let mut landed = at(&to, 0.0);
        landed.contacts[NORTH] = Some(to);
        let kind = SegmentKind::Regrasp(NORTH);
        if free_between {
            let up = states.last().unwrap().clone();
            motion.segments.push(Segment::new(kind, states));
            motion.segments.push(Segment::new(kind, vec![up, landed.clone()]));
        } else {
            motion.segments.push(Segment::new(kind, [states, vec![landed.clone()]].concat()));
        }
        q = landed;
    }
}

#[test]
fn a_fingertip_that_never_lifts_slides() {
    for free_between in [false, true] {
        let verdict = attack(|hand, motion| hops(hand, motion, 8e-6, free_between));
        assert_eq!(refused_by(&verdict), ["slip"], "{free_between}");
        let slip = verdict.check("slip").unwrap().worst.unwrap();
        assert!((7e-4..9e-4).contains(&slip), "{slip}");
    }
    let lifted = attack(|hand, motion| hops(hand, motion, 8e-3, false));
    assert!(lifted.valid, "{:?}", refused_by(&lifted));
}

#[test]
fn a_fingertip_that_sinks_in_tiny_steps_does_not_rise() {
    let verdict = attack(|hand, motion| {
        let states = &mut motion.segments[1].states;
        let contact = states[0].contacts[NORTH].unwrap();
        let mut q = states[1].clone();
        for k in 1..=15 {
            // A micrometre or less from sample to sample, 0.14 mm in all.
            q.joints[NORTH] = reach(hand, &q, NORTH, &contact, 1e-3 - 9e-6 * f64::from(k));
            states.insert(1 + k as usize, q.clone());
        }
    });
    assert_eq!(refused_by(&verdict), ["lift"]);
}

/// The plan with its states' times and velocities changed.
fn timed(change: impl FnOnce(&mut Plan)) -> Vec<&'static str> {
    let mut plan = plan(8);
    change(&mut plan);
    refused_by(&verify(&plan))
}

/// Where the fastest joint is at its fastest: segment and state.
fn fastest(plan: &Plan) -> (usize, usize) {
    let speed = |state: &StateRecord| {
        state.velocities.iter().flatten().flatten().fold(0.0_f64, |m, v| m.max(v.abs()))
    };
    let states = plan.segments.iter().enumerate();
    let all =
        states.flat_map(|(s, segment)| segment.states.iter().enumerate().map(move |(k, q)| (s, k, speed(q))));
    let (s, k, _) = all.max_by(|a, b| a.2.total_cmp(&b.2)).unwrap();
    (s, k)
}

/// All states after the fastest one come `gap` seconds later.
fn pause(plan: &mut Plan, gap: f64) {
    let (segment, state) = fastest(plan);
    for (s, record) in plan.segments.iter_mut().enumerate() {
        for (k, q) in record.states.iter_mut().enumerate() {
            if (s, k) > (segment, state) {
                q.time += gap;
            }
        }
    }
}

#[test]
fn a_stop_from_full_speed_is_seen_with_and_without_velocities() {
    let with = timed(|plan| pause(plan, 1.0));
    assert!(with.contains(&"controller"), "{with:?}");
    let without = timed(|plan| {
        pause(plan, 1.0);
        plan.segments.iter_mut().flat_map(|s| &mut s.states).for_each(|q| q.velocities = None);
    });
    assert_eq!(without, ["accelerations"]);
}

#[test]
fn velocities_that_are_not_the_motion_s_are_seen() {
    let (s, k) = fastest(&plan(8));
    let wobble = |plan: &mut Plan, by: f64| {
        plan.segments[s].states[k].velocities.as_mut().unwrap()[0][1] += by;
    };
    let failed = timed(|plan| wobble(plan, 0.5));
    assert!(failed.contains(&"accelerations") || failed.contains(&"controller"), "{failed:?}");
    let running_start = timed(|plan| plan.segments[0].states[0].velocities.as_mut().unwrap()[0][0] = 1e-3);
    assert!(running_start.contains(&"accelerations"), "{running_start:?}");
    let torn = timed(|plan| {
        let end = plan.segments[0].states.len() - 1;
        plan.segments[0].states[end].velocities.as_mut().unwrap()[0][0] += 1e-6;
    });
    assert!(torn.contains(&"continuity"), "{torn:?}");
    let some = timed(|plan| plan.segments[0].states[1].velocities = None);
    assert_eq!(some, ["form"]);
}
