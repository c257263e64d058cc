//! Files of macros, expanded by `xacro` where it is installed.

use crate::Failure;
use std::env;
use std::ffi::OsString;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{self, Command};

/// Answers `$(find NAME)` without ROS: xacro asks this module where a package is.
const PACKAGES: &str = "import os


class PackageNotFoundError(KeyError):
    pass


def get_package_share_directory(name):
    for root in os.environ['REGRASP_PACKAGES'].split(os.pathsep):
        if os.path.basename(os.path.abspath(root)) == name:
            return root
        if os.path.isdir(os.path.join(root, name)):
            return os.path.join(root, name)
    raise PackageNotFoundError(\"package '%s' is in none of the folders of --packages\" % name)
";

/// Whether a file is one of macros, by its name.
pub fn is_needed(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xacro"))
}

/// The URDF that `xacro FILE NAME:=VALUE…` makes; `$(find …)` leads into the given folders, or those above
/// the file.
pub fn expand(file: &Path, values: &[String], packages: &[PathBuf]) -> Result<String, Failure> {
    let stub = Stub::new()?;
    let whole = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    let roots = packages.iter().cloned().chain(whole.ancestors().skip(1).take(6).map(Path::to_owned));
    let joined = |paths: &mut dyn Iterator<Item = PathBuf>| {
        env::join_paths(paths)
            .map_err(|_| Failure::bad_input("a folder's name holds the character between folders"))
    };
    let mut modules = vec![stub.0.clone()];
    modules.extend(env::var_os("PYTHONPATH").iter().flat_map(env::split_paths));
    let done = Command::new("xacro")
        .arg(file)
        .args(values)
        .env("REGRASP_PACKAGES", joined(&mut roots.into_iter())?)
        .env("PYTHONPATH", joined(&mut modules.into_iter())?)
        .output();
    let command = || {
        let words: Vec<OsString> = values.iter().map(OsString::from).collect();
        let words: Vec<String> = words.iter().map(|word| format!(" {}", word.to_string_lossy())).collect();
        format!("xacro {}{} > hand.urdf", file.display(), words.concat())
    };
    match done {
        Err(error) if error.kind() == ErrorKind::NotFound => Err(Failure::bad_input(format!(
            "{}: a file of macros must be expanded by `xacro`, which is not installed: `pip install xacro`, \
             then again; or `{}` elsewhere",
            file.display(),
            command()
        ))),
        Err(error) => Err(Failure::bad_input(format!("xacro could not be started: {error}"))),
        Ok(done) if !done.status.success() => Err(Failure::bad_input(format!(
            "`{}` failed:\n{}",
            command(),
            String::from_utf8_lossy(&done.stderr).trim()
        ))),
        Ok(done) => {
            String::from_utf8(done.stdout).map_err(|_| Failure::bad_input("xacro wrote no UTF-8 text"))
        }
    }
}

/// A folder with the module that xacro asks; it goes with the value.
struct Stub(PathBuf);

impl Stub {
    fn new() -> Result<Self, Failure> {
        let stub = Self(env::temp_dir().join(format!("regrasp-xacro-{}", process::id())));
        let package = stub.0.join("ament_index_python");
        let written = fs::create_dir_all(&package)
            .and_then(|()| fs::write(package.join("__init__.py"), ""))
            .and_then(|()| fs::write(package.join("packages.py"), PACKAGES));
        written
            .map_err(|error| Failure::bad_input(format!("cannot write to {}: {error}", stub.0.display())))?;
        Ok(stub)
    }
}

impl Drop for Stub {
    fn drop(&mut self) {
        // What is left in the folder for temporary files does no harm.
        let _ = fs::remove_dir_all(&self.0);
    }
}
