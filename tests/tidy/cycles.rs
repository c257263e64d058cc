//! Which files of a crate use each other in a circle.
//!
//! A file uses another one where a path in it (`use` or in place) leads to an item that the other defines,
//! re-exports followed. What a file takes from the file of a folder that it lies in is no circle: the two are
//! one room.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

type Module = Vec<String>;

/// One file of a crate.
struct Source {
    name: String,
    /// What it defines.
    items: BTreeSet<String>,
    /// What its `use` declarations name, and whether they hand it on.
    uses: Vec<(bool, Module)>,
    /// The paths in its code.
    paths: Vec<Module>,
}

struct Sources(BTreeMap<Module, Source>);

/// The files of the crate with this source folder that use each other in a circle.
pub fn cycles(src: &Path) -> Vec<Vec<String>> {
    let sources = Sources::read(src);
    let edges: BTreeMap<&Module, BTreeSet<Module>> =
        sources.0.keys().map(|module| (module, sources.used_by(module))).collect();
    let reach: BTreeMap<&Module, BTreeSet<&Module>> =
        edges.keys().map(|&module| (module, reached(module, &edges))).collect();
    let circle = |module: &&Module| -> Vec<String> {
        let back = reach[*module].iter().filter(|&&other| reach[other].contains(*module));
        back.map(|&other| sources.0[other].name.clone()).collect()
    };
    let circles: BTreeSet<Vec<String>> = reach.keys().map(circle).filter(|files| files.len() > 1).collect();
    circles.into_iter().collect()
}

/// What can be reached from a module, itself only in a circle.
fn reached<'a>(from: &Module, edges: &'a BTreeMap<&Module, BTreeSet<Module>>) -> BTreeSet<&'a Module> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&Module> = edges[from].iter().collect();
    while let Some(module) = open.pop() {
        if found.insert(module) {
            open.extend(&edges[module]);
        }
    }
    found
}

impl Sources {
    fn read(src: &Path) -> Self {
        let mut files = Vec::new();
        list(src, &mut files);
        let read = |file: PathBuf| {
            let name = file.strip_prefix(src).expect("below the folder").to_string_lossy().replace('\\', "/");
            let text = fs::read_to_string(&file).expect("sources are UTF-8");
            (module_of(&name), Source::new(name, &text))
        };
        Self(files.into_iter().map(read).collect())
    }

    /// The modules whose items a module uses; not itself, and not the folders that it lies in.
    fn used_by(&self, module: &Module) -> BTreeSet<Module> {
        let source = &self.0[module];
        let own = source.uses.iter().filter(|(handed_on, _)| !handed_on).map(|(_, path)| path);
        let mut used = BTreeSet::new();
        own.chain(&source.paths).for_each(|path| self.resolve(module, path, &mut BTreeSet::new(), &mut used));
        used.retain(|other| !module.starts_with(other));
        used
    }

    /// Adds the modules that define what `path`, written in `module`, names.
    fn resolve(
        &self,
        module: &[String],
        path: &[String],
        seen: &mut BTreeSet<(Module, String)>,
        found: &mut BTreeSet<Module>,
    ) {
        let Some((place, rest)) = self.walk(module, path) else { return };
        let Some(source) = self.0.get(&place) else { return };
        let Some(name) = rest.first().filter(|name| *name != "*" && *name != "self") else {
            found.insert(place);
            return;
        };
        if source.items.contains(name) {
            found.insert(place);
        } else if seen.insert((place.clone(), name.clone())) {
            for (_, used) in &source.uses {
                match used.split_last() {
                    Some((last, _)) if last == name => self.resolve(&place, used, seen, found),
                    Some((last, head)) if last == "*" => {
                        self.resolve(&place, &[head, std::slice::from_ref(name)].concat(), seen, found);
                    }
                    _ => {}
                }
            }
        }
    }

