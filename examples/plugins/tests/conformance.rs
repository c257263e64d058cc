//! The example plugins keep the laws of their roles.
use regrasp_example_plugins as _;
regrasp_conformance::registered_plugins_conform!();

#[test]
fn each_is_one_file_of_less_than_150_lines() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src");
    let files =
        std::fs::read_dir(folder).expect("the crate's sources").map(|file| file.expect("a file").path());
    let lines = |file: &std::path::PathBuf| std::fs::read_to_string(file).expect("a text").lines().count();
    let files: Vec<_> = files.filter(|file| !file.ends_with("lib.rs")).collect();
    assert_eq!(files.len(), 7, "seven plugins");
    let long: Vec<_> = files.iter().filter(|file| lines(file) >= 150).collect();
    assert!(long.is_empty(), "{long:?}");
}
