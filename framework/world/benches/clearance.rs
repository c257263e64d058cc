//! Collision checks, and loading of objects.

use criterion::{Criterion, criterion_group, criterion_main};
use regrasp_api::{
    Clearance, Configuration, FingerIndex, FingerSet, Hand, ObjectModel, PerFinger, Pose, Primitive, TipRule,
    Vec3,
};
use regrasp_world::{ChainHand, SceneClearance, primitive_mesh};
use std::hint::black_box;
use std::sync::Arc;

fn four_finger() -> ChainHand {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/hands/four-finger.toml");
    let text = std::fs::read_to_string(file).expect("the hand file is part of the project");
    ChainHand::new(toml::from_str(&text).expect("it is valid")).expect("it is valid")
}

/// Each fingertip on the object's side that faces its finger.
fn grasp(hand: &ChainHand, object: &ObjectModel) -> Configuration {
    let X_HO = Pose::translation(0.0, 0.0, 0.085);
    let joints = PerFinger::from_fn(hand.finger_count(), |finger| {
        let model = hand.finger(finger);
        let toward = Vec3::new(model.p_HReach.x, model.p_HReach.y, 0.0).normalize();
        let highest = object.mesh.vertices().iter().map(|v| v.dot(&toward)).fold(0.0, f64::max);
        let p_HF = X_HO.translation.vector + toward * (highest + hand.fingertip_radius());
        hand.inverse(finger, &p_HF, &model.rest).expect("the grasp is within reach")
    });
    Configuration { X_HO, joints, contacts: PerFinger::filled(hand.finger_count(), None) }
}

fn objects() -> Vec<(&'static str, ObjectModel)> {
    let model = |form, closed: bool| {
        let mesh = primitive_mesh(&form, 1280).expect("the primitive is sound");
        ObjectModel::new(mesh, closed.then_some(form), 0.1, 0.8)
    };
    let sphere = Primitive::Sphere { radius: 0.03 };
    vec![
        ("sphere", model(sphere, true)),
        ("cuboid", model(Primitive::Cuboid { half_size: Vec3::repeat(0.0225) }, true)),
        ("ellipsoid", model(Primitive::Ellipsoid { semi_axes: Vec3::new(0.04, 0.025, 0.025) }, true)),
        ("torus", model(Primitive::Torus { ring_radius: 0.03, tube_radius: 0.01 }, true)),
        ("mesh", model(sphere, false)),
    ]
}

fn checks(criterion: &mut Criterion) {
    let hand = Arc::new(four_finger());
    for (name, object) in objects() {
        let scene = SceneClearance::new(hand.clone(), &object, &[], 5e-4).expect("the scene is sound");
        let mut q = grasp(&hand, &object);
        let contact = regrasp_api::Contact { facet: 0, p_OC: Vec3::zeros(), n_O: Vec3::z() };
        q.contacts = PerFinger::filled(hand.finger_count(), Some(contact));
        let all = FingerSet::first(hand.finger_count());
        assert_eq!(scene.configuration_free(&q, all, true), Ok(()), "{name}");
        let (a, b) = (FingerIndex(0), FingerIndex(1));
        criterion.bench_function(&format!("{name}/finger_free"), |bencher| {
            bencher.iter(|| scene.finger_free(a, black_box(&q.joints[a]), &q.X_HO, TipRule::Touches));
        });
        criterion.bench_function(&format!("{name}/fingers_free"), |bencher| {
            bencher.iter(|| scene.fingers_free((a, black_box(&q.joints[a])), (b, &q.joints[b])));
        });
        criterion.bench_function(&format!("{name}/configuration_free"), |bencher| {
            bencher.iter(|| scene.configuration_free(black_box(&q), all, true));
        });
        criterion.bench_function(&format!("{name}/object_free"), |bencher| {
            bencher.iter(|| scene.object_free(black_box(&q.X_HO)));
        });
        criterion.bench_function(&format!("{name}/distances"), |bencher| {
            bencher.iter(|| scene.distances(black_box(&q), 0.02));
        });
    }
}

fn building(criterion: &mut Criterion) {
    let hand = Arc::new(four_finger());
    for (name, object) in objects() {
        criterion.bench_function(&format!("{name}/build"), |bencher| {
            bencher.iter(|| SceneClearance::new(hand.clone(), black_box(&object), &[], 5e-4));
        });
    }
    criterion.bench_function("sphere/mesh of 1,280 facets", |bencher| {
        bencher.iter(|| primitive_mesh(&Primitive::Sphere { radius: 0.03 }, black_box(1280)));
    });
}

criterion_group!(benches, checks, building);
criterion_main!(benches);
