//! Plan files come back as they were, and whatever else a file holds is refused with a readable reason.

mod common;

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
    assert!(text.starts_with("{\n  \"format\": \"regrasp-plan\",\n  \"version\": 1,\n  \"scenario\": {\n"));
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
    check(&good[..good.len() / 2], "truncated");
    check("PNG", "is not JSON");
    check("[1, 2]", "`format` is missing");
    check("{}", "`format` is missing");
    check("{\"format\": \"other\"}", "`format` is \"other\"");
    check(
        &good.replace("\"version\": 1", "\"version\": 2"),
        "format version 2, this program reads version 1",
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
    assert!(error.contains("segment 1, state 2"), "{error}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
    let nowhere = folder.path().join("nowhere/plan.json");
    assert!(matches!(write(&nowhere, &plan), Err(WriteError::NotFinite { .. })));
    assert!(matches!(write(&nowhere, &example()), Err(WriteError::NoFolder { .. })));
    write(&path, &example()).unwrap();
    assert_eq!(read(&path).unwrap(), example());
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
