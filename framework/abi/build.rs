//! Writes the part of the fingerprint that only a build script can know: sources, compiler, target.

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    let folder = PathBuf::from(variable("CARGO_MANIFEST_DIR"));
    let text = [
        ("api sources", variable("DEP_REGRASP_API_SOURCES")),
        ("abi sources", regrasp_fingerprint::of_sources(&folder.join("src"))),
        ("api features", variable("DEP_REGRASP_API_FEATURES")),
        ("nalgebra", variable("DEP_REGRASP_API_NALGEBRA")),
        ("compiler", compiler("release")),
        ("compiler commit", compiler("commit-hash")),
        ("target", variable("TARGET")),
        ("cpu features", sorted(&env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default())),
    ];
    let lines: String = text.iter().map(|(key, value)| format!("{key}: {value}\n")).collect();
    let output = Path::new(&variable("OUT_DIR")).join("fingerprint.txt");
    fs::write(output, lines).expect("cargo's own output folder can be written to");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src");
}

fn variable(name: &str) -> String {
    env::var(name).unwrap_or_else(|_| panic!("cargo sets {name}"))
}

fn sorted(list: &str) -> String {
    let words: BTreeSet<&str> = list.split(',').filter(|word| !word.is_empty()).collect();
    if words.is_empty() { "none".into() } else { words.into_iter().collect::<Vec<_>>().join(",") }
}

/// One line of what the compiler says about itself.
fn compiler(key: &str) -> String {
    let output =
        Command::new(variable("RUSTC")).arg("-vV").output().expect("cargo names a compiler that runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let value = text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(": "));
    value.unwrap_or("unknown").to_owned()
}
