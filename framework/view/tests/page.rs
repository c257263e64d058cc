//! The page of a small plan made by hand: what it holds, what it refuses, how large it is.

use regrasp_plan::{Plan, StateRecord};
use regrasp_view::{Extras, GraphEdge, GraphNode, GraphPicture, ReplayTrack, StateCurves, ViewError, page};
use serde_json::{Value, json};

/// One finger with one joint and a ball, over one step.
fn plan() -> Plan {
    let state = |time: f64, q: f64| {
        json!({
            "time": time,
            "object": {"position": [0.0, 0.0, 0.08], "orientation": [1.0, 0.0, 0.0, 0.0]},
            "joints": [[q, 0.1, 0.2]],
            "contacts": [{"point_O": [0.03, 0.0, 0.0], "normal_O": [1.0, 0.0, 0.0], "point_F": [-0.01, 0.0, 0.0]}],
        })
    };
    let joint = |name: &str, axis: [f64; 3]| json!({"name": name, "origin": {"position": [0.0, 0.0, 0.05]}, "axis": axis, "lower": -1.0, "upper": 1.0});
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
                    "finger": [{"name": "</script>", "joint": [joint("a", [2.0, 0.0, 0.0]), joint("b", [0.0, 1.0, 0.0]), last], "tip": [0.0, 0.0, 0.05], "rest": [0.0, 0.1, 0.2]}],
                },
                "object": {"shape": {"kind": "sphere", "radius": 0.03, "facets": 80}, "friction": 0.8},
                "obstacle": [{"name": "floor", "shape": {"kind": "half-space", "normal": [0, 0, 1], "offset": -0.1}}],
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
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"data\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn the_page_holds_the_plan_and_nothing_leaves_its_place() {
    let page = page(&plan(), &Extras::default()).unwrap();
    assert!(
        page.contains("<h1>&lt;i&gt;small&lt;/i&gt; &amp; &quot;quoted&quot;</h1>")
            && !page.contains("<i>small")
    );
    let data = data(&page);
    assert_eq!(data["hand"]["fingers"][0]["name"], "</script>");
    assert_eq!(data["hand"]["fingers"][0]["joints"][0]["axis"], json!([1.0, 0.0, 0.0]), "of length 1");
    assert_eq!(data["motion"]["states"]["time"], json!([0.0, 0.5]));
    assert_eq!(data["object"]["facets"].as_array().unwrap().len(), 3 * 80);
    assert_eq!(data["cone"]["mu"], 0.8);
    assert_eq!([&data["graph"], &data["curves"], &data["replay"]], [&Value::Null; 3]);
    // At the first state the joints are nearly straight: the tip is above the base by the sum of the links,
    // but for two small turns.
    let tip = &data["motion"]["checks"][0]["tips"][0];
    let height = 0.05 + 0.05 + 0.05 * 0.1_f64.cos() + 0.05 * 0.3_f64.cos();
    assert!((tip[2].as_f64().unwrap() - height).abs() < 1e-9, "{tip}");
}

#[test]
fn a_state_costs_half_a_kilobyte_for_a_hand_of_four_fingers() {
    let mut plan = plan();
    let empty = page(&plan, &Extras::default()).unwrap().len();
    assert!(empty < 1_100_000, "{empty}");
    let state = plan.segments[0].states[1].clone();
    let awkward = |k: usize| {
        let x = 0.123456789123 + k as f64 * 1e-7;
        let mut state = StateRecord { time: 1.0 + x * k as f64, ..state.clone() };
        state.joints[0] = vec![x, -x, x];
        state.object.position = [x; 3];
        state
    };
    plan.segments[0].states.extend((0..1000).map(awkward));
    let each = (page(&plan, &Extras::default()).unwrap().len() - empty) / 1000;
    assert!(each < 250, "{each} bytes for one finger");
}

#[test]
fn what_does_not_fit_the_plan_is_refused() {
    let refused = |extras: Extras| page(&plan(), &extras).unwrap_err().to_string();
    let curves = StateCurves { margin: vec![None], ..StateCurves::default() };
    assert!(refused(Extras { curves: Some(curves), ..Extras::default() }).contains("curves"));
    let replay = ReplayTrack { times: vec![1.0, 0.0], poses: vec![[0.0; 7]; 2], ..ReplayTrack::default() };
    assert!(refused(Extras { replay: Some(replay), ..Extras::default() }).contains("replay"));
    let node = GraphNode { state: plan().segments[0].states[0].clone(), component: 0, end: None };
    let edges = vec![GraphEdge { from: 0, to: 1, kind: "grasp", fate: "failed" }];
    let graph = GraphPicture { nodes: vec![node], edges };
    assert!(refused(Extras { graph: Some(graph), ..Extras::default() }).contains("edge"));
}

#[test]
fn states_that_cannot_be_shown_are_named() {
    let refused = |change: fn(&mut StateRecord)| {
        let mut plan = plan();
        change(&mut plan.segments[0].states[1]);
        match page(&plan, &Extras::default()) {
            Err(ViewError::State { segment: 0, state: 1, reason }) => reason,
            other => panic!("{other:?}"),
        }
    };
    assert!(refused(|state| state.joints[0].clear()).contains("joint"));
    assert!(refused(|state| state.contacts.clear()).contains("contact"));
    assert!(refused(|state| state.object.position[0] = f64::NAN).contains("finite"));
    assert!(refused(|state| state.object.orientation = [0.0; 4]).contains("zero"));
    assert!(refused(|state| state.time = -1.0).contains("earlier"));
}

#[test]
fn a_plan_without_motion_can_be_shown() {
    let mut plan = plan();
    plan.segments.clear();
    assert_eq!(data(&page(&plan, &Extras::default()).unwrap())["motion"]["segments"], json!([]));
}
