//! House rules that the compiler does not know: who may depend on whom, how long a file may be, what a
//! library may not do.

#[path = "tidy/cycles.rs"]
mod cycles;

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Which packages of this project a package may use directly; `ARCHITECTURE.md` says why.
const ARROWS: &[(&str, &[&str])] = &[
    ("regrasp-api", &[]),
    ("regrasp-formats", &["regrasp-api"]),
    ("regrasp-world", &["regrasp-api"]),
    ("regrasp-hands", &["regrasp-api", "regrasp-formats", "regrasp-world"]),
    ("regrasp-plan", &["regrasp-api"]),
    ("regrasp-fingerprint", &[]),
    ("regrasp-abi", &["regrasp-api"]),
    ("regrasp-host", &["regrasp-abi", "regrasp-api"]),
    ("regrasp-planner", &["regrasp-abi", "regrasp-api", "regrasp-plan"]),
    ("regrasp-verify", &["regrasp-api", "regrasp-plan"]),
    ("regrasp-view", &["regrasp-api", "regrasp-plan", "regrasp-world"]),
    ("regrasp-audit", &["regrasp-api"]),
    ("regrasp-example-plugins", &["regrasp-api"]),
    ("regrasp-conformance", &["regrasp-api", "regrasp-audit", "regrasp-planner", "regrasp-world"]),
    ("regrasp-export", &["regrasp-api", "regrasp-physics", "regrasp-plan", "regrasp-world"]),
    (
        "regrasp-grasps",
        &[
            "regrasp-api",
            "regrasp-export",
            "regrasp-physics",
            "regrasp-plan",
            "regrasp-planner",
            "regrasp-run",
            "regrasp-verify",
            "regrasp-world",
        ],
    ),
    ("regrasp-physics", &["regrasp-api", "regrasp-world"]),
    (
        "regrasp-atlas",
        &[
            "regrasp-api",
            "regrasp-grasps",
            "regrasp-host",
            "regrasp-plan",
            "regrasp-planner",
            "regrasp-run",
            "regrasp-study",
        ],
    ),
    (
        "regrasp-suite",
        &[
            "regrasp-api",
            "regrasp-atlas",
            "regrasp-host",
            "regrasp-plan",
            "regrasp-planner",
            "regrasp-run",
            "regrasp-study",
        ],
    ),
    ("regrasp-roadmap", &["regrasp-api", "regrasp-plan", "regrasp-planner", "regrasp-run"]),
    (
        "regrasp-run",
        &[
            "regrasp-abi",
            "regrasp-api",
            "regrasp-audit",
            "regrasp-formats",
            "regrasp-hands",
            "regrasp-host",
            "regrasp-physics",
            "regrasp-plan",
            "regrasp-planner",
            "regrasp-verify",
            "regrasp-world",
        ],
    ),
];

/// Packages that may use everything but the command line.
const FREE: &[&str] = &["regrasp-study", "regrasp"];

/// The plugins that the book builds: crates as a reader writes them, with the rules of all plugins.
const TUTORIALS: &str = "book/tutorials";

/// Heavy or opinionated packages, and the only ones of ours that may use them directly.
const PRIVATE: &[(&str, &[&str])] = &[
    ("parry3d-f64", &["regrasp-world", "regrasp-verify"]),
    ("clarabel", &["regrasp-verify", "regrasp-stability-tests", "regrasp-physics"]),
    ("rayon", &["regrasp-planner"]),
    ("libloading", &["regrasp-host"]),
    ("object", &["regrasp-host"]),
    ("inventory", &["regrasp-api", "regrasp-host", "plugins"]),
    ("toml", &["regrasp-run", "regrasp"]),
    ("clap", &["regrasp"]),
    ("rapier3d-f64", &["regrasp-physics"]),
    ("faer", &["regrasp-surfaces"]),
    ("proc-macro2", &["regrasp-fingerprint"]),
    ("rand", &[]),
];

/// The most lines of a Rust file.
const MAX_LINES: usize = 400;

/// Files that may be longer, each with its reason.
const LONGER: &[(&str, &str)] = &[];

/// What a library may not touch: output, environment, wall clock, global random state.
const FORBIDDEN: &[&str] =
    &["println!", "print!(", "dbg!", "std::env", "env::var", "SystemTime", "Instant::now", "thread_rng"];

/// Files that only speak of what is forbidden, each with its reason.
const SPEAKS_OF: &[(&str, &str)] = &[(
    "framework/conformance/src/silence.rs",
    "starts a test again in a child process, to hear whether a plugin prints",
)];

struct Package {
    name: String,
    is_plugin: bool,
    uses: BTreeSet<String>,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn packages() -> Vec<Package> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs, since it runs this test");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo writes JSON");
    let packages = metadata["packages"].as_array().expect("a list of packages");
    packages.iter().map(package).collect()
}

