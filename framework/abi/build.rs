//! Writes the part of the fingerprint that only a build script can know: sources, compiler, target.

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    let folder = PathBuf::from(variable("CARGO_MANIFEST_DIR"));
    let text = [
        ("api sources", sources(&folder.join("../api/src"))),
        ("abi sources", sources(&folder.join("src"))),
        ("api features", features()),
        ("nalgebra", nalgebra(&folder)),
        ("compiler", compiler("release")),
        ("compiler commit", compiler("commit-hash")),
        ("target", variable("TARGET")),
        ("cpu features", sorted(&env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default())),
    ];
    let lines: String = text.iter().map(|(key, value)| format!("{key}: {value}\n")).collect();
    let output = Path::new(&variable("OUT_DIR")).join("fingerprint.txt");
    fs::write(output, lines).expect("cargo's own output folder can be written to");
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=../api/src");
    println!("cargo:rerun-if-changed=src");
}

fn variable(name: &str) -> String {
    env::var(name).unwrap_or_else(|_| panic!("cargo sets {name}"))
}

/// A hash of every source file's path and text, in the order of the paths.
fn sources(folder: &Path) -> String {
    let mut files = Vec::new();
    walk(folder, &mut files);
    files.sort();
    assert!(!files.is_empty(), "the crate has sources");
    let mut hash = Fnv::default();
    for file in &files {
        let name =
            file.strip_prefix(folder).expect("it was found there").to_string_lossy().replace('\\', "/");
        let text = fs::read_to_string(file).expect("sources are UTF-8").replace("\r\n", "\n");
        // Lengths keep apart what would otherwise run together.
        for part in [name, text] {
            hash.write(&(part.len() as u64).to_le_bytes());
            hash.write(part.as_bytes());
        }
    }
    format!("{:032x}", hash.0)
}

fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the crate's sources can be listed") {
        let path = entry.expect("the crate's sources can be listed").path();
        if path.is_dir() {
            walk(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// FNV-1a with 128 bits (Fowler, Noll, Vo): enough to tell versions apart, no defence against malice.
struct Fnv(u128);

impl Default for Fnv {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Fnv {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }
}

fn features() -> String {
    let prefix = "CARGO_FEATURE_";
    let names = env::vars().filter_map(|(name, _)| Some(name.strip_prefix(prefix)?.to_lowercase()));
    sorted(&names.collect::<Vec<_>>().join(","))
}

fn sorted(list: &str) -> String {
    let words: BTreeSet<&str> = list.split(',').filter(|word| !word.is_empty()).collect();
    if words.is_empty() { "none".into() } else { words.into_iter().collect::<Vec<_>>().join(",") }
}

/// The exact version of nalgebra: its types are part of the contract, so the manifest pins it with `=`.
fn nalgebra(folder: &Path) -> String {
    let pinned = folder.ancestors().find_map(|folder| {
        let manifest = folder.join("Cargo.toml");
        let text = fs::read_to_string(&manifest).ok()?;
        let version =
            text.lines().filter(|line| line.trim_start().starts_with("nalgebra")).find_map(exact)?;
        println!("cargo:rerun-if-changed={}", manifest.display());
        Some(version)
    });
    pinned.expect("a manifest at or above this crate pins nalgebra with `=`")
}

/// `1.2.3` of a line that has `"=1.2.3"` in it.
fn exact(line: &str) -> Option<String> {
    Some(line.split_once("\"=")?.1.split_once('"')?.0.trim().to_owned())
}

/// One line of what the compiler says about itself.
fn compiler(key: &str) -> String {
    let output =
        Command::new(variable("RUSTC")).arg("-vV").output().expect("cargo names a compiler that runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let value = text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(": "));
    value.unwrap_or("unknown").to_owned()
}
