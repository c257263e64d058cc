//! What is fuzzed: every reader, and behind it all that a command does with what was read.

use crate::seeds;
use regrasp::api::{FingerIndex, Hand};
use regrasp::host::{Registry, inspect};
use regrasp::run::scenario;
use std::fs;
use std::path::Path;

/// A reader to be given damaged bytes.
pub struct Target {
    /// Its name.
    pub name: &'static str,
    /// Whole inputs to begin with.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Reads the bytes; `folder` is empty and may be written to.
    pub read: fn(&[u8], &Path),
}

/// All of them.
pub const TARGETS: [Target; 10] = [
    Target { name: "scenario", seeds: seeds::scenarios, read: read_scenario },
    Target {
        name: "hand",
        seeds: seeds::hands,
        read: |bytes, folder| read_hand(bytes, folder, "file", "h.toml"),
    },
    Target {
        name: "urdf",
        seeds: seeds::urdfs,
        read: |bytes, folder| read_hand(bytes, folder, "urdf", "h.urdf"),
    },
    Target { name: "stl", seeds: seeds::stls, read: |bytes, folder| read_mesh(bytes, folder, "o.stl") },
    Target { name: "obj", seeds: seeds::objs, read: |bytes, folder| read_mesh(bytes, folder, "o.obj") },
    Target { name: "ply", seeds: seeds::plys, read: |bytes, folder| read_mesh(bytes, folder, "o.ply") },
    Target { name: "dae", seeds: seeds::daes, read: |bytes, folder| read_mesh(bytes, folder, "o.dae") },
    Target { name: "plan", seeds: seeds::plans, read: read_plan },
    Target { name: "library", seeds: seeds::libraries, read: read_library },
    Target { name: "study", seeds: seeds::studies, read: read_study },
];

fn read_scenario(bytes: &[u8], folder: &Path) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    load(text, folder);
}

/// Loads a scenario; where that goes well, asks the hand something.
fn load(text: &str, folder: &Path) {
    let registry = Registry::linked().expect("the built-in plugins are in order");
    let Ok(scenario) = scenario::from_text("fuzzed.toml", text, folder, &registry) else { return };
    for finger in 0..scenario.hand.finger_count() {
        let finger = FingerIndex(finger as u8);
        let rest = scenario.hand.finger(finger).rest;
        let _ = scenario.hand.tip_center(finger, &rest);
    }
    let _ = regrasp::setup(&scenario);
}

fn read_hand(bytes: &[u8], folder: &Path, key: &str, name: &str) {
    write(folder, name, bytes);
    load(&with_files(&format!("{key} = \"{name}\""), "{ kind = \"sphere\", radius = 0.03 }"), folder);
}

fn read_mesh(bytes: &[u8], folder: &Path, name: &str) {
    write(folder, name, bytes);
    load(
        &with_files("builtin = \"four-finger\"", &format!("{{ kind = \"mesh\", file = \"{name}\" }}")),
        folder,
    );
}

fn with_files(hand: &str, shape: &str) -> String {
    format!(
        "[hand]\n{hand}\n[object]\nshape = {shape}\nmass = 0.1\nfriction = 0.8\n\
         [start]\npose = {{ position = [0.0, 0.0, 0.085] }}\n[[goal]]\npose = {{ position = [0.0, 0.0, \
         0.09] }}\n"
    )
}

fn write(folder: &Path, name: &str, bytes: &[u8]) {
    fs::write(folder.join(name), bytes).expect("the folder can be written to");
}

fn read_plan(bytes: &[u8], _: &Path) {
    if let Ok(plan) = regrasp::plan::from_json(bytes, Path::new("fuzzed.json")) {
        let _ = regrasp::verify::verify(&plan);
        let _ = regrasp::plan::motion(&plan);
        let _ = regrasp::export::Scene::new(&plan);
    }
}

fn read_library(bytes: &[u8], folder: &Path) {
    write(folder, "l.so", bytes);
    let _ = inspect(&folder.join("l.so"));
}

fn read_study(bytes: &[u8], folder: &Path) {
    write(folder, "study.json", bytes);
    let _ = regrasp::study::compare::read_study(folder);
}