fn package(value: &Value) -> Package {
    let text = |value: &Value| value.as_str().expect("a text").to_owned();
    let manifest = PathBuf::from(text(&value["manifest_path"]));
    let dependencies = value["dependencies"].as_array().expect("a list of dependencies");
    // Only normal dependencies count: `kind` is null for them.
    let normal = dependencies.iter().filter(|dependency| dependency["kind"].is_null());
    Package {
        name: text(&value["name"]),
        is_plugin: manifest.starts_with(root().join("plugins"))
            || manifest.starts_with(root().join(TUTORIALS))
            || manifest.starts_with(root().join("examples/plugins")),
        uses: normal.map(|dependency| text(&dependency["name"])).collect(),
    }
}

/// The packages of ours that `package` may use; `None` for all.
fn allowed(package: &Package) -> Option<BTreeSet<&'static str>> {
    if FREE.contains(&package.name.as_str()) {
        return None;
    }
    // What it damages is read as the program reads it.
    if package.name == "regrasp-fuzz" {
        return Some(["regrasp"].into());
    }
    // A dynamic shim exports one crate of plugins and does nothing else.
    if package.name == "regrasp-template-dynamic" {
        return Some(["regrasp-abi", "regrasp-template"].into());
    }
    if package.name == "regrasp-local-planners" {
        // `rapier-checked` simulates.
        return Some(["regrasp-api", "regrasp-physics"].into());
    }
    if package.name == "regrasp-stability-tests" {
        // `holding` asks for the forces that exports and replays use.
        return Some(["regrasp-api", "regrasp-physics"].into());
    }
    if package.is_plugin {
        return Some(["regrasp-api"].into());
    }
    let arrows: BTreeMap<_, _> = ARROWS.iter().copied().collect();
    let uses = arrows.get(package.name.as_str());
    let uses = uses.unwrap_or_else(|| panic!("`{}` is new: add its arrows to tests/tidy.rs", package.name));
    Some(uses.iter().copied().collect())
}

#[test]
fn packages_use_only_what_their_arrows_allow() {
    let packages = packages();
    assert!(packages.len() > 13, "metadata of the whole workspace");
    for package in &packages {
        let ours = package.uses.iter().filter(|name| name.starts_with("regrasp"));
        let Some(allowed) = allowed(package) else {
            assert!(ours.clone().all(|name| name != "regrasp"), "`{}` uses the command line", package.name);
            continue;
        };
        let wrong: Vec<&String> = ours.filter(|name| !allowed.contains(name.as_str())).collect();
        assert!(wrong.is_empty(), "`{}` may not use {wrong:?} (see ARCHITECTURE.md)", package.name);
    }
}

#[test]
fn heavy_dependencies_stay_where_they_are_needed() {
    for package in packages() {
        for (heavy, users) in PRIVATE {
            let may =
                users.contains(&package.name.as_str()) || package.is_plugin && users.contains(&"plugins");
            assert!(may || !package.uses.contains(*heavy), "`{}` may not use `{heavy}`", package.name);
        }
    }
}

/// Every Rust file of the project, relative to its root.
fn rust_files() -> Vec<PathBuf> {
    let mut files = Vec::new();
    let rooms = ["benches", TUTORIALS, "examples", "framework", "plugins", "src", "tests"];
    rooms
        .iter()
        .map(|room| root().join(room))
        .filter(|room| room.is_dir())
        .for_each(|room| walk(&room, &mut files));
    files.sort();
    files
}

fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the project's folders can be read") {
        let path = entry.expect("the project's folders can be read").path();
        if path.is_dir() && !path.ends_with("target") {
            walk(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path.strip_prefix(root()).expect("below the root").to_owned());
        }
    }
}

fn read(file: &Path) -> String {
    fs::read_to_string(root().join(file)).expect("the project's files are UTF-8")
}

#[test]
fn files_hold_one_idea_each() {
    let files = rust_files();
    assert!(files.len() > 60, "only {} files were found", files.len());
    let lines = |file: &PathBuf| read(file).lines().count();
    let excused = |file: &PathBuf| LONGER.iter().any(|(name, _)| Path::new(name) == file);
    let long: Vec<String> = files
        .iter()
        .filter(|file| !excused(file) && lines(file) > MAX_LINES)
        .map(|file| format!("{} ({} lines)", file.display(), lines(file)))
        .collect();
    assert!(long.is_empty(), "more than {MAX_LINES} lines: {}", long.join(", "));
}

#[test]
fn the_list_of_longer_files_is_not_out_of_date() {
    for (name, reason) in LONGER {
        let lines = read(Path::new(name)).lines().count();
        assert!(lines > MAX_LINES, "{name} has {lines} lines and needs no excuse ({reason})");
    }
}

/// The part of a library's file that is not its tests.
fn library_code(file: &Path) -> Option<String> {
    let parts: Vec<&str> = file.iter().filter_map(|part| part.to_str()).collect();
    let room = if file.starts_with(TUTORIALS) { 3 } else { 2 };
    let is_library =
        matches!(parts.first(), Some(&"framework" | &"plugins" | &"book")) && parts.get(room) == Some(&"src");
    let is_test = parts.iter().any(|part| ["tests", "tests.rs", "test_plugins.rs"].contains(part));
    let text = (is_library && !is_test).then(|| read(file))?;
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    Some(lines.collect::<Vec<_>>().join("\n"))
}

