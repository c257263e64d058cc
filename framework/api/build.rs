//! Tells `regrasp-abi` what only this crate's build knows: a hash of its sources, its features, nalgebra's
//! version.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    let folder = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    println!("cargo::metadata=sources={}", regrasp_fingerprint::of_sources(&folder.join("src")));
    println!("cargo::metadata=features={}", features());
    println!("cargo::metadata=nalgebra={}", nalgebra(&folder));
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src");
}

/// Features that change nothing of what crosses a library's border: a plugin may have them where the program
/// has not.
const HARMLESS: &[&str] = &["rand_core"];

fn features() -> String {
    let names = env::vars().filter_map(|(name, _)| Some(name.strip_prefix("CARGO_FEATURE_")?.to_lowercase()));
    let mut names: Vec<String> = names.filter(|name| !HARMLESS.contains(&name.as_str())).collect();
    names.sort();
    if names.is_empty() { "none".into() } else { names.join(",") }
}

/// The exact version of nalgebra: its types are part of the contract, so the manifest pins it with `=`.
fn nalgebra(folder: &Path) -> String {
    let pinned = folder.ancestors().find_map(|folder| {
        let manifest = folder.join("Cargo.toml");
        let version = pinned(&fs::read_to_string(&manifest).ok()?)?;
        println!("cargo::rerun-if-changed={}", manifest.display());
        Some(version)
    });
    pinned.expect("a manifest at or above this crate pins nalgebra with `=`")
}

/// The version in `nalgebra = { version = "=1.2.3", … }`, or in the table that cargo makes of it for a
/// package.
fn pinned(manifest: &str) -> Option<String> {
    let mut lines = manifest.lines().map(str::trim);
    while let Some(line) = lines.next() {
        let here = line.starts_with("nalgebra").then_some(line).and_then(exact);
        let below =
            || (line == "[dependencies.nalgebra]").then(|| lines.clone().take(3).find_map(exact)).flatten();
        if let Some(version) = here.or_else(below) {
            return Some(version);
        }
    }
    None
}

/// `1.2.3` of a line that has `"=1.2.3"` in it.
fn exact(line: &str) -> Option<String> {
    Some(line.split_once("\"=")?.1.split_once('"')?.0.trim().to_owned())
}
