//! Plan files come back as they were, and whatever else a file holds is refused with a readable reason.

use crate::common;

use common::*;
use proptest::prelude::*;
use regrasp_api::FingerIndex;
use regrasp_plan::*;
use std::path::Path;

fn example() -> Plan {
    let hand = Fingertips::new(3, 1.0, 10.0);
    let mut motion = walk(3, 3, 4);
    assign_times(&mut motion, &hand, &TimingLimits::default()).unwrap();
    plan(&motion, &hand)
}

fn text(plan: &Plan) -> String {
    let mut bytes = Vec::new();
    write_json(plan, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn parse(text: &str) -> Result<Plan, ReadError> {
    from_json(text.as_bytes(), Path::new("p.json"))
}

#[test]
fn a_plan_comes_back_exactly_and_as_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.json");
    let plan = example();
    write(&path, &plan).unwrap();
    let back = read(&path).unwrap();
    assert_eq!(plan, back);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text(&back));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no temporary file stays");
}

#[test]
fn the_motion_comes_back_exactly() {
    let hand = Fingertips::new(3, 1.0, 10.0);
    let mut timed = walk(5, 3, 6);
    assign_times(&mut timed, &hand, &TimingLimits::default()).unwrap();
    let back = motion(&parse(&text(&plan(&timed, &hand))).unwrap()).unwrap();
    assert_eq!(timed, back);
    let (q, record) = (&timed.segments[1].states[2], &records(&timed, &hand).unwrap()[1].states[2]);
    let contact = record.contacts[1].unwrap();
    let expected = q.X_HO.rotation * q.contacts[FingerIndex(1)].unwrap().n_O * -0.01;
    assert!((regrasp_api::Vec3::from(contact.point_F) - expected).norm() < 1e-15);
}

#[test]
fn each_state_is_one_line_and_the_header_comes_first() {
    let text = text(&example());
    assert!(text.starts_with("{\n  \"format\": \"regrasp-plan\",\n  \"version\": 2,\n  \"scenario\": {\n"));
    let states = text.lines().filter(|line| line.trim_start().starts_with("{\"time\": ")).count();
    assert_eq!(states, 12);
    assert!(text.ends_with("}\n"));
}

#[test]
fn an_untimed_motion_has_no_records() {
    let hand = Fingertips::new(3, 1.0, 10.0);
    let error = records(&walk(3, 3, 4), &hand).unwrap_err();
    assert_eq!(error, ConvertError::NotTimed { segment: 0, states: 4, times: 0 });
}

#[test]
fn segments_of_another_form_are_no_motion() {
    let mut plan = example();
    plan.segments[1].finger = None;
    assert_eq!(motion(&plan), Err(ConvertError::Finger { segment: 1 }));
    let mut plan = example();
    plan.segments[2].states[1].contacts.pop();
    assert!(matches!(motion(&plan), Err(ConvertError::Form { segment: 2, state: 1, .. })));
    let mut plan = example();
    plan.segments[0].states[3].joints[1] = vec![0.0; 8];
    assert!(matches!(motion(&plan), Err(ConvertError::Form { segment: 0, state: 3, .. })));
    let mut plan = example();
    plan.segments[0].states[2].joints[1].pop();
    assert!(matches!(motion(&plan), Err(ConvertError::Form { segment: 0, state: 2, .. })));
    let mut plan = example();
    plan.segments[1].finger = Some(9);
    assert_eq!(motion(&plan), Err(ConvertError::Finger { segment: 1 }));
}

#[test]
fn every_bad_file_is_refused_with_the_file_and_what_to_do() {
    let good = text(&example());
    let check = |text: &str, part: &str| {
        let message = parse(text).unwrap_err().to_string();
        assert!(message.contains("p.json") && message.contains(part), "{message}");
    };
    check("", "is empty");
    check(" \n", "is empty");
    // Wherever it ends, also within a number or a word.
    let middle = good.len() / 2;
    (middle..middle + 400).for_each(|end| check(&good[..end], "truncated"));
    check("PNG", "is not JSON");
    check("[1, 2]", "`format` is missing");
    check("{}", "`format` is missing");
    check("{\"format\": \"other\"}", "`format` is \"other\"");
    check(
        &good.replace("\"version\": 2", "\"version\": 3"),
        "format version 3, this program reads versions 1 to 2",
    );
    check(&good.replacen("\"seed\"", "\"sed\"", 1), "unknown field `sed`");
    check(&good.replacen("\"seed\": 7", "\"seed\": -7", 1), "-7");
    check(&good.replacen("\"position\": [", "\"position\": [1.0, ", 1), "line");
    let missing = read(Path::new("no-such-folder/p.json")).unwrap_err().to_string();
    assert!(missing.contains("does not exist"), "{missing}");
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(read(folder.path()), Err(ReadError::IsFolder { .. })));
}

