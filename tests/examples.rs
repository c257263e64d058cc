//! Every numbered example runs, checks what it claims, and is listed with its output in `examples/README.md`.
//!
//! Cargo builds the examples of this package before it runs its tests.

use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The most lines of an example.
const MAX_LINES: usize = 120;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")
}

/// The numbered examples, by file name, in order.
fn numbered() -> Vec<String> {
    let entries = fs::read_dir(folder()).expect("the package has examples");
    let names = entries.map(|entry| entry.expect("the folder can be read").file_name());
    let is_numbered = |name: &String| name.starts_with(|c: char| c.is_ascii_digit());
    let mut names: Vec<String> =
        names.filter_map(|name| name.into_string().ok()).filter(is_numbered).collect();
    names.sort();
    names
}

/// Refuses an example that was built before its last change: `cargo test --test examples` alone builds none.
fn assert_fresh(name: &str, example: &Path) {
    let changed = |path: &Path| fs::metadata(path).and_then(|it| it.modified());
    let source = changed(&folder().join(name).with_extension("rs")).expect("an example has a source");
    let is_fresh = changed(example).is_ok_and(|built| built >= source);
    assert!(
        is_fresh,
        "{} is not built, or older than its source: `cargo build --examples`",
        example.display()
    );
}

/// Runs the example that cargo built beside this test, in a folder of its own, and gives what it prints.
fn run(name: &str) -> String {
    let test = std::env::current_exe().expect("the test is a program");
    let profile = test.ancestors().nth(2).expect("tests lie in `deps`, in the profile's folder");
    let example = profile.join("examples").join(format!("{name}{EXE_SUFFIX}"));
    assert_fresh(name, &example);
    let elsewhere = tempfile::tempdir().expect("a temporary folder");
    let ran = Command::new(&example).current_dir(elsewhere.path()).output();
    let ran = ran.expect("the example starts");
    assert!(ran.status.success(), "{name}: {}", String::from_utf8_lossy(&ran.stderr));
    let left = fs::read_dir(elsewhere.path()).expect("the temporary folder").count();
    assert_eq!(left, 0, "{name} leaves files behind");
    String::from_utf8(ran.stdout).expect("examples print UTF-8")
}

/// The example runs, and prints these words: what neither time nor machine changes.
fn assert_says(name: &str, words: &[&str]) {
    let said = run(name);
    for word in words {
        assert!(said.contains(word), "{name} does not say `{word}`:\n{said}");
    }
}

#[test]
fn test_a_grasp() {
    assert_says(
        "01_test_a_grasp",
        &["26.57°", "26.5°            yes", "26.6°             no", "presses with"],
    );
}

#[test]
fn liftable_fingers() {
    assert_says("02_liftable_fingers", &["thumb   must stay", "ring    may be lifted", "3 of 4 fingers"]);
}

#[test]
fn geodesic() {
    assert_says("03_geodesic", &["over the surface          40.00 cm", "ceiling", "other end"]);
}

#[test]
fn closed_chains() {
    assert_says("04_closed_chains", &["of 200 calls found a configuration", "liftable", "largest gap"]);
}

#[test]
fn plan_and_verify() {
    assert_says("05_plan_and_verify", &["smallest clearance", "closure fails"]);
}

#[test]
fn swap_a_plugin() {
    assert_says("06_swap_a_plugin", &["the paper's choice", "did you mean `stability-test/socp`?"]);
}

#[test]
fn write_a_stability_test() {
    assert_says("07_write_a_stability_test", &["keeps the laws of its role", "\n                  0.6 "]);
}

#[test]
fn load_a_plugin() {
    assert_says("08_load_a_plugin", &["sampler/template", "verified true", "refused: "]);
}

#[test]
fn compare_samplers() {
    assert_says("09_compare_samplers", &["projection / rlg: ", "100 %"]);
}

#[test]
fn own_hand_and_object() {
    assert_says("10_own_hand_and_object", &["a hand of 4 fingers", "116.9 cm³", "verified true"]);
}

#[test]
fn several_goals() {
    assert_says("11_several_goals", &["at 180.0°", "at   0.0°"]);
}

#[test]
fn grasps_in_bulk() {
    assert_says("13_grasps_in_bulk", &["400 grasps after", "      4  "]);
}

#[test]
fn an_atlas() {
    assert_says("14_an_atlas", &["free-fingertips  50 mm", "four-finger     500 mm    none: "]);
}

#[test]
fn a_protocol() {
    assert_says("15_a_protocol", &["of 23 orientations", "92 % (simulation)", "not replayed"]);
}

#[test]
fn examples_are_short_numbered_without_gaps_and_listed() {
    let list = fs::read_to_string(folder().join("README.md")).expect("the examples have a list");
    let own = include_str!("examples.rs");
    for (index, name) in numbered().iter().enumerate() {
        let text = fs::read_to_string(folder().join(name)).expect("an example can be read");
        let (lines, stem) = (text.lines().count(), name.split('.').next().unwrap_or_default());
        assert!(name.starts_with(&format!("{:02}_", index + 1)), "{name} breaks the numbering");
        assert!(lines <= MAX_LINES, "{name} has {lines} lines");
        assert!(list.contains(&format!("]({name})")), "{name} is not in examples/README.md");
        let runs = own.contains(&format!("\"{stem}\"")) || name.ends_with(".py");
        assert!(runs, "no test runs {name}");
    }
    assert_eq!(numbered().len(), 16);
}

#[test]
fn the_list_shows_what_examples_print() {
    let list = fs::read_to_string(folder().join("README.md")).expect("the examples have a list");
    let blocks = list.split("```").skip(1).step_by(2);
    let shown: Vec<(&str, &str)> = blocks
        .filter_map(|block| block.trim().strip_prefix("$ cargo run --release --example ")?.split_once('\n'))
        .collect();
    assert!(shown.len() >= 3, "{shown:?}");
    for (name, lines) in shown {
        let said = run(name);
        let wrong = lines.lines().find(|line| *line != "…" && !said.lines().any(|printed| printed == *line));
        assert_eq!(wrong, None, "{name} does not print this line of examples/README.md:\n{said}");
    }
}
