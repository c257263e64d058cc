//! A contact model of edges goes all the way from `[hold]` to the verdict.

use regrasp::api::{
    Build, Cone, ConeEdge, Contact, ContactModel, Criterion, Entry, FingerIndex, NoSettings, Settings, Slot,
    check_settings, inventory,
};
use regrasp::plan::Plan;
use regrasp::run::{Depth, NeverStops, RunOptions};
use regrasp::verify::verify;
use regrasp::{Stopwatch, load, setup};

/// Pyramids of eight edges on the cone of the friction, and two that turn by so much torque per newton (m).
struct Pyramid {
    torsion: f64,
}

impl ContactModel for Pyramid {
    fn cone(&self, _: FingerIndex, _: &Contact, mu: f64) -> Cone<'_> {
        let edge = |k: u32| {
            let (sin, cos) = (std::f64::consts::FRAC_PI_4 * f64::from(k)).sin_cos();
            ConeEdge { tangential: [mu * cos, mu * sin], torsion: 0.0 }
        };
        let turning = [self.torsion, -self.torsion].map(|torsion| ConeEdge { tangential: [0.0; 2], torsion });
        let turning = turning.into_iter().filter(|edge| edge.torsion != 0.0);
        Cone::Polyhedral((0..8).map(edge).chain(turning).collect::<Vec<_>>().into())
    }

    fn fewest_contacts(&self) -> usize {
        3
    }
}

macro_rules! pyramid {
    ($id:literal, $torsion:literal) => {
        inventory::submit! {
            Entry {
                id: $id,
                slots: &[Slot::ContactModel],
                summary: "pyramids of eight edges, for tests",
                references: &["none"],
                schema: NoSettings::schema,
                check: check_settings::<NoSettings>,
                build: Build::ContactModel(|json, _| {
                    NoSettings::from_json(json)?;
                    Ok(Box::new(Pyramid { torsion: $torsion }))
                }),
            }
        }
    };
}
pyramid!("contact-model/pyramid", 0.0);
pyramid!("contact-model/soft-pyramid", 0.003);

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
    records_forces(&plan);
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

/// Every state records forces; the certificate says what they hold, and the verifier refuses others.
fn records_forces(plan: &Plan) {
    let states = || plan.segments.iter().flat_map(|segment| &segment.states);
    assert!(states().all(|state| state.forces.is_some()));
    let holds = |plan: &Plan| verify(plan).certificate.and_then(|certificate| certificate.holds);
    let Criterion::Holding(load) = &plan.claims.criterion else { panic!("it was matched") };
    let found = holds(plan).expect("forces are recorded");
    let (friction, mass) = (plan.scenario.problem.object.friction, plan.scenario.problem.object.mass);
    assert!(found.friction.value > 0.0 && found.friction.value <= load.friction_factor * friction + 1e-9);
    assert!(found.mass.value >= mass && found.disturbance.value > 0.0, "{found:?}");
    let fault = |damage: &dyn Fn(&mut [f64; 3])| {
        let mut plan = plan.clone();
        let states = plan.segments.iter_mut().flat_map(|segment| &mut segment.states);
        states.flat_map(|state| state.forces.iter_mut().flatten().flatten()).for_each(damage);
        let check = verify(&plan).checks.into_iter().find(|check| check.name == "forces");
        let check = check.expect("forces are recorded");
        (!check.ok).then(|| check.place.note.unwrap_or_default())
    };
    assert_eq!(fault(&|_| ()), None);
    exports_forces(plan);
    assert!(fault(&|force| force[0] += 0.1).is_some_and(|note| note.contains("balance")));
    // A hand that squeezes as hard along other directions relies on more than the pyramids give.
    let mut narrow = plan.clone();
    for cone in &mut narrow.claims.contact.cones {
        if let regrasp::plan::ConeRecord::Polyhedral(edges) = cone {
            edges.iter_mut().for_each(|edge| edge.tangential = edge.tangential.map(|x| 0.2 * x));
        }
    }
    let narrowed = verify(&narrow).checks.into_iter().find(|check| check.name == "forces");
    let note = narrowed.and_then(|check| check.place.note).unwrap_or_default();
    assert!(note.contains("more friction"), "{note}");
}

#[test]
fn forces_of_edges_are_recorded_without_a_load_too() {
    for model in ["pyramid", "soft-pyramid"] {
        let mut scenario = load("sphere").unwrap();
        scenario.choices.use_plugin(Slot::ContactModel, model);
        let watch = Stopwatch::start();
        let options = RunOptions { stop: &NeverStops, ..watch.options(1) };
        let run = setup(&scenario).unwrap().run(&options).unwrap();
        assert!(run.is_verified(), "{model}: {:?} {:?}", run.why_not_solved(), run.verdict);
        let plan = run.plan.expect("it was verified");
        let states = plan.segments.iter().flat_map(|segment| &segment.states);
        let (with, all) = (states.clone().filter(|state| state.forces.is_some()).count(), states.count());
        // Torques, which no plan records, may hold the ball instead.
        assert!(with == all || model == "soft-pyramid" && 2 * with > all, "{model}: {with} of {all}");
        let verdict = verify(&plan);
        let forces = verdict.checks.iter().find(|check| check.name == "forces").expect("forces are recorded");
        assert!(forces.ok, "{forces:?}");
        let holds = verdict.certificate.and_then(|certificate| certificate.holds).expect("so are figures");
        assert!(holds.mass.value > 0.0 && holds.friction.value > 0.0, "{holds:?}");
    }
}

/// What is exported has the plan's forces, and says what it leaves out.
fn exports_forces(plan: &Plan) {
    use regrasp::export::{Format, Scene};
    let scene = Scene::new(plan).expect("the plan is whole");
    assert!(
        scene.notes().iter().any(|note| note.contains("`force_margin` is left out")),
        "{:?}",
        scene.notes()
    );
    let file = scene.export(Format::Csv, "plan").expect("tables take any plan").remove(0);
    let text = String::from_utf8(file.bytes).expect("a table is a text");
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let forces = rows[0].iter().enumerate().filter(|(_, name)| name.contains(".force_H."));
    let forces: Vec<usize> = forces.map(|(column, _)| column).collect();
    let pressed =
        |row: &Vec<&str>| forces.iter().any(|column| row[*column].parse::<f64>().is_ok_and(|f| f != 0.0));
    assert!(rows.len() > 2 && rows[1..].iter().all(pressed), "{:.300}", text);
    assert!(rows[1..].iter().all(|row| row.last() == Some(&"")), "no margin is made up");
}