#[test]
fn a_failed_write_leaves_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.json");
    std::fs::write(&path, "old").unwrap();
    let mut plan = example();
    plan.segments[1].states[2].joints[0][1] = f64::INFINITY;
    let error = write(&path, &plan).unwrap_err().to_string();
    assert!(error.contains("segment 2, state 3"), "{error}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
    let nowhere = folder.path().join("nowhere/plan.json");
    assert!(matches!(write(&nowhere, &plan), Err(WriteError::NotFinite { .. })));
    assert!(matches!(write(&nowhere, &example()), Err(WriteError::NoFolder { .. })));
    write(&path, &example()).unwrap();
    assert_eq!(read(&path).unwrap(), example());
}

/// A plan with everything that version 2 adds.
fn rich() -> Plan {
    let mut plan = example();
    let facets = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let vertices = vec![[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
    let twin = ContactSurface { vertices, facets, digest: "00ff".into(), bound: 1e-4 };
    let surface = Facets { vertices: twin.vertices.clone(), facets: twin.facets.clone() };
    plan.object = Some(ObjectRecord { surface: Some(surface), contact_surface: Some(twin) });
    let edge = |x| EdgeRecord { tangential: [x, 0.1], torsion: 0.001 };
    plan.claims.contact.cone = None;
    plan.claims.contact.cones = vec![
        ConeRecord::Elliptic(ConeClaim::round(0.5, 0.002)),
        ConeRecord::Polyhedral(vec![edge(0.5), edge(-0.5), edge(0.0)]),
    ];
    plan.notes
        .insert(regrasp_api::Slot::Sampler, [("hits".to_owned(), regrasp_api::Figure::one(12.0))].into());
    let place = || Place { segment: Some(1), ..Default::default() };
    let figure = |value| Extreme::new(value, place(), HoldsAt::Samples);
    let holds = Holds { friction: figure(0.31), mass: figure(0.4), disturbance: figure(2.5), effort: None };
    plan.certificate = Some(PlanCertificate {
        closure_margin: None,
        clearance: None,
        slip: Some(figure(1e-5)),
        closure_residual: None,
        holds: Some(holds),
    });
    for state in plan.segments.iter_mut().flat_map(|segment| &mut segment.states) {
        state.velocities = Some(vec![vec![0.1, -0.2, 0.3]; 3]);
        state.cones = Some(vec![None, Some(0), Some(1)]);
        state.forces = Some(vec![None, Some([0.1, 0.2, -0.3]), Some([0.0, 1e-3, 0.5])]);
    }
    plan
}

#[test]
fn what_version_2_adds_comes_back_exactly_and_its_numbers_are_finite() {
    let plan = rich();
    assert_eq!(parse(&text(&plan)).unwrap(), plan);
    let folder = tempfile::tempdir().unwrap();
    let refused = |change: &dyn Fn(&mut Plan)| {
        let mut plan = rich();
        change(&mut plan);
        write(&folder.path().join("p.json"), &plan).unwrap_err().to_string()
    };
    let state = |plan: &mut Plan, change: &dyn Fn(&mut StateRecord)| change(&mut plan.segments[2].states[1]);
    let velocity = refused(&|p| state(p, &|s| s.velocities.as_mut().unwrap()[1][2] = f64::NAN));
    let force = refused(&|p| state(p, &|s| s.forces.as_mut().unwrap()[2] = Some([f64::INFINITY; 3])));
    assert!([velocity, force].iter().all(|message| message.contains("segment 3, state 2")));
    let bound = |p: &mut Plan| p.object.as_mut().unwrap().contact_surface.as_mut().unwrap().bound = f64::NAN;
    assert!(refused(&bound).contains("contact surface"));
}

#[test]
fn plans_of_version_1_are_read_and_stay_what_they_are() {
    let mut old = example();
    old.version = 1;
    // Version 1 knew no velocities.
    old.segments.iter_mut().flat_map(|segment| &mut segment.states).for_each(|state| state.velocities = None);
    let written = text(&old);
    assert!(written.contains("\"version\": 1,\n") && !written.contains("velocities"));
    assert_eq!(parse(&written).unwrap(), old);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn damaged_bytes_never_panic(cut in 0.0_f64..1.0, place in 0.0_f64..1.0, byte in any::<u8>(), truncate in any::<bool>()) {
        thread_local!(static GOOD: String = text(&example()));
        GOOD.with(|good| {
            let mut bytes = good.clone().into_bytes();
            if truncate {
                bytes.truncate((cut * bytes.len() as f64) as usize);
                // Cutting only the last line break leaves a whole plan.
                assert!(from_json(&bytes, Path::new("p")).is_err() || bytes.len() + 1 >= good.len());
            } else {
                let place = (place * bytes.len() as f64) as usize;
                bytes[place] = byte;
                let _ = from_json(&bytes, Path::new("p")).map(|plan| motion(&plan));
            }
        });
    }

    #[test]
    fn every_finite_number_comes_back(bits in any::<u64>()) {
        let value = f64::from_bits(bits);
        prop_assume!(value.is_finite());
        let mut plan = example();
        plan.segments[0].states[1].joints[0][0] = value;
        let back = parse(&text(&plan)).unwrap();
        prop_assert_eq!(back.segments[0].states[1].joints[0][0].to_bits(), bits);
    }
}
