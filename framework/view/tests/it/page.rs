//! The page of a small plan made by hand: what it holds, what it refuses, how large it is.

use crate::small;

use regrasp_plan::StateRecord;
use regrasp_view::{
    Extras, GraphEdge, GraphNode, GraphPicture, GripCurves, ReplayTrack, StateCurves, ViewError, page,
};
use serde_json::{Value, json};
use small::{data, plan};

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
    let grip =
        GripCurves { forces: vec![vec![]; 2], efforts: vec![vec![0.0; 3]; 2], ..GripCurves::default() };
    assert!(refused(Extras { grip: Some(grip), ..Extras::default() }).contains("forces"));
    let replay = ReplayTrack { times: vec![1.0, 0.0], poses: vec![[0.0; 7]; 2], ..ReplayTrack::default() };
    assert!(refused(Extras { replay: Some(replay), ..Extras::default() }).contains("replay"));
    let node = GraphNode {
        state: plan().segments[0].states[0].clone(),
        component: 0,
        grasp_component: 0,
        end: None,
    };
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
    assert!(refused(|state| state.velocities = Some(vec![vec![0.0; 2]])).contains("velocity"));
    assert!(refused(|state| state.velocities = Some(vec![vec![f64::NAN; 3]])).contains("finite"));
    assert!(refused(|state| state.contacts.clear()).contains("contact"));
    assert!(refused(|state| state.object.position[0] = f64::NAN).contains("finite"));
    assert!(refused(|state| state.object.orientation = [0.0; 4]).contains("zero"));
    assert!(refused(|state| state.time = -1.0).contains("earlier"));
}

#[test]
fn forces_efforts_and_velocities_come_with_their_limits() {
    let mut plan = plan();
    let velocity = |x: f64| Some(vec![vec![x, 2.0 * x, -x]]);
    plan.segments[0].states[0].velocities = velocity(0.0);
    plan.segments[0].states[1].velocities = velocity(0.1234567);
    let grip = GripCurves {
        forces: vec![vec![Some([-1.00049, 0.0, 0.25])], vec![None]],
        efforts: vec![vec![0.5, -0.1234, 0.0], vec![0.0; 3]],
        origin: "chosen".into(),
    };
    let data = data(&page(&plan, &Extras { grip: Some(grip), ..Extras::default() }).unwrap());
    assert_eq!(data["grip"]["forces"], json!([[[-1.0, 0.0, 0.25]], [[]]]), "in millinewtons");
    assert_eq!(data["grip"]["efforts"], json!([0.5, -0.123, 0.0, 0.0, 0.0, 0.0]));
    assert_eq!(data["motion"]["states"]["velocities"], json!([0.0, 0.0, 0.0, 0.123457, 0.246913, -0.123457]));
    let joint = &data["hand"]["fingers"][0]["joints"][0];
    assert_eq!(joint["range"], json!([-1.0, 1.0]));
    assert!(joint["velocity"].as_f64().unwrap() > 0.0 && joint["effort"].as_f64().unwrap() > 0.0);
    assert_eq!(data["goals"], json!([]), "the poses of the goals");
}

#[test]
fn velocities_that_some_states_lack_are_left_out() {
    let mut plan = plan();
    plan.segments[0].states[1].velocities = Some(vec![vec![0.1, 0.2, 0.3]]);
    let data = data(&page(&plan, &Extras::default()).unwrap());
    assert_eq!(data["motion"]["states"].get("velocities"), None);
}

#[test]
fn a_plan_without_motion_can_be_shown() {
    let mut plan = plan();
    plan.segments.clear();
    assert_eq!(data(&page(&plan, &Extras::default()).unwrap())["motion"]["segments"], json!([]));
}
