//! An object that is held still: what holds, what slips, what falls.
#![allow(missing_docs)]

use regrasp_api::*;
use regrasp_physics::*;
use regrasp_world::{ChainHand, load_object};
use std::path::Path;

const G: Vec3 = Vec3::new(0.0, 0.0, -9.81);
const BOUNDS: Bounds = Bounds { distance: 2e-3, angle: 0.05, slip: 1e-3, gap: 5e-4 };
const PACE: Pace = Pace { speed: 0.25, ramp: 0.1 };

fn hand() -> ChainHand {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/hands/four-finger.toml");
    ChainHand::new(toml::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()).unwrap()
}

fn object(shape: &str) -> ObjectModel {
    let text = format!("friction = 0.8\nmass = 0.1\nshape = {shape}\n");
    let description: ObjectDescription = toml::from_str(&text).unwrap();
    load_object(&description, Path::new(".")).unwrap()
}

fn shapes() -> [ObjectModel; 3] {
    [
        "{ kind = \"sphere\", radius = 0.03 }",
        "{ kind = \"cuboid\", size = [0.045, 0.045, 0.045] }",
        // Concave between its fins: fingers touch outside.
        "{ kind = \"torus\", ring_radius = 0.022, tube_radius = 0.012 }",
    ]
    .map(object)
}

/// Four fingers about the object's middle, on the facet that faces each.
fn ring(hand: &ChainHand, object: &ObjectModel) -> Configuration {
    let X_HO = Pose::translation(0.0, 0.0, 0.085);
    let joints = PerFinger::from_fn(4, |finger| hand.finger(finger).rest);
    let mut q = Configuration { X_HO, joints, contacts: PerFinger::filled(4, None) };
    let ways = [Vec3::x(), Vec3::y(), -Vec3::x(), -Vec3::y()];
    for (finger, way) in joints.fingers().zip(ways) {
        let contact = facing(&object.mesh, &way);
        let p_HF = X_HO * nalgebra::Point3::from(contact.tip_center(hand.fingertip_radius()));
        q.joints[finger] = hand.inverse(finger, &p_HF.coords, &joints[finger]).expect("within reach");
        q.contacts[finger] = Some(contact);
    }
    q
}

fn facing(mesh: &Mesh, way: &Vec3) -> Contact {
    let middle = |facet: u32| mesh.corners(facet).iter().sum::<Vec3>() / 3.0;
    let facets = 0..mesh.facets().len() as u32;
    let off = |facet: &u32| (way * middle(*facet).dot(way) - middle(*facet)).norm() - middle(*facet).dot(way);
    let facet = facets.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
    Contact { facet, p_OC: middle(facet), n_O: mesh.normal(facet) }
}

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
