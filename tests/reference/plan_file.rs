//! The page of plan files names every key that a plan has, and no other.

use crate::{page, printed};
use regrasp::api::{Body, Figure, FingerIndex, Slot, check_schema};
use regrasp::plan::{
    ConeClaim, ConeRecord, ContactSurface, EdgeRecord, Extreme, GrainClaim, Holds, HoldsAt, Plan,
};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::path::Path;

/// A place in a plan: keys, and `[]` for every item of a list.
type Place = Vec<String>;

/// Below these places a plan repeats what other pages describe.
const ELSEWHERE: [&str; 2] = ["scenario.problem", "settings"];

/// The places that the page names, in their order.
fn documented() -> Vec<Place> {
    let text = page("plan-file.md");
    let keys = text.lines().filter_map(|line| Some(line.strip_prefix("| `")?.split_once('`')?.0.to_owned()));
    let places: Vec<Place> = keys.map(|key| place(&key)).collect();
    assert!(places.len() > 60, "only {} keys are documented", places.len());
    places
}

/// `segments[].kind` as a place.
fn place(key: &str) -> Place {
    key.replace("[]", ".[]").split('.').map(str::to_owned).collect()
}

/// Whether a documented place, `{name}` standing for any key, is this one.
fn fits(documented: &[String], found: &[String]) -> bool {
    let fits = |(pattern, key): (&String, &String)| pattern == key || pattern.starts_with('{') && key != "[]";
    documented.len() == found.len() && documented.iter().zip(found).all(fits)
}

/// All places of a plan but those that other pages describe.
fn gather(value: &Value, here: &Place, found: &mut BTreeSet<Place>) {
    let step = |key: &str| here.iter().cloned().chain([key.to_owned()]).collect::<Place>();
    if here.len() > 2
        && (here[..2].join(".") == ELSEWHERE[0] || here.last().is_some_and(|key| key == ELSEWHERE[1]))
    {
        return;
    }
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| {
            found.insert(step(key));
            gather(value, &step(key), found);
        }),
        Value::Array(items) => items.iter().for_each(|item| gather(item, &step("[]"), found)),
        _ => {}
    }
}

/// Problems and plugins whose plans together have every key.
const PLANS: [&str; 4] = [
    "plan sphere -o plan.json",
    "plan sphere --use stability-test=equilibrium -o plan.json",
    "plan ellip-obst -o plan.json",
    "plan mine.toml -o plan.json",
];

/// A ball, free fingertips, a given workspace, and a plate close by, which is then one of the nearest bodies.
fn with_a_plate_and_a_workspace() -> String {
    let files = regrasp::run::scenario::SCENARIOS;
    let ball = files.iter().find(|file| file.name == "sphere-free").expect("a built-in scenario");
    let plate = "[[obstacle]]\nshape = { kind = \"box\", size = [0.2, 0.2, 0.01] }\npose = { position = \
        [0.0, 0.0, 0.049] }\n\n\
                 [workspace]\nlower = [-0.02, -0.02, 0.08]\nupper = [0.02, 0.02, 0.1]\n\n[start]";
    assert_eq!(ball.text.matches("[start]").count(), 1);
    ball.text.replace("[start]", plate)
}

fn plans() -> Vec<Value> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("mine.toml"), with_a_plate_and_a_workspace())
        .expect("the folder is ours");
    let plan = |arguments: &&str| {
        printed(folder.path(), arguments);
        read(&folder.path().join("plan.json"))
    };
    PLANS.iter().map(plan).collect()
}

/// A plan with all that plans of this version may hold, also what built-in problems do not need.
fn full(plan: &Value) -> Value {
    let mut plan: Plan = serde_json::from_value(plan.clone()).expect("a plan has the format's form");
    let twin = ContactSurface { vertices: vec![], facets: vec![], digest: String::new(), bound: 0.0 };
    plan.object.get_or_insert_default().contact_surface = Some(twin);
    let edge = EdgeRecord { tangential: [0.5, 0.0], torsion: 0.0 };
    let grain = GrainClaim { mu_across: 0.25, axis_O: [0.0, 0.0, 1.0] };
    let cone = ConeClaim { grain: Some(grain), ..ConeClaim::round(0.5, 0.0) };
    plan.claims.contact.cone = Some(cone);
    plan.claims.contact.cones = vec![ConeRecord::Elliptic(cone), ConeRecord::Polyhedral(vec![edge])];
    plan.notes.insert(Slot::Sampler, [("hits".to_owned(), Figure::one(1.0))].into());
    let figure = || Extreme::new(1.0, Default::default(), HoldsAt::EveryState);
    if let Some(certificate) = &mut plan.certificate {
        let pair = (Body::Fingertip(FingerIndex(0)), Body::Obstacle(0));
        certificate.clearance.as_mut().expect("a plan has a clearance").place.pair = Some(pair);
        certificate.holds =
            Some(Holds { friction: figure(), mass: figure(), disturbance: figure(), effort: Some(figure()) });
    }
    let state = &mut plan.segments[0].states[0];
    state.velocities = Some(state.joints.clone());
    state.cones = Some(vec![Some(0)]);
    state.forces = Some(vec![Some([0.0; 3])]);
    serde_json::to_value(plan).expect("a plan can be written")
}

fn read(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).expect("the plan was written");
    serde_json::from_str(&text).expect("a plan is JSON")
}

#[test]
fn every_key_of_a_plan_is_documented_and_every_documented_key_occurs() {
    let documented = documented();
    let mut found = BTreeSet::new();
    let mut plans = plans();
    plans.push(full(&plans[0]));
    for plan in plans {
        gather(&plan, &Place::new(), &mut found);
        scenario_and_hand_are_as_their_pages_say(&plan["scenario"]["problem"]);
    }
    for found in &found {
        let known = documented.iter().any(|known| fits(known, found));
        assert!(known, "`{}` is missing in book/src/reference/plan-file.md", found.join("."));
    }
    for known in &documented {
        let occurs = found.iter().any(|found| fits(known, found));
        assert!(occurs, "`{}` in book/src/reference/plan-file.md is in no plan", known.join("."));
    }
}

/// What the page says of `scenario.problem`: its keys are those of scenario files and hand files.
fn scenario_and_hand_are_as_their_pages_say(problem: &Value) {
    let schema = |text: String| serde_json::from_str::<Value>(&text).expect("a schema is JSON");
    let hand = schema(regrasp::run::scenario::hand_schema());
    assert_eq!(check_schema(&problem["hand"], &hand), Ok(()));
    let mut rest: Map<String, Value> = problem.as_object().expect("a problem has keys").clone();
    rest.insert("hand".into(), json!({ "builtin": "four-finger" }));
    let scenario = schema(regrasp::run::scenario::schema());
    assert_eq!(check_schema(&Value::Object(rest), &scenario), Ok(()));
}

#[test]
fn documented_places_are_told_apart() {
    let fit = |pattern: &str, key: &[&str]| {
        fits(&place(pattern), &key.iter().map(ToString::to_string).collect::<Place>())
    };
    assert!(fit(
        "statistics.plugins.{slot}.calls",
        &["statistics", "plugins", "local-planner.transfer", "calls"]
    ));
    assert!(fit("segments[].kind", &["segments", "[]", "kind"]));
    assert!(!fit("segments[].kind", &["segments", "[]", "states"]) && !fit("{any}", &["[]"]));
}
