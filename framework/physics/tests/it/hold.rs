//! An object that is held still: what holds, what slips, what falls.
use crate::support;

use regrasp_api::*;
use regrasp_physics::*;
use support::{G, hand, object, ring, shapes};

const BOUNDS: Bounds = Bounds { distance: 2e-3, angle: 0.05, slip: 1e-3, gap: 5e-4 };
const PACE: Pace = Pace { speed: 0.25, ramp: 0.1 };

fn hold(object: &ObjectModel, settings: SimulationSettings) -> Outcome {
    let hand = hand();
    let states = vec![ring(&hand, object); 8];
    let simulator = TransferSimulator::new(settings, object).unwrap();
    simulator.simulate((&hand, object, G), &states, &PACE, 0.95 * object.friction, &BOUNDS)
}

#[test]
fn an_object_at_rest_stays_at_rest() {
    for object in shapes() {
        let outcome = hold(&object, SimulationSettings::default());
        assert!(outcome.is_good(), "{outcome:?}");
        assert!(outcome.distance < 2e-4 && outcome.angle < 5e-3, "{outcome:?}");
    }
}

#[test]
fn without_friction_or_far_too_heavy_it_falls() {
    for object in shapes() {
        let slippery = SimulationSettings { friction: Some(0.02), ..Default::default() };
        let heavy = SimulationSettings { mass: Some(10.0), ..Default::default() };
        for settings in [slippery, heavy] {
            let failure = hold(&object, settings).failure.expect("it falls");
            assert!(
                matches!(failure.what, Happening::Stray | Happening::Slip(_) | Happening::Lift(_)),
                "{failure:?}"
            );
        }
    }
}

#[test]
fn what_no_force_holds_is_told_before_anything_moves() {
    let mut object = object("{ kind = \"sphere\", radius = 0.03 }");
    object.mass = 10.0;
    let outcome = hold(&object, SimulationSettings::default());
    assert_eq!(outcome.failure.map(|failure| (failure.what, failure.state)), Some((Happening::NoGrip, 0)));
}

#[test]
fn deviations_shrink_with_the_time_step() {
    let object = object("{ kind = \"cuboid\", size = [0.045, 0.045, 0.045] }");
    let off = |time_step| hold(&object, SimulationSettings { time_step, ..Default::default() }).distance;
    assert!(off(2.5e-4) < 0.5 * off(1e-3), "{} {}", off(2.5e-4), off(1e-3));
}

#[test]
fn settings_outside_their_ranges_are_refused() {
    let object = object("{ kind = \"sphere\", radius = 0.03 }");
    for settings in [
        SimulationSettings { time_step: 0.0, ..Default::default() },
        SimulationSettings { stiffness: f64::NAN, ..Default::default() },
        SimulationSettings { friction: Some(-0.1), ..Default::default() },
    ] {
        assert!(matches!(TransferSimulator::new(settings, &object), Err(PhysicsError::Range { .. })));
    }
}