#[test]
fn libraries_print_nothing_and_own_no_clock_environment_or_random_state() {
    let speaks_of = |file: &PathBuf| SPEAKS_OF.iter().any(|(name, _)| Path::new(name) == file);
    let files: Vec<PathBuf> = rust_files().into_iter().filter(|file| !speaks_of(file)).collect();
    let code: Vec<(&PathBuf, String)> =
        files.iter().filter_map(|file| Some((file, library_code(file)?))).collect();
    assert!(code.len() > 40, "only {} library files were found", code.len());
    let uses = |(file, code): &(&PathBuf, String)| {
        let word = FORBIDDEN.iter().find(|word| code.contains(**word))?;
        Some(format!("{} contains `{word}`", file.display()))
    };
    let wrong: Vec<String> = code.iter().filter_map(uses).collect();
    assert!(wrong.is_empty(), "{}", wrong.join(", "));
}

#[test]
fn the_planner_names_no_plugin() {
    let ids = ["pcwf", "force-closure", "rlg", "interleaved", "geodesic\"", "local-planner/"];
    for file in rust_files().into_iter().filter(|file| file.starts_with("framework/planner/src")) {
        let Some(code) = library_code(&file) else { continue };
        for id in ids {
            assert!(!code.contains(id), "{} names the plugin `{id}`", file.display());
        }
    }
}

#[test]
fn no_file_sets_a_target_cpu() {
    // rustc 1.95 (LLVM 22) miscompiles plain f64 code at opt-level 3 with AVX2 (see `tests/compiler.rs`).
    for file in ["Cargo.toml", ".cargo/config.toml", ".cargo/config", ".ci/run"] {
        let text = fs::read_to_string(root().join(file)).unwrap_or_default();
        assert!(!text.contains("target-cpu"), "{file} sets a target-cpu");
    }
}

/// The form of the whole command line names every subcommand's; completions, manual and reference are made of
/// the whole: the one circle that is left.
const ENTRANCE: &str = "args.rs";

#[test]
fn no_files_use_each_other_in_a_circle() {
    let rooms = ["framework", "plugins", TUTORIALS];
    let crates = rooms.iter().flat_map(|room| fs::read_dir(root().join(room)).expect("a folder"));
    let sources = crates.map(|entry| entry.expect("a folder").path().join("src"));
    let sources: Vec<PathBuf> = sources.filter(|src| src.is_dir()).chain([root().join("src")]).collect();
    assert!(sources.len() > 20, "only {} crates were found", sources.len());
    for src in sources {
        let mut circles = cycles::cycles(&src);
        circles.retain(|files| src != root().join("src") || !files.iter().any(|file| file == ENTRANCE));
        assert!(circles.is_empty(), "{}: {circles:?}; name the room that they share", src.display());
    }
}

#[test]
fn circles_are_found_also_through_re_exports() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write =
        |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("it can be written");
    write("lib.rs", "mod a;\nmod b;\npub use a::*;\npub use b::Two;\n");
    write("a.rs", "use crate::Two;\npub struct One(Two);\n");
    write("b.rs", "pub struct Two;\n");
    assert!(cycles::cycles(folder.path()).is_empty());
    write("b.rs", "pub struct Two;\npub fn two(_: crate::One) {}\n");
    assert_eq!(cycles::cycles(folder.path()), [["a.rs", "b.rs"]]);
}

/// The most columns of a line.
const MAX_WIDTH: usize = 110;

#[test]
fn lines_are_no_wider_than_a_screen() {
    // A text that must stand in one line is excused: it has no blank to break at.
    let can_break = |line: &str| line.trim().trim_start_matches(['/', '!', ' ', '"']).contains(' ');
    let wide = |file: &PathBuf| {
        let text = read(file);
        let wide = text.lines().position(|line| line.chars().count() > MAX_WIDTH && can_break(line))?;
        Some(format!("{}:{}", file.display(), wide + 1))
    };
    let all: Vec<String> = rust_files().iter().filter_map(wide).collect();
    assert!(all.len() <= WIDE_FILES, "wider than {MAX_WIDTH} columns: {}", all.join(", "));
}

/// How many files still have wider lines; only ever made smaller.
const WIDE_FILES: usize = 39;

#[test]
fn public_functions_of_libraries_return_errors_with_fields() {
    for file in rust_files() {
        let Some(code) = library_code(&file) else { continue };
        let code = code.split_whitespace().collect::<Vec<_>>().join(" ");
        for signature in code.split("pub fn ").skip(1) {
            let head = signature.split(['{', ';']).next().unwrap_or_default();
            assert!(!head.contains(", String>") || !head.contains("Result<"), "{}: {head}", file.display());
        }
    }
}
