//! A contact model of edges goes all the way from `[hold]` to the verdict.

use regrasp::api::{
    Build, Cone, ConeEdge, Contact, ContactModel, Criterion, Entry, FingerIndex, NoSettings, Settings, Slot,
    check_settings, inventory,
};
use regrasp::plan::Plan;
use regrasp::run::{Depth, NeverStops, RunOptions};
use regrasp::verify::verify;
use regrasp::{Stopwatch, load, setup};

/// Pyramids of eight edges on the cone of the friction.
struct Pyramid;

impl ContactModel for Pyramid {
    fn cone(&self, _: FingerIndex, _: &Contact, mu: f64) -> Cone<'_> {
        let edge = |k: u32| {
            let (sin, cos) = (std::f64::consts::FRAC_PI_4 * f64::from(k)).sin_cos();
            ConeEdge { tangential: [mu * cos, mu * sin], torsion: 0.0 }
        };
        Cone::Polyhedral((0..8).map(edge).collect::<Vec<_>>().into())
    }

    fn fewest_contacts(&self) -> usize {
        3
    }
}

inventory::submit! {
    Entry {
        id: "contact-model/pyramid",
        slots: &[Slot::ContactModel],
        summary: "pyramids of eight edges, for tests",
        references: &["none"],
        schema: NoSettings::schema,
        check: check_settings::<NoSettings>,
        build: Build::ContactModel(|json, _| {
            NoSettings::from_json(json)?;
            Ok(Box::new(Pyramid))
        }),
    }
}

/// A plan of `allegro-cube`, which has `[hold]`, with pyramids.
fn planned() -> Plan {
    let mut scenario = load("allegro-cube").unwrap();
    scenario.choices.use_plugin(Slot::ContactModel, "pyramid");
    let watch = Stopwatch::start();
    let options = RunOptions { stop: &NeverStops, ..watch.options(1) };
    let (run, case) = setup(&scenario).unwrap().run_audited(&options, Depth::Full);
    assert!(case.is_none(), "{:?}", case.map(|case| case.breach));
    let run = run.unwrap();
    assert!(run.is_verified(), "{:?} {:?}", run.why_not_solved(), run.verdict);
    run.plan.expect("it was verified")
}

#[test]
fn edges_hold_within_efforts_and_the_verifier_proves_it() {
    let plan = planned();
    assert!(plan.claims.contact.cone.is_none() && plan.claims.contact.cones.len() == 1);
    assert!(matches!(plan.claims.criterion, Criterion::Holding(_)), "{:?}", plan.claims.criterion);
    let stability = |plan: &Plan| {
        let verdict = verify(plan);
        verdict.checks.into_iter().find(|check| check.name == "stability").expect("it is always looked at")
    };
    let check = stability(&plan);
    assert!(check.ok && check.worst.is_some() && check.place.note.is_none(), "{check:?}");
    // What the fingers cannot give is not proved: ten times the weight, a twentieth of the efforts, a claim
    // that means nothing.
    let mut heavy = plan.clone();
    heavy.scenario.problem.object.mass *= 10.0;
    assert!(!stability(&heavy).ok);
    let mut weak = plan.clone();
    let joints = weak.scenario.problem.hand.finger.iter_mut().flat_map(|finger| &mut finger.joint);
    joints.for_each(|joint| joint.effort *= 0.05);
    assert!(!stability(&weak).ok);
    let mut slippery = plan.clone();
    for cone in &mut slippery.claims.contact.cones {
        if let regrasp::plan::ConeRecord::Polyhedral(edges) = cone {
            edges.iter_mut().for_each(|edge| edge.tangential = edge.tangential.map(|x| 0.2 * x));
        }
    }
    assert!(!stability(&slippery).ok);
    let mut senseless = plan;
    let Criterion::Holding(load) = &mut senseless.claims.criterion else { panic!("it was matched") };
    load.friction_factor = f64::NAN;
    assert!(!stability(&senseless).ok);
}
