//! The book's reference agrees with the program.

mod exit_codes;
mod plan_file;
mod settings;
mod shells;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of the reference's pages.
fn pages() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("book/src/reference")
}

fn page(name: &str) -> String {
    std::fs::read_to_string(pages().join(name)).expect("the page is part of the book")
}

/// Runs the program with the words of `arguments` in `folder`.
fn regrasp(folder: &Path, arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_regrasp"))
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .output()
        .expect("the program was built for this test")
}

/// What the program prints; it must succeed.
fn printed(folder: &Path, arguments: &str) -> String {
    let output = regrasp(folder, arguments);
    assert!(output.status.success(), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("the program prints UTF-8")
}

/// What mends a page that is out of date.
const MEND: &str = "cargo run -- reference book/src/reference";

#[test]
fn the_generated_pages_are_up_to_date() {
    let fresh = tempfile::tempdir().expect("a temporary folder");
    let folder = fresh.path().to_str().expect("a path in UTF-8");
    let written = printed(fresh.path(), &format!("reference {folder}"));
    assert_eq!(written.lines().count(), 4, "{written}");
    for path in written.lines().map(Path::new) {
        let name = path.file_name().and_then(|name| name.to_str()).expect("the name of a page");
        let (made, kept) = (std::fs::read_to_string(path).expect("it was just written"), page(name));
        let differs = made.lines().zip(kept.lines()).position(|(made, kept)| made != kept);
        assert!(
            made == kept,
            "book/src/reference/{name} is out of date (line {}); `{MEND}` makes it anew",
            differs.unwrap_or_else(|| made.lines().count().min(kept.lines().count())) + 1
        );
    }
}

#[test]
fn pages_that_cannot_be_written_are_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = regrasp(folder.path(), "reference nowhere");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("folder does not exist"));
}

#[test]
fn every_anchor_is_there_once() {
    for name in ["plugins.md", "scenario.md", "study.md", "commands.md"] {
        let text = page(name);
        let anchors: Vec<&str> =
            text.lines().filter_map(|line| line.split_once(" {#")?.1.strip_suffix('}')).collect();
        assert!(anchors.len() > 4, "{name} has the anchors {anchors:?}");
        for (number, anchor) in anchors.iter().enumerate() {
            assert!(!anchors[..number].contains(anchor), "{name} has the anchor {anchor} twice");
        }
        for link in text.split("](#").skip(1).filter_map(|rest| rest.split(')').next()) {
            assert!(anchors.contains(&link), "{name} links to #{link}, which is nowhere");
        }
    }
    assert!(page("plugins.md").contains("{#stability-test-force-closure}"));
}
