//! The protocols that are built in, and those of other folders.

use crate::{Protocol, SuiteError};
use regrasp_host::Registry;
use regrasp_run::scenario::{self, Document, Scenario, from_text};
use std::path::{Path, PathBuf};

/// A built-in protocol.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// Its name.
    pub name: &'static str,
    /// The protocol's file.
    pub text: &'static str,
    /// Its scenarios: their names and texts.
    pub files: &'static [(&'static str, &'static str)],
}

macro_rules! protocol {
    ($name:literal $(, $file:literal)*) => {
        BuiltIn {
            name: $name,
            text: include_str!(concat!("../scenarios/protocols/", $name, "/protocol.toml")),
            files: &[$(($file, include_str!(concat!("../scenarios/protocols/", $name, "/", $file)))),*],
        }
    };
}

/// The protocols, the project's own paper first.
pub const PROTOCOLS: &[BuiltIn] = &[
    protocol!("sahbani-2007"),
    protocol!("hidex"),
    protocol!("dlr-cube", "cube.toml"),
    protocol!("poise", "prism.toml"),
    protocol!("drop", "cube.toml", "small-cube.toml"),
    protocol!("bih", "cylinder.toml"),
    protocol!("rgmc"),
    protocol!("ctr", "cube.toml", "ball.toml"),
    protocol!("khandate", "cube.toml", "l-shape.toml"),
];

/// Where the scenarios of a protocol are.
#[derive(Clone, Debug)]
pub enum Files {
    /// In the program.
    BuiltIn(&'static [(&'static str, &'static str)]),
    /// In a folder.
    Folder(PathBuf),
}

impl Files {
    /// The scenario of this name: a file of the protocol's, or a built-in one.
    pub(crate) fn scenario(&self, name: &str, registry: &Registry) -> Result<Scenario, SuiteError> {
        match self {
            Self::BuiltIn(files) => match files.iter().find(|(file, _)| *file == name) {
                Some((file, text)) => Ok(from_text(file, text, Path::new(""), registry)?),
                None => Ok(scenario::load(name, registry)?),
            },
            Self::Folder(folder) => {
                let path = folder.join(name);
                let name = if path.exists() { path.display().to_string() } else { name.to_owned() };
                Ok(scenario::load(&name, registry)?)
            }
        }
    }
}

/// Other names of protocols.
const ALIASES: &[(&str, &str)] = &[("paper", "sahbani-2007")];

/// The built-in protocol of this name, or else that of a folder with a file `protocol.toml`.
pub fn load(name: &str) -> Result<(Protocol, Files), SuiteError> {
    let alias = ALIASES.iter().find(|(alias, _)| *alias == name).map_or(name, |(_, name)| name);
    if let Some(built_in) = PROTOCOLS.iter().find(|protocol| protocol.name == alias) {
        let protocol = Document::parse(&format!("{alias}/protocol.toml"), built_in.text)?.read()?;
        return Ok((protocol, Files::BuiltIn(built_in.files)));
    }
    let folder = Path::new(name);
    let path = folder.join("protocol.toml");
    if !path.is_file() {
        let known = PROTOCOLS.iter().map(|protocol| protocol.name).collect();
        return Err(SuiteError::Unknown { name: name.to_owned(), known });
    }
    let protocol = Document::parse(&path.display().to_string(), &scenario::read(&path)?)?.read()?;
    Ok((protocol, Files::Folder(folder.to_owned())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problems;
    use regrasp_contact_models as _;
    use regrasp_graph_strategies as _;
    use regrasp_local_planners as _;
    use regrasp_samplers as _;
    use regrasp_stability_tests as _;
    use regrasp_surfaces as _;

    #[test]
    fn every_protocol_is_whole_and_no_folder_is_forgotten() {
        let registry = Registry::linked().unwrap();
        for built_in in PROTOCOLS {
            let (protocol, files) = load(built_in.name).unwrap_or_else(|error| panic!("{error}"));
            assert!(!protocol.series.is_empty(), "{}", built_in.name);
            for series in &protocol.series {
                files.scenario(&series.scenario, &registry).unwrap_or_else(|error| panic!("{error}"));
                assert!(!problems(series).is_empty() && !series.published.is_empty(), "{}", series.name);
            }
        }
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/protocols");
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            assert!(PROTOCOLS.iter().any(|protocol| protocol.name == name), "`{name}` is not built in");
            let readme = std::fs::read_to_string(path.join("README.md")).unwrap();
            let (protocol, _) = load(&name).unwrap_or_else(|error| panic!("{error}"));
            let published = protocol.series.iter().flat_map(|series| &series.published);
            let figures = published.map(|published| format!("| {} |", published.figure));
            let told = [protocol.like.trim().to_owned(), protocol.chosen.trim().to_owned()];
            for words in told.into_iter().chain(figures) {
                assert!(readme.contains(&words), "{name}: its README does not have: {words}");
            }
        }
    }

    #[test]
    fn unknown_protocols_are_refused_with_the_nearest_name() {
        let text = load("sahbani").unwrap_err().to_string();
        assert!(text.contains("sahbani-2007"), "{text}");
        assert!(load("paper").is_ok());
    }
}
