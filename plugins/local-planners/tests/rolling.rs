//! Transfers: closed forms, and the path's meaning checked at ten times its resolution.
#![allow(missing_docs)]

mod support;

use regrasp_api::*;
use regrasp_local_planners::{Rolling, RollingSettings};
use support::{check, context};

fn roll(bench: &support::Bench, from: &Configuration, to: &Pose, path: Option<&mut Path>) -> Reached {
    let rolling = Rolling::new(RollingSettings::default(), &*bench.hand).unwrap();
    rolling.connect(&bench.task(), from, &Target::Transfer(to), path, &mut context(1)).unwrap()
}

/// A path's ends, steps, closure, normals and slip.
fn assert_means_rolling(
    bench: &support::Bench,
    from: &Configuration,
    to: &Pose,
) -> (Reached, check::Transfer) {
    let mut path = Path::default();
    let reached = roll(bench, from, to, Some(&mut path));
    assert_eq!(path.states[0], *from);
    assert_eq!(path.states.last(), Some(&reached.end));
    assert_eq!(reached.fraction == 1.0, reached.is_complete());
    if reached.is_complete() {
        assert_eq!(reached.end.X_HO, *to);
    }
    assert_eq!(roll(bench, from, to, None), reached, "storing must not change the motion");
    let worst = check::transfer(bench, &path);
    assert!(worst.closure <= 10e-6 * 1.05, "{worst:?}");
    assert!(worst.slip <= 50e-6 * 1.05, "{worst:?}");
    assert!(worst.normal < 1e-6, "{worst:?}");
    assert!(worst.step < 1.3e-3, "{worst:?}");
    (reached, worst)
}

#[test]
fn random_transfers_keep_half_of_every_tolerance() {
    for (name, object) in [
        ("sphere", support::sphere()),
        ("cube", support::cube()),
        ("ellipsoid", support::ellipsoid()),
        ("ring", support::ring()),
    ] {
        for hand in [support::four_finger(), support::free_tips()] {
            let free = hand.name == "free";
            let bench = support::Bench::new(hand, object.clone());
            let (mut random, mut complete, mut steps) = (Random::from_key(3, 1, 4, 1), 0, [0.0_f64; 3]);
            let mut stops = Vec::new();
            for _ in 0..12 {
                let from = support::grasp(&bench, &mut random);
                let to = support::nearby(&from.X_HO, &mut random, 0.005, 0.6);
                let (reached, worst) = assert_means_rolling(&bench, &from, &to);
                complete += usize::from(reached.is_complete());
                stops.push((reached.fraction, reached.stop));
                steps = [steps[0].max(worst.closure), steps[1].max(worst.slip), steps[2].max(worst.step)];
            }
            println!(
                "{name} free {free}: {complete} of 12, closure {:.1e} slip {:.1e} step {:.1e} {stops:?}",
                steps[0], steps[1], steps[2]
            );
        }
    }
}
