//! Plugins from libraries in a study: compared like all others, and what panics is a row.

use crate::workshop::{faulty, regrasp};

#[test]
fn a_loaded_plugin_is_varied_and_its_panics_are_rows() {
    let library = faulty();
    let library = library.to_str().expect("the target folder is UTF-8");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let study = folder.path().join("study");
    let study = study.to_str().expect("the temporary folder is UTF-8");
    let vary = ["--vary", "sampler=rlg,faulty", "--seeds", "2", "-o", study, "--json"];
    let said = regrasp(&[&["compare", "sphere", "--load", library], vary.as_slice()].concat());
    assert_eq!(said.code, Some(0), "{said:?}");
    let report: serde_json::Value = serde_json::from_str(&said.out).expect("the report is JSON");
    assert_eq!((&report["runs"], &report["verified"]), (&4.into(), &2.into()));
    let runs =
        std::fs::read_to_string(folder.path().join("study/runs.jsonl")).expect("a study has a journal");
    let panics = runs.lines().filter(|run| {
        run.contains("\"status\":\"panic\"") && run.contains("`sampler/faulty` panicked: (no message)")
    });
    assert_eq!(panics.count(), 2, "{runs}");
    let described = std::fs::read_to_string(folder.path().join("study/study.json")).expect("it is written");
    assert!(described.contains("\"library lib"), "the library's hash is recorded: {described:.400}");
}

/// The statuses in a study's journal, in order.
fn statuses(study: &std::path::Path) -> Vec<String> {
    let runs = std::fs::read_to_string(study.join("runs.jsonl")).expect("a study has a journal");
    let status = |line: &str| {
        let run: serde_json::Value = serde_json::from_str(line).expect("a line is a run");
        run["status"].as_str().expect("a run has a status").to_owned()
    };
    runs.lines().map(status).collect()
}

#[test]
fn a_run_that_ends_the_process_is_a_row_the_next_time_or_at_once() {
    let library = faulty();
    let library = library.to_str().expect("the target folder is UTF-8");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let compare = |name: &str, more: &[&str]| {
        let study = folder.path().join(name);
        let study = study.to_str().expect("the temporary folder is UTF-8");
        let words = ["compare", "sphere", "--load", library, "--vary", "sampler=rlg,aborts", "--seeds", "1"];
        regrasp(&[words.as_slice(), &["--threads", "1", "-o", study, "--json"], more].concat())
    };
    let died = compare("begun", &[]);
    assert!(died.code != Some(0), "{died:?}");
    let ended = compare("begun", &[]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    assert_eq!(statuses(&folder.path().join("begun")), ["solved", "crash"]);
    assert!(!folder.path().join("begun/begun.txt").exists());
    let apart = compare("apart", &["--isolate"]);
    assert_eq!(apart.code, Some(0), "{apart:?}");
    assert_eq!(statuses(&folder.path().join("apart")), ["solved", "crash"]);
}
