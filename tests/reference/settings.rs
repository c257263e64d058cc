//! Settings and keys: every one is described, and the ranges that the schemas state are those that are kept.

use regrasp::api::{Entry, Limits, UNIT_KEY, UNITS};
use regrasp::host::{Registry, settings_schema};
use serde_json::{Value, json};

/// Calls `look` with the path and schema of every property below `schema`.
fn properties<'a>(schema: &'a Value, path: &str, look: &mut impl FnMut(&str, &'a Value)) {
    match schema {
        Value::Object(map) => {
            for (key, value) in map.get("properties").and_then(Value::as_object).into_iter().flatten() {
                look(&format!("{path}.{key}"), value);
            }
            map.iter()
                .filter(|(key, _)| *key != "examples")
                .for_each(|(key, value)| properties(value, &format!("{path}/{key}"), look));
        }
        Value::Array(items) => items.iter().for_each(|item| properties(item, path, look)),
        _ => {}
    }
}

/// Whether the schema is that of a number, or of a list of numbers, that is not whole.
fn is_measured(schema: &Value) -> bool {
    schema.get("format") == Some(&json!("double")) || schema.get("items").is_some_and(is_measured)
}

fn assert_described(whole: &Value, name: &str) {
    let mut count = 0;
    properties(whole, name, &mut |path, schema| {
        count += 1;
        if schema.get("const").is_some() {
            return; // the word that tells alternatives apart; each alternative is described
        }
        let text = schema.get("description").and_then(Value::as_str).unwrap_or_default();
        assert!(text.len() > 4, "{path} has no description");
        let unit = schema.get(UNIT_KEY).and_then(Value::as_str);
        let first = unit.and_then(|unit| unit.split(';').next()).unwrap_or_default();
        assert!(
            !is_measured(schema) || UNITS.contains(&first),
            "{path}: {unit:?} is no unit; say `#[schemars(extend(\"x-unit\" = \"m\"))]`, or \"1\""
        );
    });
    assert!(count > 0, "{name} has no keys");
}

#[test]
fn every_key_of_every_file_is_described_with_its_unit() {
    let schemas = [
        ("scenario", regrasp::run::scenario::schema()),
        ("hand", regrasp::run::scenario::hand_schema()),
        ("study", regrasp::study::compare::study_schema()),
    ];
    for (name, schema) in schemas {
        assert_described(&serde_json::from_str(&schema).expect("a schema is JSON"), name);
    }
}

fn entries() -> Vec<(&'static Entry, Value)> {
    let registry = Registry::linked().expect("the built-in plugins have different ids");
    let with_schema = |entry| (entry, settings_schema(entry).expect("a schema without a fault"));
    let entries: Vec<(&'static Entry, Value)> = registry.entries().map(with_schema).collect();
    assert!(entries.len() > 20, "only {} plugins are linked", entries.len());
    entries
}

#[test]
fn every_setting_is_described_with_its_unit_and_its_range() {
    for (entry, schema) in entries() {
        if schema.get("properties").is_none() {
            continue;
        }
        assert_described(&schema, entry.id);
        properties(&schema, entry.id, &mut |path, schema| {
            let is_number = is_measured(schema) || schema.get("format").is_some();
            let has_range = schema.get("minimum").is_some() && schema.get("maximum").is_some();
            assert!(!is_number || has_range, "{path} states no range");
        });
    }
}

/// A number just below or above `bound`, in the direction of `sign`.
fn beyond(schema: &Value, bound: &Value, sign: f64) -> Option<Value> {
    let number = bound.as_f64().expect("a bound is a number");
    if schema["format"] == "double" {
        return Some(json!(number + sign * f64::max(1e-9 * number.abs(), 1e-15)));
    }
    let whole = bound.as_u64().map_or(number as i64, |bound| bound as i64) + sign as i64;
    (whole >= 0).then(|| json!(whole))
}

#[test]
fn plugins_keep_the_ranges_that_their_schemas_state() {
    let mut checked = 0;
    for (entry, schema) in entries() {
        for (key, property) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
            for (word, sign) in [("minimum", -1.0), ("maximum", 1.0)] {
                let Some(bound) = property.get(word) else { continue };
                let with = |value: &Value| (entry.check)(&json!({ key: value }).to_string());
                assert!(with(bound).is_ok(), "{}: {key} = {bound}: {:?}", entry.id, with(bound));
                if let Some(outside) = beyond(property, bound, sign) {
                    assert!(with(&outside).is_err(), "{}: {key} = {outside} is taken", entry.id);
                }
                checked += 1;
            }
        }
    }
    assert!(checked > 100, "only {checked} bounds were found");
}

#[test]
fn scenarios_keep_the_ranges_of_limits_that_the_schema_states() {
    let schema: Value = serde_json::from_str(&regrasp::run::scenario::schema()).expect("a schema is JSON");
    let mut checked = 0;
    for (table, definition) in
        [("tolerances", "Tolerances"), ("resolution", "Resolution"), ("budget", "Budget")]
    {
        for (key, property) in schema["$defs"][definition]["properties"].as_object().expect("keys") {
            for (word, sign) in [("minimum", -1.0), ("maximum", 1.0)] {
                let Some(bound) = property.get(word) else { continue };
                let with = |value: &Value| {
                    let limits: Limits =
                        serde_json::from_value(json!({ table: { key: value } })).expect("limits");
                    regrasp::world::check_limits(&limits)
                };
                assert!(with(bound).is_ok(), "{table}.{key} = {bound}: {:?}", with(bound));
                if let Some(outside) = beyond(property, bound, sign) {
                    assert!(with(&outside).is_err(), "{table}.{key} = {outside} is taken");
                }
                checked += 1;
            }
        }
    }
    assert!(checked > 30, "only {checked} bounds were found");
}
