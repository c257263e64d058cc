//! Paths in GS_n: every state is a closed, stable configuration of the same fingers.
use crate::support;

use regrasp_api::*;
use regrasp_local_planners::{Linear, LinearSettings};
use support::{context, geometry};

fn join(
    bench: &support::Bench,
    from: &Configuration,
    to: &Configuration,
    path: Option<&mut Path>,
) -> Reached {
    let linear = Linear::new(LinearSettings::default()).unwrap();
    linear.connect(&bench.task(), from, &Target::Grasp(to), path, &mut context(1)).unwrap()
}

/// The distance (m) of a tip from where its contact wants it.
fn opening(bench: &support::Bench, q: &Configuration, finger: FingerIndex) -> f64 {
    let p_OF = q.contacts[finger].unwrap().tip_center(bench.radius());
    (bench.hand.tip_center(finger, &q.joints[finger]) - geometry::to_hand(&q.X_HO, &p_OF)).norm()
}

fn assert_slides(bench: &support::Bench, from: &Configuration, to: &Configuration, path: &Path) {
    let task = bench.task();
    assert_eq!((&path.states[0], path.states.last().unwrap()), (from, to));
    for q in &path.states {
        assert_eq!(q.holding(), from.holding());
        for finger in q.holding().iter() {
            assert!(opening(bench, q, finger) < 1e-8);
            assert!(bench.hand.within_limits(finger, &q.joints[finger]));
            let contact = q.contacts[finger].unwrap();
            let true_point = geometry::closest(&bench.object.mesh, &contact.p_OC);
            assert!((true_point - contact.p_OC).norm() < 1e-9);
        }
        let grasp = task.grasp(q, q.holding());
        let verdict = bench.stability.test(&grasp, &mut Hint::default(), &mut context(0)).unwrap();
        assert!(verdict.is_stable());
        assert!(bench.clearance.configuration_free(q, q.holding(), true).is_ok());
    }
    for pair in path.states.windows(2) {
        let distance = (pair[1].X_HO.translation.vector - pair[0].X_HO.translation.vector).norm();
        let angle = angle_between(&pair[0].X_HO.rotation, &pair[1].X_HO.rotation);
        assert!(distance < 1.5e-3 + 1e-9 && angle < 2f64.to_radians() + 1e-9);
        for finger in from.holding().iter() {
            let [a, b] = [&pair[0], &pair[1]].map(|q| q.contacts[finger].unwrap().tip_center(bench.radius()));
            assert!((b - a).norm() < 1.5e-3 + 1e-9);
        }
    }
}

#[test]
fn random_paths_are_closed_and_stable_at_every_state() {
    for (name, object) in support::objects() {
        for hand in [support::four_finger(), support::free_tips(), support::redundant()] {
            let bench = support::Bench::new(hand, object.clone());
            let (mut random, mut refused) = (Random::from_key(5, 7, 2, 1), Vec::new());
            for _ in 0..30 {
                let from = support::grasp(&bench, &mut random);
                let to = (0..200).find_map(|_| {
                    let X_HO = support::nearby(&from.X_HO, &mut random, 0.01, 0.5);
                    support::grasp_at(&bench.task(), X_HO, &mut random)
                });
                let Some(to) = to else { continue };
                let mut path = Path::default();
                let reached = join(&bench, &from, &to, Some(&mut path));
                assert_eq!(join(&bench, &from, &to, None), reached);
                match reached.stop {
                    Some(reason) => {
                        assert_eq!((reached.end, path.states.len()), (from, 1));
                        refused.push(reason);
                    }
                    None => assert_slides(&bench, &from, &to, &path),
                }
            }
            assert!(refused.len() < 30, "{name} {}: {refused:?}", bench.hand.description().name);
        }
    }
}

#[test]
fn what_cannot_be_is_refused_with_its_reason() {
    let bench = support::Bench::new(support::four_finger(), support::sphere());
    let from = support::grasp(&bench, &mut Random::from_key(1, 2, 3, 4));
    let mut other = from.clone();
    other.contacts[FingerIndex(2)] = None;
    assert_eq!(join(&bench, &from, &other, None).stop, Some(Reason::Closure));
    let linear = Linear::new(LinearSettings::default()).unwrap();
    let answer = linear.connect(&bench.task(), &from, &Target::Transfer(&from.X_HO), None, &mut context(1));
    assert!(matches!(answer, Err(CallError::Unsupported { .. })), "{answer:?}");
    let message = Linear::new(LinearSettings { joint_jump: 0.0 }).unwrap_err().to_string();
    assert!(message.contains("`joint_jump` = 0"), "{message}");
}

#[test]
fn free_fingers_move_straight() {
    let bench = support::Bench::new(support::four_finger(), support::sphere());
    let mut random = Random::from_key(6, 2, 3, 4);
    let moving = FingerIndex(3);
    let (from, to, path) = (0..200)
        .find_map(|_| {
            let mut from = support::grasp(&bench, &mut random);
            (from.contacts[moving], from.joints[moving]) = (None, bench.hand.finger(moving).rest);
            let mut to = from.clone();
            to.X_HO.translation.vector.z += 0.004;
            for finger in from.holding().iter() {
                let p_OF = from.contacts[finger].unwrap().tip_center(bench.radius());
                to.joints[finger] =
                    bench.hand.inverse(finger, &geometry::to_hand(&to.X_HO, &p_OF), &from.joints[finger])?;
            }
            to.joints[moving][0] += 0.1;
            let mut path = Path::default();
            join(&bench, &from, &to, Some(&mut path)).is_complete().then_some((from, to, path))
        })
        .unwrap();
    assert_slides(&bench, &from, &to, &path);
    let last = (path.states.len() - 1) as f64;
    for (i, q) in path.states.iter().enumerate() {
        let straight = from.joints[moving].interpolate(&to.joints[moving], i as f64 / last);
        assert!(q.joints[moving].max_difference(&straight) < 1e-12);
    }
}

#[test]
fn the_plugins_are_registered_for_their_slots() {
    let slot = |id: &str| {
        let entry = regrasp_api::inventory::iter::<Entry>().find(|entry| entry.id == id).unwrap();
        assert!((entry.check)("").is_ok() && (entry.check)("{\"no-such-key\": 1}").is_err());
        assert_eq!(entry.role(), Role::LocalPlanner);
        entry.slots.to_vec()
    };
    assert_eq!(slot("local-planner/linear"), [Slot::GraspPlanner]);
    assert_eq!(slot("local-planner/rolling"), [Slot::TransferPlanner]);
    assert_eq!(slot("local-planner/rrt"), [Slot::RegraspPlanner]);
}
