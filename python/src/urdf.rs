//! A hand by itself as URDF, written by the exporter of plans.

use regrasp::api::{FingerIndex, Hand as _};
use regrasp::export::{File, Format, Scene};
use regrasp::plan::{Plan, Statistics, VERSION};
use regrasp::world::ChainHand;
use serde_json::json;

/// The URDF, first, and the meshes that it names beside it; `Err` says why there is none.
pub fn files(hand: &ChainHand, stem: &str) -> Result<Vec<File>, String> {
    let plan = still(hand).map_err(|error| error.to_string())?;
    let scene = Scene::new(&plan).map_err(|error| error.to_string())?;
    let all = scene.export(Format::Urdf, stem).map_err(|error| error.to_string())?;
    let is_hands = |file: &File| !file.name.contains(".object.") && !file.name.ends_with(".csv");
    Ok(all.into_iter().filter(is_hands).collect())
}

/// A plan in which nothing happens: the exporter writes hands as parts of plans.
fn still(hand: &ChainHand) -> serde_json::Result<Plan> {
    let fingers = (0..hand.finger_count()).map(|finger| FingerIndex(finger as u8));
    let rest: Vec<_> = fingers.map(|finger| hand.finger(finger).rest.to_vec()).collect();
    let free = vec![serde_json::Value::Null; rest.len()];
    let place = json!({ "position": [0.0, 0.0, 1.0], "orientation": [1.0, 0.0, 0.0, 0.0] });
    let object = json!({
        "name": "object", "mass": 0.1, "friction": 1.0, "shape": { "kind": "sphere", "radius": 0.01 },
    });
    let claims = json!({
        "contact": { "model": "", "cone": null }, "criterion": "closure", "transfer_law": "rolling",
        "margin": { "center_O": [0.0, 0.0, 0.0], "length": 1.0 },
    });
    serde_json::from_value(json!({
        "format": "regrasp-plan", "version": VERSION, "seed": 0, "versions": {}, "claims": claims,
        "scenario": { "name": "", "plugins": {}, "problem": {
            "hand": hand.description(), "object": object, "start": { "pose": place }, "goal": [],
        }},
        "goals_reached": [], "stopped_by": null, "statistics": Statistics::default(), "certificate": null,
        "segments": [{ "kind": "transfer", "states": [
            { "time": 0.0, "object": place, "joints": rest, "contacts": free },
        ]}],
    }))
}
