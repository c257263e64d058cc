//! A checkout's book and documents, and what is wrong with them.

use crate::markdown::{Listing, Page};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Where the book's pages are, from the root.
const BOOK: &str = "book/src";

/// The pages of the book and the documents beside it.
pub struct Tree {
    root: PathBuf,
    /// By their paths from the root.
    pub pages: BTreeMap<PathBuf, Page>,
    /// What else lies among the book's pages.
    others: BTreeSet<PathBuf>,
}

impl Tree {
    /// Reads the book below `root` and these documents; a document that is not there panics.
    pub fn read(root: &Path, documents: &[&str]) -> Self {
        let mut files = documents.iter().map(PathBuf::from).collect();
        walk(root, Path::new(BOOK), &mut files);
        let (pages, others): (Vec<_>, Vec<_>) =
            files.into_iter().partition(|file: &PathBuf| file.extension().is_some_and(|end| end == "md"));
        let read = |file: PathBuf| {
            let text = fs::read_to_string(root.join(&file))
                .unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            (file, Page::read(&text))
        };
        Self {
            root: root.into(),
            pages: pages.into_iter().map(read).collect(),
            others: others.into_iter().collect(),
        }
    }

    /// Everything that is wrong, one line each, with its place.
    pub fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let mut reached = BTreeSet::new();
        for (file, page) in &self.pages {
            for (line, link) in &page.links {
                match self.follow(file, link) {
                    Ok(target) => reached.extend(target),
                    Err(fault) => faults.push(format!("{}:{line}: {fault}", file.display())),
                }
            }
            let included = page.includes.iter().map(|(line, target)| {
                format!("{}:{line}: `{target}` is shown by mdBook alone; make it a listing", file.display())
            });
            faults.extend(included);
            let listed = page.listings.iter().map(|listing| (listing.line, self.listing(file, listing)));
            faults.extend(
                listed.filter_map(|(line, fault)| Some(format!("{}:{line}: {}", file.display(), fault?))),
            );
        }
        let unused = self.others.iter().filter(|file| !reached.contains(*file));
        faults.extend(unused.map(|file| format!("{}: no page uses it", file.display())));
        faults.extend(self.contents());
        faults
    }

    /// The file that a link leads to; `None` where it leads out into the world or stays on its page.
    fn follow(&self, from: &Path, link: &str) -> Result<Option<PathBuf>, String> {
        if link.starts_with("https://") || link.starts_with("http://") || link.starts_with("mailto:") {
            return Ok(None);
        }
        let (path, anchor) = link.split_once('#').map_or((link, None), |(path, anchor)| (path, Some(anchor)));
        let target = match path {
            "" => from.to_owned(),
            _ => tidy(&from.with_file_name("").join(path))
                .ok_or(format!("`{link}` leads out of the project"))?,
        };
        if from.starts_with(BOOK) && !target.starts_with(BOOK) {
            return Err(format!("`{link}` leads out of the book, which is published alone"));
        }
        if !self.root.join(&target).exists() {
            return Err(format!("`{link}`: there is no {}", target.display()));
        }
        if let Some(anchor) = anchor {
            let page =
                self.pages.get(&target).ok_or(format!("`{link}`: {} is not a page", target.display()))?;
            if !page.anchors.contains(anchor) {
                return Err(format!("`{link}`: {} has no heading `{anchor}`", target.display()));
            }
        }
        Ok(Some(target))
    }

    /// What is wrong with a listing.
    fn listing(&self, from: &Path, listing: &Listing) -> Option<String> {
        let target = listing.target.as_str();
        let (path, part) = target.split_once(':').unwrap_or((target, ""));
        let file = tidy(&from.with_file_name("").join(path));
        let Some(text) = file.and_then(|file| fs::read_to_string(self.root.join(file)).ok()) else {
            return Some(format!("`{target}` is listed, but there is no such file"));
        };
        let is_range = part.split(':').all(|number| number.is_empty() || number.parse::<usize>().is_ok());
        let marked = |mark: &str| {
            text.lines().any(|line| line.split_once(mark).is_some_and(|(_, name)| name.trim() == part))
        };
        let found = is_range || marked("ANCHOR:") && marked("ANCHOR_END:");
        if !found {
            return Some(format!("`{target}` is listed, but {path} has no `ANCHOR: {part}` with its end"));
        }
        (listing.text != piece(&text, part)).then(|| {
            format!(
                "`{target}` is listed as it was; `cargo run -- reference book/src/reference` lists it anew"
            )
        })
    }

    /// Pages that the table of contents forgets, or names twice.
    fn contents(&self) -> Vec<String> {
        let summary = Path::new(BOOK).join("SUMMARY.md");
        let Some(contents) = self.pages.get(&summary) else {
            return vec!["the book has no SUMMARY.md".into()];
        };
        let mut named = BTreeMap::<PathBuf, usize>::new();
        for (_, link) in &contents.links {
            *named.entry(tidy(&summary.with_file_name(link)).unwrap_or_default()).or_default() += 1;
        }
        let pages = self.pages.keys().filter(|page| page.starts_with(BOOK) && **page != summary);
        let forgotten = pages.filter(|page| !named.contains_key(*page));
        let twice = named.iter().filter(|(_, count)| **count > 1);
        // mdBook copies the first page to index.html as it is: from deeper down its links would miss.
        let first = contents.links.first().filter(|(_, link)| link.contains('/'));
        let first = first.map(|(_, link)| format!("{link}: the first page must lie beside SUMMARY.md"));
        let forgotten = forgotten.map(|page| format!("{}: not in SUMMARY.md", page.display()));
        let twice = twice.map(|(page, _)| format!("{}: twice in SUMMARY.md", page.display()));
        first.into_iter().chain(forgotten).chain(twice).collect()
    }
}

/// A path without `.` and `..`; `None` where it leads above its beginning.
fn tidy(path: &Path) -> Option<PathBuf> {
    let mut tidied = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if tidied.pop() => {}
            Component::Normal(name) => tidied.push(name),
            _ => return None,
        }
    }
    Some(tidied)
}

fn walk(root: &Path, folder: &Path, files: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(root.join(folder)).expect("the book's folders can be read");
    for entry in entries {
        let name = entry.expect("the book's folders can be read").file_name();
        let path = folder.join(name);
        if root.join(&path).is_dir() {
            walk(root, &path, files);
        } else {
            files.push(path);
        }
    }
}

/// The lines of a piece of a file, without the marks of anchors: all where `part` is empty, of an anchor, or
/// of a range of lines counted from 1.
fn piece(text: &str, part: &str) -> String {
    let is_mark = |line: &str| line.contains("ANCHOR:") || line.contains("ANCHOR_END:");
    let ends = |line: &str, mark: &str| line.split_once(mark).is_some_and(|(_, name)| name.trim() == part);
    let lines: Vec<&str> = text.lines().collect();
    let number = |text: &str| text.parse::<usize>().ok();
    let (from, to) = match part.split_once(':') {
        _ if part.is_empty() => (0, lines.len()),
        Some((from, to)) => (number(from).map_or(0, |from| from - 1), number(to).unwrap_or(lines.len())),
        None => match number(part) {
            Some(line) => (line - 1, line),
            None => {
                let at = |mark: &str| lines.iter().position(|line| ends(line, mark)).unwrap_or(0);
                (at("ANCHOR:") + 1, at("ANCHOR_END:"))
            }
        },
    };
    let shown = lines.get(from..to).unwrap_or_default().iter().filter(|line| !is_mark(line));
    shown.map(|line| format!("{line}\n")).collect()
}
