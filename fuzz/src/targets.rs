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
    /// Reads the bytes, and says whether they were understood; `folder` is empty and may be written to.
    pub read: fn(&[u8], &Path) -> bool,
}

/// All of them.
pub const TARGETS: [Target; 13] = [
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
    Target {
        name: "mjcf",
        seeds: seeds::mjcfs,
        read: |bytes, folder| read_hand(bytes, folder, "mjcf", "h.xml"),
    },
    Target { name: "stl", seeds: seeds::stls, read: |bytes, folder| read_mesh(bytes, folder, "o.stl") },
    Target { name: "obj", seeds: seeds::objs, read: |bytes, folder| read_mesh(bytes, folder, "o.obj") },
    Target { name: "ply", seeds: seeds::plys, read: |bytes, folder| read_mesh(bytes, folder, "o.ply") },
    Target { name: "dae", seeds: seeds::daes, read: |bytes, folder| read_mesh(bytes, folder, "o.dae") },
    Target { name: "gltf", seeds: seeds::gltfs, read: read_gltf },
    Target { name: "3mf", seeds: seeds::threemfs, read: read_threemf },
    Target { name: "plan", seeds: seeds::plans, read: read_plan },
    Target { name: "library", seeds: seeds::libraries, read: read_library },
    Target { name: "study", seeds: seeds::studies, read: read_study },
];

fn read_scenario(bytes: &[u8], folder: &Path) -> bool {
    std::str::from_utf8(bytes).is_ok_and(|text| load(text, folder))
}

/// Loads a scenario; where that goes well, asks the hand something.
fn load(text: &str, folder: &Path) -> bool {
    let registry = Registry::linked().expect("the built-in plugins are in order");
    let Ok(scenario) = scenario::from_text("fuzzed.toml", text, folder, &registry) else { return false };
    for finger in 0..scenario.hand.finger_count() {
        let finger = FingerIndex(finger as u8);
        let rest = scenario.hand.finger(finger).rest;
        let _ = scenario.hand.tip_center(finger, &rest);
    }
    // A hand may want other plugins than the default ones.
    let _ = regrasp::setup(&scenario);
    true
}

fn read_hand(bytes: &[u8], folder: &Path, key: &str, name: &str) -> bool {
    write(folder, name, bytes);
    load(&with_files(&format!("{key} = \"{name}\""), "{ kind = \"sphere\", radius = 0.03 }"), folder)
}

fn read_mesh(bytes: &[u8], folder: &Path, name: &str) -> bool {
    write(folder, name, bytes);
    load(
        &with_files("builtin = \"four-finger\"", &format!("{{ kind = \"mesh\", file = \"{name}\" }}")),
        folder,
    )
}

/// As text, or as the binary form of it.
fn read_gltf(bytes: &[u8], folder: &Path) -> bool {
    let name = if bytes.starts_with(b"glTF") { "o.glb" } else { "o.gltf" };
    read_mesh(bytes, folder, name)
}

/// A whole archive; what is none goes into one as its model: damage in archives seldom gets past their sums.
fn read_threemf(bytes: &[u8], folder: &Path) -> bool {
    if bytes.starts_with(b"PK") {
        read_mesh(bytes, folder, "o.3mf")
    } else {
        read_mesh(&seeds::archive("3D/3dmodel.model", bytes), folder, "o.3mf")
    }
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

fn read_plan(bytes: &[u8], _: &Path) -> bool {
    let Ok(plan) = regrasp::plan::from_json(bytes, Path::new("fuzzed.json")) else { return false };
    let is_sound = regrasp::verify::verify(&plan).is_sound();
    let _ = regrasp::plan::motion(&plan);
    let _ = regrasp::export::Scene::new(&plan);
    is_sound
}

fn read_library(bytes: &[u8], folder: &Path) -> bool {
    write(folder, "l.so", bytes);
    inspect(&folder.join("l.so")).is_ok()
}

fn read_study(bytes: &[u8], folder: &Path) -> bool {
    write(folder, "study.json", bytes);
    regrasp::study::compare::read_study(folder).is_ok()
}
