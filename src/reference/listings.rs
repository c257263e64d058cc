//! The listings of the book's pages: blocks that a comment says to be pieces of files, as
//! `<!-- listing: ../code.rs:anchor -->`, so that a page reads the same on any forge.

use crate::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// Every page below a folder whose listings are not what their files have: its path and its text with them.
pub fn stale(folder: &Path) -> Result<Vec<(PathBuf, String)>, Failure> {
    let mut pages = Vec::new();
    find(folder, &mut pages)?;
    pages.sort();
    let mut stale = Vec::new();
    for page in pages {
        let text = read(&page)?;
        let listed = listed(&text, &page)?;
        if listed != text {
            stale.push((page, listed));
        }
    }
    Ok(stale)
}

fn read(path: &Path) -> Result<String, Failure> {
    fs::read_to_string(path).map_err(|error| Failure::bad_input(format!("`{}`: {error}", path.display())))
}

fn find(folder: &Path, pages: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let failed = |error| Failure::bad_input(format!("`{}`: {error}", folder.display()));
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() {
            find(&path, pages)?;
        } else if path.extension().is_some_and(|extension| extension == "md") {
            pages.push(path);
        }
    }
    Ok(())
}

/// The page with its listings made anew.
fn listed(text: &str, page: &Path) -> Result<String, Failure> {
    let mut lines = text.split_inclusive('\n');
    let mut made = String::with_capacity(text.len());
    while let Some(line) = lines.next() {
        made += line;
        let mark = line.trim_end().strip_prefix("<!-- listing: ");
        let Some(target) = mark.and_then(|rest| rest.strip_suffix(" -->")) else { continue };
        made += lines.next().unwrap_or_default();
        made += &piece(target, page)?;
        made += lines.by_ref().find(|line| line.trim_end() == "```").unwrap_or("```\n");
    }
    Ok(made)
}

/// The piece that `file`, `file:anchor` or `file:from:to` names, without the marks of anchors.
fn piece(target: &str, page: &Path) -> Result<String, Failure> {
    let (file, part) = target.split_once(':').unwrap_or((target, ""));
    let text = read(&page.with_file_name(file))?;
    let lines: Vec<&str> = text.lines().collect();
    let ends = |line: &str, mark: &str| line.split_once(mark).is_some_and(|(_, name)| name.trim() == part);
    let at = |mark: &str| lines.iter().position(|line| ends(line, mark));
    let range = match part.split_once(':') {
        Some((from, to)) => {
            Some((from.parse().map_or(0, |from: usize| from.max(1) - 1), to.parse().unwrap_or(lines.len())))
        }
        None if part.is_empty() => Some((0, lines.len())),
        None => at("ANCHOR:").map(|start| start + 1).zip(at("ANCHOR_END:")),
    };
    let shown = range.and_then(|(from, to)| lines.get(from..to)).ok_or_else(|| {
        Failure::bad_input(format!("`{}` lists `{target}`, which is not there", page.display()))
    })?;
    let is_mark = |line: &&&str| line.contains("ANCHOR:") || line.contains("ANCHOR_END:");
    Ok(shown.iter().filter(|line| !is_mark(line)).map(|line| format!("{line}\n")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn listings_follow_their_files() {
        let folder = tempfile::tempdir().unwrap();
        let (page, code) = (folder.path().join("a/page.md"), folder.path().join("code.rs"));
        fs::create_dir(folder.path().join("a")).unwrap();
        fs::write(&code, "one\n// ANCHOR: b\ntwo\n// ANCHOR_END: b\nthree\n").unwrap();
        let text = |two: &str, all: &str| {
            format!(
                "# Page\n\n<!-- listing: ../code.rs:b -->\n```rust\n{two}```\n\n<!-- listing: ../code.rs:3: \
                 -->\n```\n{all}```\nrest\n"
            )
        };
        fs::write(&page, text("old\n\n", "")).unwrap();
        let fresh = text("two\n", "two\nthree\n");
        assert_eq!(stale(folder.path()).unwrap(), [(page.clone(), fresh.clone())]);
        fs::write(&page, fresh).unwrap();
        assert!(stale(folder.path()).unwrap().is_empty());
        fs::write(&code, "one\n").unwrap();
        assert!(stale(folder.path()).unwrap_err().message().contains("`../code.rs:b`"));
    }
}
