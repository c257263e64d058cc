//! The example plugins keep every law in a real problem.

use regrasp::api::{Slot, Vec3};
use regrasp::run::{Depth, NeverStops, RunOptions};
use regrasp::{Stopwatch, load, setup};
use regrasp_example_plugins as _;

#[test]
fn the_examples_keep_the_laws_in_a_real_problem() {
    for (slot, id) in [
        (Slot::ContactModel, "grained"),
        (Slot::Surface, "remembering"),
        (Slot::Surface, "superquadric"),
        (Slot::TransferPlanner, "guarded"),
        (Slot::RegraspPlanner, "roadmap"),
        (Slot::GraphStrategy, "bandit"),
        (Slot::GraphStrategy, "best-first"),
    ] {
        let mut scenario = load("sphere").unwrap();
        scenario.choices.use_plugin(slot, id);
        let watch = Stopwatch::start();
        let options = RunOptions { stop: &NeverStops, ..watch.options(1) };
        let (run, case) = setup(&scenario).unwrap().run_audited(&options, Depth::Full);
        assert!(case.is_none(), "{id}: {:?}", case.map(|case| case.breach));
        assert!(run.unwrap().is_verified(), "{id}");
    }
}

/// Trait, kit, book and example say in the same words whose points and normals are.
#[test]
fn one_truth_about_surfaces_is_said_everywhere() {
    const WORDS: &str = "There is one true surface, the object's mesh: points and normals are the mesh's, \
        whatever closed form stood behind it.";
    for file in [
        "framework/api/src/roles/surface_param.rs",
        "framework/conformance/src/roles/surface/mod.rs",
        "examples/plugins/src/superquadric.rs",
        "book/src/tutorials/surface.md",
    ] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let text = std::fs::read_to_string(path).expect("it is part of the sources");
        let words = text.split_whitespace().filter(|word| !word.starts_with("//") && *word != "///");
        let text = words.collect::<Vec<_>>().join(" ").replace("([`crate::ObjectModel::mesh`])", "");
        assert!(text.replace("mesh :", "mesh:").contains(WORDS), "{file}");
    }
}

/// A plan on `sphere` with these plugins, and the note of the verifier's check of stability.
fn planned(contact_model: &str, test: &str) -> (regrasp::plan::Plan, Option<String>) {
    let mut scenario = load("sphere").unwrap();
    scenario.choices.use_plugin(Slot::ContactModel, contact_model);
    scenario.choices.use_plugin(Slot::StabilityTest, test);
    let watch = Stopwatch::start();
    let options = RunOptions { stop: &NeverStops, ..watch.options(1) };
    let run = setup(&scenario).unwrap().run(&options).unwrap();
    assert!(run.is_verified(), "{contact_model}, {test}: {:?}", run.why_not_solved());
    let stability = run.verdict.iter().flat_map(|verdict| &verdict.checks).find(|c| c.name == "stability");
    let check = stability.expect("stability is checked").clone();
    assert!(check.ok && check.worst.is_some(), "{check:?}");
    (run.plan.expect("it was verified"), check.place.note)
}

#[test]
fn a_grain_goes_all_the_way_from_the_model_to_the_verdict() {
    for test in ["force-closure", "equilibrium", "holding"] {
        let (plan, note) = planned("grained", test);
        let cone = plan.claims.contact.cone.expect("all contacts share the grain");
        let grain = cone.grain.expect("it is recorded");
        assert_eq!(grain.axis_O, [0.0, 0.0, 1.0]);
        assert!((grain.mu_across - 0.9 * cone.mu).abs() < 1e-12, "{test}");
        assert!(!note.unwrap_or_default().contains("not independently checked"), "{test}");
        if test == "holding" {
            let forces = plan.segments.iter().flat_map(|segment| &segment.states);
            assert!(forces.clone().count() > 0 && forces.clone().all(|state| state.forces.is_some()));
            // Forces that need more across the grain than there is there would be a fault of the plan.
            let regrasp::api::Cone::Grained(grain) = cone.cone() else { panic!("it is grained") };
            let contacts = forces.flat_map(|state| {
                let each = state.contacts.iter().zip(state.forces.iter().flatten());
                each.filter_map(|(contact, force)| Some((contact.as_ref()?, force.as_ref()?)))
            });
            for (contact, force) in contacts.take(2000) {
                let (n, f) = (Vec3::from(contact.normal_O), Vec3::from(*force));
                let used = grain.at(&n).map(|(tangent, mu)| f.dot(&tangent) / mu);
                assert!(used[0].hypot(used[1]) <= -f.dot(&n) * (1.0 + 1e-6), "{used:?}");
            }
        }
    }
}
