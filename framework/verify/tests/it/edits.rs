//! Whatever a plan holds, there is a verdict: random edits of the file that still parse.

use crate::common;

use proptest::prelude::*;
use regrasp_plan::{Plan, from_json};
use regrasp_verify::verify;
use serde_json::Value;
use std::path::Path;

/// One edit: which number of the file (as a fraction of all), and what becomes of it.
#[derive(Clone, Debug)]
struct Edit {
    place: f64,
    change: Change,
}

#[derive(Clone, Debug)]
enum Change {
    Set(f64),
    Scale(f64),
    Remove,
    Repeat,
}

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let odd = prop::sample::select(vec![0.0, -1.0, 1.0, 3.0, 255.0, 1e-300, 1e-9, 1e5, 1e9, 1e300, -1e300]);
    let change = prop_oneof![
        odd.prop_map(Change::Set),
        (-3.0..3.0).prop_map(Change::Scale),
        Just(Change::Remove),
        Just(Change::Repeat),
    ];
    prop::collection::vec((0.0..1.0, change).prop_map(|(place, change)| Edit { place, change }), 1..4)
}

/// The paths of all numbers and arrays below a value.
fn places(value: &Value, path: &str, all: &mut Vec<String>) {
    match value {
        Value::Number(_) => all.push(path.into()),
        Value::Array(items) => {
            all.push(path.into());
            items.iter().enumerate().for_each(|(i, item)| places(item, &format!("{path}/{i}"), all));
        }
        Value::Object(items) => {
            items.iter().for_each(|(key, item)| places(item, &format!("{path}/{key}"), all))
        }
        _ => {}
    }
}

fn apply(plan: &mut Value, edit: &Edit) {
    let mut all = Vec::new();
    places(plan, "", &mut all);
    let place = plan.pointer_mut(&all[(edit.place * all.len() as f64) as usize]).unwrap();
    match (place, &edit.change) {
        (Value::Array(items), Change::Remove) => drop(items.pop()),
        (Value::Array(items), _) => items.extend(items.first().cloned()),
        (number, change) => {
            let was = number.as_f64().unwrap_or(0.0);
            let is = match change {
                Change::Set(value) => *value,
                Change::Scale(factor) => was * factor,
                Change::Remove => 0.0,
                Change::Repeat => -was,
            };
            // Counts and indices stay whole numbers, else the file would not parse.
            *number = if number.is_f64() { is.into() } else { (is as i64).into() };
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]
    #[test]
    fn edited_plans_get_a_verdict(edits in edits()) {
        thread_local!(static GOOD: Value = serde_json::to_value(common::plan(1)).unwrap());
        let mut value = GOOD.with(Clone::clone);
        edits.iter().for_each(|edit| apply(&mut value, edit));
        if let Ok(plan) = from_json(value.to_string().as_bytes(), Path::new("edited")) {
            let plan: Plan = plan;
            let verdict = verify(&plan);
            prop_assert_eq!(verdict.valid, verdict.failures().count() == 0);
            prop_assert!(verdict.certificate.is_some() || verdict.checks.len() == 1);
        }
    }
}
