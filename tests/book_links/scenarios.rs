//! The pieces of scenario files that the pages show: each, laid over a built-in scenario, must be a scenario.

use crate::tree::Tree;
use regrasp::host::Registry;
use regrasp::run::scenario::from_text;
use std::path::Path;
use toml::{Table, Value};

/// Keys by which other files are told from scenarios: manifests, studies, hands, protocols.
const OTHERS: [&str; 7] = ["package", "dependencies", "lib", "scenarios", "variant", "finger", "series"];

/// Pieces that are no TOML, or no scenario.
pub fn faults(tree: &Tree) -> Vec<String> {
    let registry = Registry::linked().expect("the built-in plugins have different ids");
    let mut faults = Vec::new();
    for (file, page) in &tree.pages {
        // What is included comes from a file that is tested where it lies.
        for (line, text) in page.tables.iter().filter(|(_, text)| !text.contains("{{#")) {
            let fault = wrong(text, &registry).err();
            faults.extend(fault.map(|fault| format!("{}:{line}: {fault}", file.display())));
        }
    }
    faults
}

fn wrong(text: &str, registry: &Registry) -> Result<(), String> {
    let piece: Table = text.parse().map_err(|error| format!("not TOML: {error}"))?;
    if OTHERS.iter().any(|key| piece.contains_key(*key)) || names_a_file(&piece) {
        return Ok(());
    }
    let built_in = include_str!("../../scenarios/sphere.toml");
    let mut whole: Table = built_in.parse().expect("the built-in scenario is TOML");
    lay(&piece, &mut whole);
    let whole = toml::to_string(&whole).map_err(|error| error.to_string())?;
    from_text("shown", &whole, Path::new(""), registry).map(|_| ()).map_err(|error| error.to_string())
}

/// Whether it names a hand's or a mesh's file, which the reader has and the test has not.
fn names_a_file(piece: &Table) -> bool {
    let of = |table: Option<&Value>, key: &str| table.and_then(|table| table.get(key)).is_some();
    let (hand, shape) = (piece.get("hand"), piece.get("object").and_then(|object| object.get("shape")));
    of(hand, "urdf") || of(hand, "file") || of(shape, "file")
}

/// Lays a piece over a scenario. A shape and a pose are replaced as a whole; a piece without a plugin's name
/// keeps the one that is there.
fn lay(piece: &Table, whole: &mut Table) {
    for (key, value) in piece {
        match (value, whole.get_mut(key)) {
            (Value::Table(piece), Some(Value::Table(whole))) if key != "shape" && key != "pose" => {
                lay(piece, whole)
            }
            _ => {
                whole.insert(key.clone(), value.clone());
            }
        }
    }
}
