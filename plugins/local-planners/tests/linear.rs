//! Paths in GS_n: every state is a closed, stable configuration of the same fingers.
#![allow(missing_docs)]

mod support;

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
    for (name, object) in [
        ("sphere", support::sphere()),
        ("cube", support::cube()),
        ("ellipsoid", support::ellipsoid()),
        ("ring", support::ring()),
    ] {
        for hand in [support::four_finger(), support::free_tips()] {
            let bench = support::Bench::new(hand, object.clone());
            let (mut random, mut refused) = (Random::from_key(5, 7, 2, 1), Vec::new());
            for _ in 0..12 {
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
            println!("{name} {}: {refused:?}", bench.hand.description().name);
            assert!(refused.len() < 12, "{refused:?}");
        }
    }
}
