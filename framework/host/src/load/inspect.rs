//! Reading a library as a file: what it holds and whether it fits, before any of it is loaded.

use super::{Difference, LoadError};
use object::{Object, ObjectKind, ObjectSection};
use regrasp_abi::{CONTRACT_KEY, FINGERPRINT, SECTION};
use std::path::{Path, PathBuf};

/// A library that was read, and fits this program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inspected {
    /// The file, as an absolute path without links: a bare name would make the system search its own folders.
    pub path: PathBuf,
    /// The ids of its plugins.
    pub ids: Vec<String>,
    /// What its section holds.
    pub(super) section: Vec<u8>,
    /// The whole file: what was inspected is what is loaded, whatever becomes of the file meanwhile.
    pub(super) bytes: Vec<u8>,
}

/// The largest library that is read (bytes).
const MAX_BYTES: u64 = 1 << 30;

/// Reads the library at `path` without loading it, and refuses it where it does not fit this program.
pub fn inspect(path: &Path) -> Result<Inspected, LoadError> {
    let unreadable =
        |error: std::io::Error| LoadError::Unreadable { path: path.into(), cause: error.to_string() };
    let absolute = path.canonicalize().map_err(unreadable)?;
    let bytes = regrasp_api::read_at_most(&absolute, MAX_BYTES).map_err(unreadable)?;
    let section = section(path, &bytes)?;
    let text = String::from_utf8_lossy(&section);
    let lines = parse(&text);
    let ids: Vec<String> = values(&lines, "plugin").map(str::to_owned).collect();
    if ids.is_empty() {
        return Err(LoadError::NoPlugins { path: path.into() });
    }
    compare(path, &lines)?;
    Ok(Inspected { path: absolute, ids, section, bytes })
}

/// The section that the export macro wrote.
fn section(path: &Path, bytes: &[u8]) -> Result<Vec<u8>, LoadError> {
    let refuse = |cause: String| LoadError::NotALibrary { path: path.into(), cause };
    let file = object::File::parse(bytes).map_err(|error| refuse(error.to_string()))?;
    if file.kind() != ObjectKind::Dynamic {
        return Err(refuse("it is a program or an object file; build a crate of type `cdylib`".into()));
    }
    let section = file.section_by_name(SECTION).ok_or_else(|| LoadError::NoPlugins { path: path.into() })?;
    let data = section.data().map_err(|error| refuse(error.to_string()))?;
    // A section may be longer than what was written into it.
    let end = data.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    Ok(data[..end].to_vec())
}

type Lines<'a> = Vec<(&'a str, &'a str)>;

fn parse(text: &str) -> Lines<'_> {
    text.lines().filter_map(|line| line.split_once(": ")).collect()
}

fn values<'a>(lines: &Lines<'a>, key: &str) -> impl Iterator<Item = &'a str> {
    lines.iter().filter(move |(name, _)| *name == key).map(|(_, value)| *value)
}

/// Refuses a library whose fingerprint is not this program's.
fn compare(path: &Path, library: &Lines<'_>) -> Result<(), LoadError> {
    let program = parse(FINGERPRINT);
    let value = |lines: &Lines<'_>, key: &str| values(lines, key).next().map(str::to_owned);
    let rebuild = rebuild(library, &program);
    let contract = |lines| value(lines, CONTRACT_KEY).unwrap_or_else(|| "(none)".into());
    if contract(library) != contract(&program) {
        let (program, library) = (contract(&program), contract(library));
        return Err(LoadError::Contract { path: path.into(), program, library, rebuild });
    }
    let own = ["package", "manifest", "plugin"];
    let new = library
        .iter()
        .map(|(key, _)| *key)
        .filter(|key| !own.contains(key) && value(&program, key).is_none());
    let keys = program.iter().map(|(key, _)| *key).chain(new);
    let difference = |key: &str| Difference {
        key: key.into(),
        program: value(&program, key),
        library: value(library, key),
    };
    let differences: Vec<Difference> =
        keys.map(difference).filter(|difference| difference.program != difference.library).collect();
    if differences.is_empty() {
        return Ok(());
    }
    Err(LoadError::Fingerprint { path: path.into(), differences, rebuild })
}

/// The command that rebuilds a plugin library, with this program's compiler where the library had another.
fn rebuild(library: &Lines<'_>, program: &Lines<'_>) -> String {
    let value = |lines: &Lines<'_>, key: &str| values(lines, key).next().unwrap_or_default().to_owned();
    let compiler = value(program, "compiler");
    let toolchain =
        if value(library, "compiler") == compiler { String::new() } else { format!("+{compiler} ") };
    let folder = value(library, "manifest");
    let manifest = Path::new(&folder).join("Cargo.toml");
    format!("cargo {toolchain}build --release --manifest-path \"{}\"", manifest.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library(change: impl FnOnce(String) -> String) -> Result<(), LoadError> {
        let text = change(FINGERPRINT.to_owned() + "package: p\nmanifest: /somewhere/p\nplugin: sampler/p\n");
        compare(Path::new("p.so"), &parse(&text))
    }

    #[test]
    fn the_programs_own_fingerprint_fits() {
        assert_eq!(library(|text| text), Ok(()));
    }

    #[test]
    fn every_line_counts_and_both_sides_are_shown() {
        for (key, value) in parse(FINGERPRINT) {
            let line = format!("{key}: {value}\n");
            let error = library(|text| text.replacen(&line, &format!("{key}: other\n"), 1)).unwrap_err();
            let message = error.to_string();
            assert!(message.contains("other") && message.contains(value), "{message}");
            assert!(message.contains("cargo "), "{message}");
            assert_eq!(key == CONTRACT_KEY, matches!(error, LoadError::Contract { .. }));
            let error = library(|text| text.replacen(&line, "", 1)).unwrap_err().to_string();
            assert!(error.contains("(no"), "a missing line is a difference: {error}");
        }
        let error = library(|text| text + "moon: full\n").unwrap_err().to_string();
        assert!(error.contains("moon") && error.contains("full"), "{error}");
    }

    #[test]
    fn another_compiler_is_named_in_the_command_that_rebuilds() {
        let compiler = values(&parse(FINGERPRINT), "compiler").next().unwrap().to_owned();
        let error = library(|text| text.replacen(&format!("compiler: {compiler}"), "compiler: 1.0.0", 1));
        let message = error.unwrap_err().to_string();
        let manifest = Path::new("/somewhere/p").join("Cargo.toml");
        let command = format!("cargo +{compiler} build --release --manifest-path \"{}\"", manifest.display());
        assert!(message.contains(&command), "{message}");
    }

    #[test]
    fn what_is_no_library_is_refused() {
        let missing = inspect(Path::new("no-such-file.so")).unwrap_err();
        assert!(matches!(missing, LoadError::Unreadable { .. }), "{missing}");
        let text = inspect(&Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml")).unwrap_err();
        assert!(matches!(text, LoadError::NotALibrary { .. }), "{text}");
        assert!(matches!(inspect(Path::new(env!("CARGO_MANIFEST_DIR"))), Err(LoadError::Unreadable { .. })));
    }
}