    /// The module that a path leads to, and what is left of the path there; `None` for other crates.
    fn walk<'p>(&self, module: &[String], path: &'p [String]) -> Option<(Module, &'p [String])> {
        let mut place = module.to_vec();
        let mut rest = path;
        match path.first()?.as_str() {
            "crate" => (place, rest) = (Vec::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {
                while rest.first().is_some_and(|word| word == "super") {
                    place.pop();
                    rest = &rest[1..];
                }
            }
            child => {
                place.push(child.to_owned());
                self.0.get(&place)?;
                rest = &path[1..];
            }
        }
        while let Some(word) = rest.first() {
            place.push(word.clone());
            if !self.0.contains_key(&place) {
                place.pop();
                break;
            }
            rest = &rest[1..];
        }
        Some((place, rest))
    }
}

impl Source {
    fn new(name: String, text: &str) -> Self {
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        let code: String =
            code.lines().map(|line| line.split("//").next().unwrap_or_default().to_owned() + "\n").collect();
        let (mut uses, mut rest) = (Vec::new(), String::new());
        let mut statement: Option<(bool, String)> = None;
        for line in code.lines() {
            let start = ["use ", "pub use ", "pub(crate) use ", "pub(super) use "];
            let begun = start.iter().find_map(|start| Some((start, line.trim_start().strip_prefix(*start)?)));
            match (&mut statement, begun) {
                (None, Some((start, tree))) => statement = Some((start.starts_with("pub"), tree.to_owned())),
                (None, None) => rest += &format!("{line}\n"),
                (Some((_, tree)), _) => *tree += line,
            }
            if statement.as_ref().is_some_and(|(_, tree)| tree.contains(';')) {
                let (handed_on, tree) = statement.take().expect("it is there");
                let leaves = expand(&[], tree.trim_end().trim_end_matches(';'));
                uses.extend(leaves.into_iter().map(|leaf| (handed_on, leaf)));
            }
        }
        Self { name, items: items(&code), uses, paths: paths(&rest) }
    }
}

/// The leaves of a `use` tree.
fn expand(prefix: &[String], tree: &str) -> Vec<Module> {
    let words = |text: &str| -> Module {
        let text = text.split(" as ").next().unwrap_or_default();
        text.split("::").map(str::trim).filter(|word| !word.is_empty()).map(str::to_owned).collect()
    };
    let Some((head, body)) = tree.split_once('{') else { return vec![[prefix, &words(tree)].concat()] };
    let head = [prefix, &words(head)].concat();
    let body = body.rsplit_once('}').map_or(body, |(body, _)| body);
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for c in body.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        match (c, depth) {
            (',', 0) => parts.push(String::new()),
            _ => parts.last_mut().expect("never empty").push(c),
        }
    }
    parts.iter().filter(|part| !part.trim().is_empty()).flat_map(|part| expand(&head, part.trim())).collect()
}

/// The names after the words that define something.
fn items(code: &str) -> BTreeSet<String> {
    const WORDS: &[&str] = &["fn", "struct", "enum", "trait", "type", "const", "static", "macro_rules!"];
    let words: Vec<&str> = code.split_whitespace().collect();
    let name = |text: &str| text.split(|c: char| !is_word(c)).next().unwrap_or_default().to_owned();
    words.windows(2).filter(|pair| WORDS.contains(&pair[0])).map(|pair| name(pair[1])).collect()
}

/// Every path of at least two words.
fn paths(code: &str) -> Vec<Module> {
    let chunks = code.split(|c: char| !is_word(c) && c != ':');
    let path = |chunk: &str| -> Module {
        chunk.split("::").filter(|word| !word.is_empty() && !word.contains(':')).map(str::to_owned).collect()
    };
    chunks.filter(|chunk| chunk.contains("::")).map(path).filter(|path| path.len() > 1).collect()
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn module_of(name: &str) -> Module {
    let mut parts: Module = name.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    if parts.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
        parts.pop();
    }
    parts
}

/// Files that are no tests.
fn list(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the project's folders can be read") {
        let path = entry.expect("the project's folders can be read").path();
        let is_test = ["tests.rs", "test_plugins.rs", "fixture.rs"].iter().any(|name| path.ends_with(name));
        if path.is_dir() {
            list(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") && !is_test {
            files.push(path);
        }
    }
}
