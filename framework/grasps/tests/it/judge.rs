//! The verifier sees faults that are planted into grasps.

use crate::support;

use regrasp_api::{FingerIndex, Hand};
use regrasp_grasps::{BulkGrasp, GraspSource, Wish};
use regrasp_plan::{StateRecord, state_record};
use regrasp_run::Setup;
use regrasp_verify::{GraspJudge, GraspVerifier};
use support::{found, with};

/// A fault, and the checks that may find it.
type Fault = (fn(&mut StateRecord), &'static [&'static str]);

const FAULTS: [Fault; 10] = [
    (|q| q.object.position[0] += 1e-4, &["closure"]),
    (|q| q.object.position[2] += 0.5, &["closure"]),
    (|q| q.object.orientation[0] *= 1.01, &["quaternions"]),
    (|q| q.joints[0][1] += 0.01, &["closure", "joint-limits"]),
    (|q| q.joints[0][1] = 7.0, &["joint-limits"]),
    (|q| first(q).normal_O = [0.6, 0.0, 0.8], &["normals"]),
    (|q| first(q).point_O[1] += 1e-4, &["closure"]),
    (|q| first_force(q)[0] += 0.1, &["forces"]),
    (|q| q.forces.iter_mut().flatten().for_each(|f| *f = None), &["forces"]),
    (|q| q.joints.truncate(1), &["form"]),
];

fn first(q: &mut StateRecord) -> &mut regrasp_plan::ContactRecord {
    q.contacts.iter_mut().flatten().next().expect("some finger holds")
}

fn first_force(q: &mut StateRecord) -> &mut [f64; 3] {
    q.forces.iter_mut().flatten().flatten().next().expect("forces are recorded")
}

fn record(hand: &dyn Hand, grasp: &BulkGrasp) -> StateRecord {
    let forces =
        grasp.held.as_ref().map(|held| held.forces_O.iter().map(|(_, f)| f.map(Into::into)).collect());
    StateRecord { forces, ..state_record(&grasp.q, 0.0, hand) }
}

/// Hands grasps of a problem in which finger 0 holds, with forces, to `job`.
fn judged(name: &str, job: impl Fn(&mut GraspJudge<'_>, StateRecord)) {
    with(name, &Wish { count: 40, ..Wish::default() }, |setup: &Setup<'_>, source: &GraspSource<'_>| {
        let verifier = GraspVerifier::new(source.plan()).unwrap();
        let mut judge = verifier.judge();
        let grasps = found(source, 1).0;
        let holds = |grasp: &&BulkGrasp| grasp.held.is_some() && grasp.q.contacts[FingerIndex(0)].is_some();
        let good: Vec<&BulkGrasp> = grasps.iter().filter(holds).collect();
        assert!(good.len() > 5);
        good.into_iter().for_each(|grasp| job(&mut judge, record(setup.hand(), grasp)));
    });
}

#[test]
fn planted_faults_are_seen() {
    for name in ["sphere", "allegro-cube"] {
        judged(name, |judge, good| {
            judge.judge(&good).expect("it is a good grasp");
            for (number, (plant, checks)) in FAULTS.iter().enumerate() {
                let mut bad = good.clone();
                plant(&mut bad);
                let found = judge.judge(&bad).expect_err("a fault was planted");
                assert!(checks.contains(&found.name), "fault {number} of {name}: {found:?}");
            }
            judge.judge(&good).expect("what is bad leaves nothing behind");
        });
    }
}

#[test]
fn a_grasp_of_too_few_fingers_is_not_stable() {
    judged("sphere", |judge, good| {
        let mut bad = StateRecord { forces: None, ..good };
        let holding: Vec<usize> = (0..4).filter(|&f| bad.contacts[f].is_some()).collect();
        holding[2..].iter().for_each(|&f| bad.contacts[f] = None);
        let found = judge.judge(&bad).expect_err("two points hold nothing");
        // A fingertip that touches and does not hold is too near.
        assert!(["stability", "clearance"].contains(&found.name), "{found:?}");
    });
}

#[test]
fn forces_change_no_verdict() {
    judged("sphere", |judge, good| {
        let with = judge.judge(&good).unwrap();
        let without = judge.judge(&StateRecord { forces: None, ..good }).unwrap();
        assert!(with.margin.unwrap() > 0.0 && without.margin.unwrap() > 0.0);
        assert_eq!((with.clearance, with.closure), (without.clearance, without.closure));
    });
}
