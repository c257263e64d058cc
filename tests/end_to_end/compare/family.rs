//! One family of hypotheses in all that a study says, and two studies side by side.

use super::shelf::csv;
use crate::desk::Desk;
use serde_json::Value;

const STUDY: &str = "compare sphere --vary sampler=rlg,projection,grasp-first --seeds 8 -o study";

fn verdicts(desk: &Desk) -> Vec<(String, String, String)> {
    let mut rows = csv(&desk.read("study/comparisons.csv"));
    let head = rows.remove(0);
    let at = |name: &str| head.iter().position(|column| column == name).expect("a column");
    let (what, against, measure, verdict) = (at("what"), at("against"), at("measure"), at("verdict"));
    let told = |row: &Vec<String>| {
        (format!("{} {}", row[what], row[against]), row[measure].clone(), row[verdict].clone())
    };
    rows.iter().map(told).collect()
}

#[test]
fn pairs_measures_and_band_are_chosen_and_told() {
    let desk = Desk::new();
    let said = desk.run(STUDY);
    assert_eq!(said.code, 0, "{}", said.err);
    let first = verdicts(&desk);
    assert!(first.iter().all(|(pair, _, _)| pair.ends_with(" rlg")), "{first:?}");
    for measure in
        ["solved", "planning_s", "verification_s", "regrasps", "duration_s", "margin", "clearance_m"]
    {
        assert!(first.iter().any(|(_, other, _)| other == measure), "{measure}");
    }
    let text = format!("each variant against `rlg`, in every measure, on every scenario: {}", first.len());
    assert!(said.out.contains(&text) && desk.read("study/summary.md").contains(&text), "{}", said.out);
    // The same runs asked otherwise: no run is made again, and everything says what is asked now.
    let runs = desk.read("study/runs.jsonl");
    let words = "--pairs all --measures solved,planning --equivalence 25 --json";
    let said = desk.run(&format!("{STUDY} {words}")).json();
    assert_eq!(desk.read("study/runs.jsonl"), runs);
    let second = verdicts(&desk);
    assert_eq!(second.len(), 3 * 2);
    assert!(second.iter().any(|(pair, _, _)| pair == "grasp-first projection"));
    assert_eq!(said["comparisons"].as_array().map(Vec::len), Some(6));
    assert!(said["family"].as_str().is_some_and(|text| text.contains("25 %")), "{said:#}");
    for (told, (_, _, verdict)) in said["comparisons"].as_array().expect("a list").iter().zip(&second) {
        assert_eq!(told["verdict"], Value::from(verdict.as_str()));
    }
    for (words, parts) in [
        ("--pairs some", ["`baseline` or `all`", "--pairs"]),
        ("--measures speed", ["`planning`", "--measures"]),
        ("--equivalence -3", ["0..=100", "--equivalence"]),
    ] {
        desk.run(&format!("{STUDY} {words}")).assert_fails(2, &parts);
    }
}

#[test]
fn two_studies_stand_side_by_side() {
    let desk = Desk::new();
    for folder in ["old", "new"] {
        assert_eq!(
            desk.run(&format!("compare sphere --vary sampler=rlg,projection --seeds 3 -o {folder}")).code,
            0
        );
    }
    let said = desk.run("compare --against old -o new");
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(said.out.contains("`projection`: ") && desk.read("new/against.md").contains("New less old"));
    let json = desk.run("compare --against old -o new --json").json();
    let all = json["comparisons"].as_array().expect("a list");
    let regrasps = all.iter().filter(|one| one["measure"] == "regrasps");
    // The same seeds give the same plans.
    assert!(
        regrasps.clone().count() == 2 && regrasps.clone().all(|one| one["difference"] == 0.0),
        "{json:#}"
    );
    assert_eq!(csv(&desk.read("new/against.csv")).len(), 1 + all.len());
    desk.run("compare --against nowhere -o new").assert_fails(2, &["`nowhere`", "no `study.json`"]);
    assert_eq!(desk.run("compare cubic --seeds 1 -o other").code, 0);
    desk.run("compare --against old -o other").assert_fails(2, &["no scenario, variant and seed in common"]);
    desk.run("compare sphere --against old -o new").assert_fails(2, &["cannot be used with"]);
}

#[test]
fn a_study_can_be_watched() {
    let desk = Desk::new();
    let said = desk.run("compare sphere --seeds 3 --watch -o study");
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(said.err.contains("the growing report: http://127.0.0.1:"), "{}", said.err);
    assert!(desk.path("study/report.html").exists(), "the page ends with the study, the report stays");
}
