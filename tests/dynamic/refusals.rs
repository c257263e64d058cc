//! Libraries that do not fit are refused, each with its own message, and nothing of them is loaded.

use crate::workshop::{Said, faulty, run, written};
use regrasp::abi::{CONTRACT_VERSION, FINGERPRINT};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder for changed copies, and the mark that a loaded library leaves.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder") }
    }

    fn mark(&self) -> PathBuf {
        self.folder.path().join("mark")
    }

    /// A copy of a library with one text replaced by another, which must not be longer.
    fn patched(&self, library: &Path, from: &str, to: &str) -> PathBuf {
        let mut bytes = fs::read(library).expect("the library was built");
        let fill = to.len()..from.len();
        let to: Vec<u8> = to.bytes().chain(fill.map(|_| b'\n')).collect();
        assert_eq!(to.len(), from.len(), "`{from}` has no room for the new text");
        let places: Vec<usize> =
            (0..bytes.len() - from.len()).filter(|&i| bytes[i..].starts_with(from.as_bytes())).collect();
        assert!(!places.is_empty(), "`{from}` is not in the library");
        places.iter().for_each(|&i| bytes[i..i + from.len()].copy_from_slice(&to));
        self.file("patched.so", &bytes)
    }

    fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.folder.path().join(name);
        fs::write(&path, bytes).expect("a temporary folder");
        path
    }

    fn load(&self, libraries: &[&Path]) -> Said {
        let mut command = Command::new(env!("CARGO_BIN_EXE_regrasp"));
        command.args(["plan", "sphere", "--use", "sampler=faulty"]).env("REGRASP_TEST_MARK", self.mark());
        libraries.iter().for_each(|library| {
            command.arg("--load").arg(library);
        });
        run(&mut command)
    }

    /// Loads libraries, and demands that the last is refused for a reason before any was loaded.
    fn refused(&self, libraries: &[&Path], why: &[&str]) {
        let said = self.load(libraries);
        assert_eq!(said.code, Some(2), "{said:?}");
        assert!(why.iter().all(|why| said.err.contains(why)), "{why:?} is not in {}", said.err);
        assert!(!self.mark().exists(), "a library was loaded: {libraries:?}");
    }
}

#[test]
fn a_library_that_fits_is_loaded() {
    let bench = Bench::new();
    let said = bench.load(&[&faulty()]);
    assert!(said.err.contains("`sampler/faulty` panicked"), "{said:?}");
    // Without this the tests below would show nothing.
    assert_eq!(bench.mark().exists(), cfg!(target_os = "linux"));
}

#[test]
fn what_is_no_library_is_refused() {
    let bench = Bench::new();
    let good = faulty();
    bench.refused(&[Path::new("no-such-file.so")], &["`no-such-file.so` cannot be read"]);
    bench.refused(&[bench.folder.path()], &["cannot be read"]);
    bench.refused(&[&good, &bench.file("text.so", b"not a library")], &["text.so` is not a shared library"]);
    bench.refused(&[&good, &bench.file("empty.so", b"")], &["empty.so` is not a shared library"]);
    let half = fs::read(&good).expect("the library was built");
    let half = bench.file("half.so", &half[..half.len() / 2]);
    bench.refused(&[&half], &["half.so` is not a shared library"]);
    bench.refused(&[Path::new(env!("CARGO_BIN_EXE_regrasp"))], &["without Regrasp plugins"]);
}

#[test]
fn a_library_without_plugins_is_refused() {
    let bench = Bench::new();
    let all_gone = {
        let bytes = fs::read(faulty()).expect("the library was built");
        let text =
            bytes.iter().map(|&byte| byte as char).collect::<String>().replace("\nplugin: ", "\nplugon: ");
        bench.file("none.so", &text.chars().map(|c| c as u8).collect::<Vec<_>>())
    };
    bench.refused(&[&all_gone], &["a library without Regrasp plugins", "export_plugins!"]);
}

#[test]
fn another_contract_version_is_refused() {
    let bench = Bench::new();
    let version = format!("contract: {CONTRACT_VERSION}\n");
    let patched = bench.patched(&faulty(), &version, "contract: 9\n");
    bench.refused(&[&patched], &["version 9 of the plugin contract", "cargo ", "--manifest-path"]);
}

#[test]
fn every_other_difference_is_refused_with_both_sides() {
    let bench = Bench::new();
    let library = faulty();
    for line in FINGERPRINT.lines().skip(1) {
        let (key, value) = line.split_once(": ").expect("a line has a key");
        let other = "x".repeat(value.len().min(3));
        let patched = bench.patched(&library, &format!("\n{line}\n"), &format!("\n{key}: {other}\n"));
        bench.refused(&[&patched], &["not built alike", key, value, &other, "cargo "]);
    }
}

#[test]
fn a_second_plugin_of_the_same_id_is_refused() {
    let bench = Bench::new();
    let library = faulty();
    bench.refused(&[&library, &library], &["two plugins have the id `contact-model/faulty`"]);
    let patched = bench.patched(&library, "plugin: sampler/faulty", "plugin: sampler/rlg");
    bench.refused(&[&patched], &["two plugins have the id `sampler/rlg`", "from this program"]);
}

#[test]
fn where_one_library_is_refused_none_is_loaded() {
    let bench = Bench::new();
    let text = bench.file("text.so", b"not a library");
    bench.refused(&[&faulty(), &written("sampler"), &text], &["text.so` is not a shared library"]);
}

#[test]
fn a_plugin_that_no_library_brings_is_not_replaced_by_another() {
    let bench = Bench::new();
    let said = bench.load(&[]);
    assert!(
        said.code == Some(2) && said.err.contains("there is no plugin `faulty` for `sampler`"),
        "{said:?}"
    );
}
