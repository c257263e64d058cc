//! What a study records of its surroundings: the program, the machine, the time. The library looks at none of
//! them.

use crate::Failure;
use regrasp::study::compare::{Machine, fingerprint};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread::available_parallelism;
use std::time::{SystemTime, UNIX_EPOCH};

/// How many threads the processor runs at once.
pub fn cores() -> usize {
    available_parallelism().map_or(1, usize::from)
}

/// This machine, on which `threads` runs are made at once.
pub fn machine(threads: usize) -> Machine {
    let line = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let cpu = line("/proc/cpuinfo");
    let model = cpu.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(':'));
    Machine {
        host: line("/proc/sys/kernel/hostname").trim().to_owned(),
        os: std::env::consts::OS.to_owned(),
        arch: std::env::consts::ARCH.to_owned(),
        cpu: model.map(|(_, model)| model.trim().to_owned()).unwrap_or_default(),
        cores: cores(),
        threads,
    }
}

/// Versions of what computes: this program and the libraries that it loads, each with a hash of its file.
pub fn versions(libraries: &[PathBuf]) -> Result<BTreeMap<String, String>, Failure> {
    let hash = |path: &Path| {
        let bytes = fs::read(path);
        bytes
            .map(|bytes| fingerprint(&bytes))
            .map_err(|error| Failure::bad_input(format!("`{}`: {error}", path.display())))
    };
    let program = std::env::current_exe().map_err(Failure::bad_input)?;
    let mut versions = BTreeMap::from([
        ("regrasp".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("program".to_owned(), hash(&program)?),
    ]);
    for library in libraries {
        let name = library.file_name().unwrap_or(library.as_os_str()).to_string_lossy();
        versions.insert(format!("library {name}"), hash(library)?);
    }
    Ok(versions)
}

/// Seconds since 1970-01-01 UTC.
pub fn now_s() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs())
}
