//! On a ring fingertips touch where they say, and reach into no other part of it.

use regrasp::api::{Configuration, Context, FingerSet, Path, PoseRequest, Slot, Target, Task};
use regrasp::run::Setup;
use regrasp::{load, setup};
use regrasp_conformance::reference::closest_on_mesh;

/// How deep the deepest holding fingertip stands in the object (m).
fn depth(task: &Task<'_>, q: &Configuration) -> f64 {
    let of_finger = |finger| {
        let tip = task.hand.tip_center(finger, &q.joints[finger]);
        let p_OF = q.X_HO.inverse_transform_point(&tip.into()).coords;
        task.hand.fingertip_radius() - closest_on_mesh(&task.object.mesh, &p_OF).distance
    };
    q.holding().iter().map(of_finger).fold(f64::NEG_INFINITY, f64::max)
}

/// Configurations of a sampler, half of them where the start has the ring.
fn samples(setup: &Setup<'_>, count: u64) -> Vec<Configuration> {
    let task = setup.task();
    let all = FingerSet::first(task.hand.finger_count());
    let sample = |key: u64| {
        let request =
            if key.is_multiple_of(2) { PoseRequest::At(task.landmarks[0]) } else { PoseRequest::Anywhere };
        setup.plugins().sampler.sample(&task, request, all, &mut Context::seeded(key)).unwrap()
    };
    (0..count).filter_map(sample).collect()
}

#[test]
fn no_fingertip_of_a_node_or_a_path_stands_in_a_dent() {
    for sampler in ["rlg", "grasp-first", "projection"] {
        let mut scenario = load("ring").unwrap();
        scenario.choices.use_plugin(Slot::Sampler, sampler);
        let setup = setup(&scenario).unwrap();
        let (task, nodes) = (setup.task(), samples(&setup, 60));
        assert!(nodes.len() >= 20, "{sampler}: {}", nodes.len());
        let allowed = 0.5 * task.tolerances.closure;
        let deepest = nodes.iter().map(|q| depth(&task, q)).fold(f64::NEG_INFINITY, f64::max);
        assert!(deepest <= allowed, "{sampler}: a fingertip stands {deepest:e} m in the ring");
        let (mut states, mut deepest) = (0, f64::NEG_INFINITY);
        for (key, pair) in nodes.windows(2).enumerate() {
            let (mut path, mut context) = (Path::default(), Context::seeded(key as u64));
            let to = Target::Grasp(&pair[1]);
            let linear = &setup.plugins().grasp;
            let reached = linear.connect(&task, &pair[0], &to, Some(&mut path), &mut context).unwrap();
            if reached.is_complete() {
                states += path.states.len();
                deepest = path.states.iter().map(|q| depth(&task, q)).fold(deepest, f64::max);
            }
        }
        assert!(states > 20, "{sampler}: {states} states");
        assert!(deepest <= allowed, "{sampler}: on a path a fingertip stands {deepest:e} m in the ring");
    }
}
