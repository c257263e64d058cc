//! Builds the plugin libraries, and runs the program.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The roles with the slot that the plugin of `new-plugin` fills.
pub const ROLES: [(&str, &str); 6] = [
    ("contact-model", "contact-model"),
    ("stability-test", "stability-test"),
    ("surface", "surface"),
    ("sampler", "sampler"),
    ("local-planner", "local-planner.regrasp"),
    ("graph-strategy", "graph-strategy"),
];

/// What the program said.
#[derive(Debug)]
pub struct Said {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

/// Runs the program.
pub fn regrasp(arguments: &[&str]) -> Said {
    run(Command::new(env!("CARGO_BIN_EXE_regrasp")).args(arguments))
}

/// Runs a command to its end.
pub fn run(command: &mut Command) -> Said {
    let output = command.output().expect("the command starts");
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    // Without a code the process was ended by a signal, as an abort does.
    Said { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
}

/// The folder of everything that the tests build.
fn root() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("plugins")
}

/// One build at a time.
fn lock() -> MutexGuard<'static, ()> {
    static BUILDING: Mutex<()> = Mutex::new(());
    BUILDING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs cargo in one of the crates.
pub fn cargo(name: &str, arguments: &[&str]) -> Said {
    let mut command = Command::new(env!("CARGO"));
    command.args(arguments).arg("--offline").current_dir(root().join(name));
    // What was compiled for the program serves the plugins, too, wherever that lies.
    let built = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("it lies in the target folder");
    command.env("CARGO_BUILD_BUILD_DIR", built);
    run(command.env("CARGO_TARGET_DIR", root().join("target")))
}

fn build(name: &str, package: &str) -> PathBuf {
    // All targets, so that the kit's tests are built with the same features as the library: everything once.
    let built = cargo(name, &["build", "--workspace", "--all-targets"]);
    assert_eq!(built.code, Some(0), "{name}: {}", built.err);
    let library = format!("{DLL_PREFIX}{}{DLL_SUFFIX}", package.replace('-', "_"));
    root().join("target").join("debug").join(library)
}

/// The library of the plugin that `new-plugin` writes for a role, unedited.
pub fn written(role: &str) -> PathBuf {
    edited(role, "mine", &[])
}

/// The library of what `new-plugin` writes, some of its files replaced by others: path in the crate, file.
pub fn edited(role: &str, name: &str, files: &[(PathBuf, PathBuf)]) -> PathBuf {
    let _building = lock();
    let fresh =
        tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).expect("the target folder can be written to");
    let folder = fresh.path().join("crate");
    let said =
        regrasp(&["new-plugin", role, name, "-o", folder.to_str().expect("the target folder is UTF-8")]);
    assert_eq!(said.code, Some(0), "{said:?}");
    for (file, by) in files {
        fs::copy(by, folder.join(file)).expect("both files exist");
    }
    let here = if name == "mine" { role.to_owned() } else { format!("{name}-{role}") };
    mirror(&folder, &root().join(&here));
    build(&here, &format!("{name}-{role}-dynamic"))
}

/// The library whose plugins panic.
pub fn faulty() -> PathBuf {
    let _building = lock();
    let framework = Path::new(env!("CARGO_MANIFEST_DIR")).join("framework");
    let path = |name: &str| format!("{:?}", framework.join(name));
    let manifest = include_str!("faulty/Cargo.toml.in").replace("{{api}}", &path("api"));
    let manifest = manifest.replace("{{abi}}", &path("abi"));
    let folder = root().join("faulty");
    keep(&folder.join("Cargo.toml"), manifest.as_bytes());
    keep(&folder.join("Cargo.lock"), include_bytes!("../../Cargo.lock"));
    keep(&folder.join("src").join("lib.rs"), include_bytes!("faulty/lib.rs"));
    build("faulty", "faulty")
}

/// Makes `to` hold the files of `from`; what is the same already stays as it is, so that cargo has nothing to
/// do.
fn mirror(from: &Path, to: &Path) {
    for entry in fs::read_dir(from).expect("the crate was written") {
        let path = entry.expect("the crate was written").path();
        let there = to.join(path.file_name().expect("an entry has a name"));
        if path.is_dir() {
            mirror(&path, &there);
        } else {
            keep(&there, &fs::read(&path).expect("the crate was written"));
        }
    }
}

fn keep(file: &Path, bytes: &[u8]) {
    // Cargo drops from the lock file what the crate does not use: the program's own is written only where
    // there is none, or the program's changed since.
    let of = if file.ends_with("Cargo.lock") { file.with_extension("lock.of") } else { file.to_owned() };
    if fs::read(&of).is_ok_and(|found| found == bytes) && file.exists() {
        return;
    }
    fs::create_dir_all(file.parent().expect("a file has a folder"))
        .expect("the target folder can be written to");
    for file in [file, &of] {
        fs::write(file, bytes).expect("the target folder can be written to");
    }
}
