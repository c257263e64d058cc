//! The chapters: their code comes from files that compile, and every piece that they name exists.

use crate::TUTORIALS;
use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("book/src/tutorials")
}

/// The chapters: file and text.
fn chapters() -> Vec<(PathBuf, String)> {
    let entries = fs::read_dir(folder()).expect("the book has tutorials");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    files.into_iter().map(|file| (file.clone(), fs::read_to_string(&file).expect("UTF-8"))).collect()
}

/// The pieces that a chapter lists, as `path:anchor`.
fn included(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.strip_prefix(LISTING)?.strip_suffix(" -->"))
}

/// Before a block that is a piece of a file; that it is the same is the book's test.
const LISTING: &str = "<!-- listing: ";

/// Lines of a piece; none where there is no such piece.
fn lines(piece: &str) -> usize {
    let (file, anchor) = piece.split_once(':').unwrap_or((piece, ""));
    let Ok(text) = fs::read_to_string(folder().join(file)) else { return 0 };
    if anchor.is_empty() {
        return text.lines().count();
    }
    let is_mark =
        |line: &str, mark: &str| line.trim().strip_prefix("// ") == Some(&format!("{mark}: {anchor}"));
    let mut inside = text.lines().skip_while(|line| !is_mark(line, "ANCHOR")).skip(1);
    let count = inside.by_ref().take_while(|line| !is_mark(line, "ANCHOR_END")).count();
    // Without its end a piece would run to the end of the file.
    if text.lines().any(|line| is_mark(line, "ANCHOR_END")) { count } else { 0 }
}

#[test]
fn every_piece_of_code_that_a_chapter_includes_exists() {
    let all = chapters();
    let pieces: Vec<(&Path, &str)> =
        all.iter().flat_map(|(file, text)| included(text).map(|piece| (file.as_path(), piece))).collect();
    assert!(pieces.len() > 4 * TUTORIALS.len(), "only {} pieces were found", pieces.len());
    let missing: Vec<_> = pieces.iter().filter(|(_, piece)| lines(piece) == 0).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn no_rust_is_typed_into_a_chapter() {
    for (file, text) in chapters() {
        let lines: Vec<&str> = text.lines().collect();
        let typed =
            lines.windows(2).find(|pair| pair[1].starts_with("```rust") && !pair[0].starts_with(LISTING));
        assert_eq!(typed, None, "{}", file.display());
    }
}

#[test]
fn every_tutorial_shows_all_of_its_plugin() {
    let all: String = chapters().into_iter().map(|(_, text)| text).collect();
    for (role, name, _) in TUTORIALS {
        let sources = format!("../../tutorials/{name}-{role}/src");
        for entry in fs::read_dir(folder().join(&sources)).expect("the tutorial has a crate") {
            let entry = entry.expect("an entry");
            let file = format!("{sources}/{}", entry.file_name().to_string_lossy());
            let text = fs::read_to_string(entry.path()).expect("UTF-8");
            let anchors = text.lines().filter_map(|line| line.trim().strip_prefix("// ANCHOR: "));
            let hidden: Vec<&str> =
                anchors.filter(|anchor| !all.contains(&format!("{LISTING}{file}:{anchor} -->"))).collect();
            assert!(hidden.is_empty(), "{file}: no chapter shows {hidden:?}");
            assert_eq!(outside_of_anchors(&text), Vec::<&str>::new(), "{file}: no chapter can show this");
        }
    }
}

/// Lines of code that belong to no piece; what the file says of itself at its head aside.
fn outside_of_anchors(text: &str) -> Vec<&str> {
    let (mut inside, mut outside) = (false, Vec::new());
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//!")) {
        match line.strip_prefix("// ANCHOR") {
            Some(mark) => inside = mark.starts_with(':'),
            None if !inside => outside.push(line),
            None => {}
        }
    }
    outside
}
