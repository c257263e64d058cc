//! Regrasps of a finger with links: the fingertip's way along the object is free, that of the links is not.

use super::places::{closed, turned};
use crate::fixtures::Bench;
use regrasp_api::{Configuration, FingerIndex, PerFinger, SurfaceParam, Vec3};

/// One problem: where the ball is, off from where hands hold it (m), the directions of the fingertips, and
/// that of the first one at the end.
struct Way {
    shift: [f64; 3],
    directions: [[f64; 3]; 4],
    to: [f64; 3],
}

/// Straight on, a link of the finger goes through the ball: ...
const THROUGH_THE_BALL: [Way; 2] = [
    Way {
        shift: [0.0, 0.01, -0.02],
        directions: [[0.99, 0.06, -0.13], [0.41, 0.9, -0.13], [-1.0, -0.02, -0.02], [-0.18, -0.96, 0.19]],
        to: [0.51, 0.29, 0.81],
    },
    Way {
        shift: [0.0, 0.01, -0.02],
        directions: [[0.96, -0.28, -0.07], [-0.09, 1.0, 0.03], [-0.98, -0.12, -0.17], [0.08, -0.97, -0.22]],
        to: [0.46, 0.32, 0.83],
    },
];
/// ... meets another finger's: ...
const THROUGH_A_FINGER: [Way; 2] = [
    Way {
        shift: [0.01, 0.01, -0.01],
        directions: [[0.94, -0.19, -0.29], [0.14, 0.96, 0.26], [-0.66, -0.14, 0.73], [0.48, -0.69, -0.54]],
        to: [0.12, 0.94, -0.32],
    },
    Way {
        shift: [-0.01, -0.02, -0.01],
        directions: [[0.41, 0.82, -0.4], [0.31, 0.69, 0.66], [-0.61, -0.76, -0.22], [-0.01, -1.0, 0.0]],
        to: [0.77, 0.63, -0.15],
    },
];
/// ... or the pin.
const THROUGH_THE_PIN: [Way; 2] = [
    Way {
        shift: [0.0, 0.02, 0.0],
        directions: [[0.99, -0.11, 0.03], [0.06, 1.0, 0.03], [-0.59, 0.81, -0.03], [0.36, -0.93, 0.05]],
        to: [0.96, 0.19, 0.22],
    },
    Way {
        shift: [-0.02, 0.0, -0.01],
        directions: [[0.64, -0.55, -0.54], [0.29, 0.91, -0.3], [-0.92, -0.33, -0.2], [0.48, -0.87, -0.1]],
        to: [0.81, 0.51, 0.3],
    },
];

/// Where the first finger begins and ends; the pin is once the palm's, once an obstacle.
pub(super) fn through_something() -> Vec<(&'static Bench, [Configuration; 2])> {
    let free = THROUGH_THE_BALL.iter().chain(&THROUGH_A_FINGER).map(|way| (Bench::hand_sphere(), way));
    let pins = [Bench::pinned_palm(), Bench::pinned_scene()].into_iter();
    let pinned = pins.flat_map(|bench| THROUGH_THE_PIN.iter().map(move |way| (bench, way)));
    free.chain(pinned).map(|(bench, way)| (bench, ends(bench, way))).collect()
}

fn ends(bench: &Bench, way: &Way) -> [Configuration; 2] {
    let X_HO = turned(&Bench::center(), way.shift.into(), Vec3::zeros());
    [way.directions[0], way.to].map(|first| {
        let contact = |finger: FingerIndex| {
            let u = if finger.index() == 0 { first } else { way.directions[finger.index()] };
            Some(bench.surface.project(&(Vec3::from(u).normalize() * 0.05), None).contact)
        };
        closed(bench, X_HO, &PerFinger::from_fn(4, contact)).expect("each direction is within reach")
    })
}
