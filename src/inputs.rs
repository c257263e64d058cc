//! The files that a command reads, and those that these name: none of them may be written over.

use crate::{Failure, outputs};
use regrasp::formats::named_files;
use regrasp::host::Registry;
use regrasp::run::scenario::{self, Scenario};
use serde_json::Value;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Loads the built-in scenario of this name, or else the file; `-` is standard input, which is read once.
pub fn scenario(name: &str, registry: &Registry) -> Result<Scenario, Failure> {
    if !outputs::is_standard(Path::new(name)) {
        return scenario::load(name, registry).map_err(Failure::refused);
    }
    let mut text = String::new();
    let read = io::stdin().take(LARGEST).read_to_string(&mut text);
    read.map_err(|error| Failure::bad_input(format!("cannot read standard input: {error}")))?;
    scenario::from_text("standard input", &text, Path::new(""), registry).map_err(Failure::refused)
}

/// Larger files (bytes) are no scenario and no hand file.
const LARGEST: u64 = 64 << 20;

/// A robot's file and everything that it names: meshes, included files and what these name.
pub fn of_robot(file: &Path, packages: &[PathBuf]) -> Vec<PathBuf> {
    let mut files = named_files(file, packages);
    files.push(file.to_owned());
    files
}

/// A scenario file and all files that it names, with those that its hand file or its robot's file name.
pub fn of_scenario(scenario: &str) -> Vec<PathBuf> {
    let path = PathBuf::from(scenario);
    let (named, packages) = named_in(&path);
    let mut files = vec![path];
    for file in named {
        let extension = file.extension().unwrap_or_default().to_ascii_lowercase();
        match extension.to_str() {
            Some("toml") => files.extend(named_in(&file).0),
            // Large, and they name nothing.
            Some("stl" | "ply" | "obj" | "glb" | "3mf") => {}
            _ => files.extend(named_files(&file, &packages)),
        }
        files.push(file);
    }
    files
}

/// The files that the texts of a TOML or JSON file name, and the folders; none where it is neither.
fn named_in(path: &Path) -> (Vec<PathBuf>, Vec<PathBuf>) {
    let small = fs::metadata(path).is_ok_and(|found| found.is_file() && found.len() < LARGEST);
    let text = if small { fs::read_to_string(path).unwrap_or_default() } else { String::new() };
    let value: Value = toml::from_str(&text).or_else(|_| serde_json::from_str(&text)).unwrap_or_default();
    let mut texts = Vec::new();
    collect(&value, &mut texts);
    let folder = path.parent().unwrap_or(Path::new(""));
    let there = texts.iter().map(|text| folder.join(text)).filter(|path| path.exists());
    there.partition(|path| path.is_file())
}

fn collect(value: &Value, texts: &mut Vec<String>) {
    match value {
        Value::String(text) => texts.push(text.clone()),
        Value::Array(items) => items.iter().for_each(|item| collect(item, texts)),
        Value::Object(items) => items.values().for_each(|item| collect(item, texts)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scenario_names_its_files_and_those_of_its_hand() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("palm.stl"), "solid").unwrap();
        fs::write(at("hand.toml"), "palm = [{ file = \"palm.stl\" }]").unwrap();
        fs::write(at("mine.toml"), "[hand]\nfile = \"hand.toml\"").unwrap();
        let files = of_scenario(at("mine.toml").to_str().unwrap());
        assert_eq!(files, [at("mine.toml"), at("palm.stl"), at("hand.toml")]);
    }

    #[test]
    fn meshes_of_a_robot_are_inputs_of_its_scenario() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir_all(at("ros/tools")).unwrap();
        fs::write(at("ros/tools/tip.stl"), "solid").unwrap();
        let urdf = "<robot name='r'><link name='a'><visual><geometry>\
                    <mesh filename='package://tools/tip.stl'/></geometry></visual></link></robot>";
        fs::write(at("r.urdf"), urdf).unwrap();
        fs::write(at("mine.toml"), "[hand]\nurdf = \"r.urdf\"\npackages = [\"ros\"]").unwrap();
        let files = of_scenario(at("mine.toml").to_str().unwrap());
        assert!(files.contains(&at("ros/tools/tip.stl")), "{files:?}");
    }
}
