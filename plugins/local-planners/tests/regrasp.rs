//! Regrasps: the moving fingertip leaves and meets the object at its ends only.
#![allow(missing_docs)]

mod support;

use regrasp_api::*;
use regrasp_local_planners::{Rrt, RrtSettings};
use support::{check, context, geometry};

const FINGER: FingerIndex = FingerIndex(1);

fn regrasp(
    bench: &support::Bench,
    from: &Configuration,
    contact: Option<&Contact>,
    joints: &FingerJoints,
    path: Option<&mut Path>,
) -> Reached {
    let rrt = Rrt::new(RrtSettings::default(), &*bench.hand).unwrap();
    let target = Target::Regrasp { finger: FINGER, contact, joints };
    rrt.connect(&bench.task(), from, &target, path, &mut context(1)).unwrap()
}

/// Ends, rest of the other fingers, steps, and the fingertip's distance from the object.
fn assert_flies(bench: &support::Bench, from: &Configuration, path: &Path, end: &Configuration) {
    assert_eq!((&path.states[0], path.states.last().unwrap()), (from, end));
    for q in &path.states[1..path.states.len() - 1] {
        assert_eq!(q.contacts[FINGER], None);
        assert!(bench.hand.within_limits(FINGER, &q.joints[FINGER]));
    }
    for (a, b) in path.states.iter().zip(&path.states[1..]) {
        let tips = [a, b].map(|q| bench.hand.tip_center(FINGER, &q.joints[FINGER]));
        assert!((tips[1] - tips[0]).norm() < 1.5e-3 * 1.01, "{}", (tips[1] - tips[0]).norm());
        for other in [0, 2, 3].map(FingerIndex) {
            assert_eq!((a.joints[other], a.contacts[other]), (b.joints[other], b.contacts[other]));
        }
        assert_eq!(a.X_HO, b.X_HO);
    }
    let gaps = check::gaps(bench, path, FINGER);
    if from.contacts[FINGER].is_some() {
        assert_rises(&gaps);
    }
    if end.contacts[FINGER].is_some() {
        assert_rises(&gaps.iter().rev().copied().collect::<Vec<_>>());
    }
}

/// From touch upwards: rising until 2 mm, never below half a millimetre between the two descents.
fn assert_rises(gaps: &[f64]) {
    assert!(gaps[0].abs() < 1e-6);
    let up = gaps.iter().position(|&gap| gap > 2e-3).unwrap();
    assert!(gaps[..=up].windows(2).all(|pair| pair[1] > pair[0]), "{:?}", &gaps[..=up]);
    let down = gaps.len() - gaps.iter().rev().position(|&gap| gap > 2e-3).unwrap();
    let lowest = gaps[up..down].iter().copied().fold(f64::INFINITY, f64::min);
    assert!(lowest > 5e-4, "{lowest}");
}

/// Another place on the object that the finger reaches.
fn elsewhere(
    bench: &support::Bench,
    q: &Configuration,
    random: &mut Random,
) -> Option<(Contact, FingerJoints)> {
    (0..200).find_map(|_| {
        let contact = bench.surface.sample(random);
        let p_OF = contact.tip_center(bench.radius());
        let touches = (bench.surface.project(&p_OF, None).distance - bench.radius()).abs() < 1e-9;
        let p_HF = geometry::to_hand(&q.X_HO, &p_OF);
        let joints = bench.hand.inverse(FINGER, &p_HF, &q.joints[FINGER])?;
        touches.then_some((contact, joints))
    })
}

#[test]
fn random_regrasps_touch_at_their_ends_only() {
    for (name, object) in [
        ("sphere", support::sphere()),
        ("cube", support::cube()),
        ("ellipsoid", support::ellipsoid()),
        ("ring", support::ring()),
    ] {
        for hand in [support::four_finger(), support::free_tips()] {
            let bench = support::Bench::new(hand, object.clone());
            let (mut random, mut complete, mut refused) = (Random::from_key(2, 7, 1, 8), 0, Vec::new());
            for _ in 0..12 {
                let from = support::grasp(&bench, &mut random);
                let Some((contact, joints)) = elsewhere(&bench, &from, &mut random) else { continue };
                let mut path = Path::default();
                let reached = regrasp(&bench, &from, Some(&contact), &joints, Some(&mut path));
                assert_eq!(regrasp(&bench, &from, Some(&contact), &joints, None), reached);
                if let Some(reason) = reached.stop {
                    assert_eq!((&reached.end, reached.fraction, path.states.len()), (&from, 0.0, 1));
                    refused.push(reason);
                    continue;
                }
                complete += 1;
                assert_eq!(
                    (reached.end.contacts[FINGER], reached.end.joints[FINGER]),
                    (Some(contact), joints)
                );
                assert_flies(&bench, &from, &path, &reached.end);
            }
            println!("{name} {}: {complete} {refused:?}", bench.hand.description().name);
        }
    }
}
