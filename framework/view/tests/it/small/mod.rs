//! A small plan made by hand, and what a page's scripts are told.

use regrasp_plan::Plan;
use serde_json::{Value, json};

/// One finger with one joint and a ball, over one step.
pub fn plan() -> Plan {
    let state = |time: f64, q: f64| {
        json!({
            "time": time,
            "object": {"position": [0.0, 0.0, 0.08], "orientation": [1.0, 0.0, 0.0, 0.0]},
            "joints": [[q, 0.1, 0.2]],
            "contacts": [
                {"point_O": [0.03, 0.0, 0.0], "normal_O": [1.0, 0.0, 0.0], "point_F": [-0.01, 0.0, 0.0]},
            ],
        })
    };
    let joint = |name: &str, axis: [f64; 3]| {
        let origin = json!({"position": [0.0, 0.0, 0.05]});
        json!({"name": name, "origin": origin, "axis": axis, "lower": -1.0, "upper": 1.0})
    };
    let capsule =
        json!({"shape": {"kind": "capsule", "from": [0, 0, 0], "to": [0, 0, 0.05], "radius": 0.008}});
    let mut last = joint("c", [0.0, 1.0, 0.0]);
    last["link"] = json!([capsule]);
    let plan = json!({
        "format": "regrasp-plan",
        "version": 1,
        "scenario": {
            "name": "<i>small</i> & \"quoted\"",
            "problem": {
                "hand": {
                    "name": "one",
                    "fingertip_radius": 0.01,
                    "palm": [{"shape": {"kind": "box", "size": [0.1, 0.1, 0.01]}}],
                    "finger": [{
                        "name": "</script>",
                        "joint": [joint("a", [2.0, 0.0, 0.0]), joint("b", [0.0, 1.0, 0.0]), last],
                        "tip": [0.0, 0.0, 0.05],
                        "rest": [0.0, 0.1, 0.2],
                    }],
                },
                "object": {"shape": {"kind": "sphere", "radius": 0.03, "facets": 80}, "friction": 0.8},
                "obstacle": [
                    {"name": "floor", "shape": {"kind": "half-space", "normal": [0, 0, 1], "offset": -0.1}},
                ],
                "start": {"pose": {"position": [0.0, 0.0, 0.08]}},
                "goal": [],
            },
            "plugins": {},
        },
        "seed": 7,
        "versions": {},
        "claims": {
            "contact": {"model": "contact-model/pcwf", "cone": {"mu": 0.8, "gamma": 0.0}},
            "criterion": "closure",
            "transfer_law": "rolling",
            "margin": {"center_O": [0.0, 0.0, 0.0], "length": 0.03},
        },
        "goals_reached": [],
        "stopped_by": null,
        "statistics": regrasp_plan::Statistics::default(),
        "certificate": null,
        "segments": [{"kind": "transfer", "states": [state(0.0, 0.0), state(0.5, 0.3)]}],
    });
    serde_json::from_value(plan).unwrap()
}

/// What the page's scripts are told.
pub fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"data\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}
