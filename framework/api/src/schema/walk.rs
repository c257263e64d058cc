//! Compares plain data with a JSON schema, so that a misspelt key or a wrong type is reported with its place
//! and its likely meaning.
//!
//! Serde's own messages lose the path inside tagged enumerations; this walk keeps it. It knows the part of
//! JSON Schema that `schemars` writes for plain structs, options, arrays and tagged enumerations; what it
//! does not know it lets pass, for serde to judge.

use crate::{Departure, Fault, KeyPath, Range, example, near, unit};
use serde_json::{Map, Value};

/// Finds the first place, in the order of the keys, where `value` departs from `schema`.
pub fn check_schema(value: &Value, schema: &Value) -> Result<(), Departure> {
    check_below(value, (schema, schema), &KeyPath::default())
}

/// The same for a schema within `root`, whose definitions it refers to; `path` is where the value stands.
pub(super) fn check_below(
    value: &Value,
    (schema, root): (&Value, &Value),
    path: &KeyPath,
) -> Result<(), Departure> {
    Walk { root }.check(value, schema, path)
}

/// Adds the schema's defaults for keys that `settings` leaves out, in tables within it too. A key that is
/// there with `null` stays: so an option that has a default is unset.
pub fn fill_defaults(settings: &mut Map<String, Value>, schema: &Value) {
    let properties = schema.get("properties").and_then(Value::as_object);
    for (key, property) in properties.into_iter().flatten() {
        if let Some(default) = property.get("default") {
            fill(settings, key, default);
        }
    }
}

/// The default where nothing is given, and its keys where a table is.
fn fill(settings: &mut Map<String, Value>, key: &str, default: &Value) {
    match (settings.get_mut(key), default) {
        (None, default) => {
            settings.insert(key.to_owned(), default.clone());
        }
        (Some(Value::Object(given)), Value::Object(default)) => {
            default.iter().for_each(|(key, value)| fill(given, key, value));
        }
        _ => {}
    }
}

struct Walk<'a> {
    root: &'a Value,
}

impl<'a> Walk<'a> {
    fn check(&self, value: &Value, schema: &'a Value, path: &KeyPath) -> Result<(), Departure> {
        let schema = self.resolve(schema);
        let alternatives = ["oneOf", "anyOf"].iter().find_map(|word| schema.get(word)?.as_array());
        if let Some(alternatives) = alternatives {
            return self.check_alternatives(value, alternatives, path);
        }
        check_type(value, schema, path)?;
        match value {
            Value::Object(object) => self.check_object(object, schema, path),
            Value::Array(items) => self.check_items(items, schema, path),
            _ => Ok(()),
        }
    }

    fn resolve(&self, schema: &'a Value) -> &'a Value {
        let name = schema.get("$ref").and_then(Value::as_str).and_then(|r| r.strip_prefix("#/$defs/"));
        name.and_then(|name| self.root.get("$defs")?.get(name)).unwrap_or(schema)
    }

    fn check_object(
        &self,
        object: &Map<String, Value>,
        schema: &'a Value,
        path: &KeyPath,
    ) -> Result<(), Departure> {
        // A struct without fields has no `properties` at all.
        let none = Map::new();
        let properties = schema.get("properties").and_then(Value::as_object);
        let closed = schema.get("additionalProperties") == Some(&Value::Bool(false));
        for (key, value) in object {
            match properties.and_then(|properties| properties.get(key)) {
                Some(property) => self.check(value, property, &path.key(key))?,
                None if closed => return Err(unknown_key(key, properties.unwrap_or(&none), path)),
                None => {}
            }
        }
        let required = schema.get("required").and_then(Value::as_array).into_iter().flatten();
        match required.filter_map(Value::as_str).find(|&key| !object.contains_key(key)) {
            Some(key) => {
                let property = properties.and_then(|properties| properties.get(key));
                let example = property.and_then(|property| example(key, property));
                Err(depart(path, Fault::Missing { key: key.to_owned(), example }))
            }
            None => Ok(()),
        }
    }

    fn check_items(&self, items: &[Value], schema: &'a Value, path: &KeyPath) -> Result<(), Departure> {
        let bound = |word: &str| schema.get(word).and_then(Value::as_u64).map(|n| n as usize);
        let (low, high) = (bound("minItems"), bound("maxItems"));
        if low.is_some_and(|low| items.len() < low) || high.is_some_and(|high| items.len() > high) {
            let expected = match (low, high) {
                (Some(low), Some(high)) if low == high => format!("a list of {low} values"),
                (low, None) => format!("a list of at least {} values", low.unwrap_or(0)),
                (low, Some(high)) => format!("a list of {} to {high} values", low.unwrap_or(0)),
            };
            let found = format!("a list of {} values", items.len());
            return Err(depart(path, Fault::Type { expected, found }));
        }
        let Some(item_schema) = schema.get("items") else { return Ok(()) };
        let check = |(i, item): (usize, &Value)| {
            let path = path.item(i);
            self.check(item, item_schema, &path).map_err(|departure| with_unit(departure, &path, schema))
        };
        items.iter().enumerate().try_for_each(check)
    }

    fn check_alternatives(
        &self,
        value: &Value,
        alternatives: &'a [Value],
        path: &KeyPath,
    ) -> Result<(), Departure> {
        let alternatives: Vec<&Value> = alternatives.iter().map(|schema| self.resolve(schema)).collect();
        if alternatives.iter().all(|schema| schema.get("const").is_some() || schema.get("enum").is_some()) {
            return check_words(value, &alternatives, path);
        }
        if let Some(tag) = alternatives.iter().find_map(|schema| tag_of(schema)) {
            return self.check_tagged(value, &alternatives, tag, path);
        }
        // A word or a table: each is judged as what it is.
        if let (Some(words), Some(table)) = (words_among(&alternatives), table_among(&alternatives)) {
            return self.check(value, if value.is_object() { table } else { words }, path);
        }
        // A word or a number likewise.
        if let (Some(words), Some(number)) = (words_among(&alternatives), number_among(&alternatives)) {
            return self.check(value, if value.is_string() { words } else { number }, path);
        }
        // What is left is an option: the value may be null or something else.
        let something = alternatives.iter().find(|schema| schema.get("type") != Some(&Value::from("null")));
        match something {
            Some(schema) if !value.is_null() => self.check(value, schema, path),
            _ => Ok(()),
        }
    }

    fn check_tagged(
        &self,
        value: &Value,
        alternatives: &[&'a Value],
        tag: &str,
        path: &KeyPath,
    ) -> Result<(), Departure> {
        let Some(object) = value.as_object() else {
            return Err(depart(path, Fault::Type { expected: "a table".into(), found: shown(value) }));
        };
        let Some(kind) = object.get(tag) else {
            return Err(depart(path, Fault::Missing { key: tag.to_owned(), example: None }));
        };
        let word = |schema: &Value| schema["properties"][tag].get("const").cloned();
        match alternatives.iter().find(|schema| word(schema).as_ref() == Some(kind)) {
            Some(schema) => self.check(value, schema, path),
            None => {
                let known = alternatives.iter().filter_map(|schema| word(schema)).collect();
                Err(depart(&path.key(tag), wrong_word(kind, known)))
            }
        }
    }
}

/// The alternative that lists words.
fn words_among<'a>(alternatives: &[&'a Value]) -> Option<&'a Value> {
    let is_word = |schema: &Value| schema.get("const").is_some() || schema.get("enum").is_some();
    let is_words = |schema: &&&Value| {
        let several = schema.get("oneOf").and_then(Value::as_array);
        is_word(schema) || several.is_some_and(|several| several.iter().all(is_word))
    };
    alternatives.iter().find(is_words).copied()
}

fn table_among<'a>(alternatives: &[&'a Value]) -> Option<&'a Value> {
    alternatives.iter().find(|schema| schema.get("type") == Some(&Value::from("object"))).copied()
}

fn number_among<'a>(alternatives: &[&'a Value]) -> Option<&'a Value> {
    alternatives.iter().find(|schema| schema.get("type") == Some(&Value::from("number"))).copied()
}

/// The key whose constant value tells the alternatives of a tagged enumeration apart.
fn tag_of(schema: &Value) -> Option<&str> {
    let properties = schema.get("properties")?.as_object()?;
    properties.iter().find(|(_, property)| property.get("const").is_some()).map(|(key, _)| key.as_str())
}

fn check_words(value: &Value, alternatives: &[&Value], path: &KeyPath) -> Result<(), Departure> {
    let words = alternatives.iter().flat_map(|schema| {
        let several = schema.get("enum").and_then(Value::as_array).into_iter().flatten();
        schema.get("const").into_iter().chain(several).cloned()
    });
    let words: Vec<Value> = words.collect();
    if words.contains(value) { Ok(()) } else { Err(depart(path, wrong_word(value, words))) }
}

fn wrong_word(value: &Value, words: Vec<Value>) -> Fault {
    let known: Vec<String> = words.iter().filter_map(Value::as_str).map(str::to_owned).collect();
    let near = near(value.as_str().unwrap_or_default(), known.iter().map(String::as_str));
    Fault::Choice { found: shown(value), near, known }
}

fn unknown_key(key: &str, properties: &Map<String, Value>, path: &KeyPath) -> Departure {
    let known: Vec<String> = properties.keys().cloned().collect();
    let near = near(key, known.iter().map(String::as_str));
    depart(&path.key(key), Fault::UnknownKey { near, known })
}

fn check_type(value: &Value, schema: &Value, path: &KeyPath) -> Result<(), Departure> {
    if schema.get("enum").is_some() || schema.get("const").is_some() {
        return check_words(value, &[schema], path);
    }
    let types: Vec<&str> = match schema.get("type") {
        Some(Value::String(one)) => vec![one],
        Some(Value::Array(several)) => several.iter().filter_map(Value::as_str).collect(),
        _ => return Ok(()),
    };
    if !types.iter().any(|&name| is_of_type(value, name)) {
        let expected = types.iter().filter(|&&name| name != "null").map(|&name| type_phrase(name));
        let expected = expected.collect::<Vec<_>>().join(" or ");
        return Err(depart(path, Fault::Type { expected, found: shown(value) }));
    }
    check_bounds(value, schema, path)
}

fn check_bounds(value: &Value, schema: &Value, path: &KeyPath) -> Result<(), Departure> {
    let bound = |word: &str| schema.get(word).and_then(Value::as_f64);
    let (low, high) = (bound("minimum"), bound("maximum"));
    let Some(number) = value.as_f64() else { return Ok(()) };
    if low.is_none_or(|low| number >= low) && high.is_none_or(|high| number <= high) {
        return Ok(());
    }
    let range = Range { low, high, unit: unit_of(schema) };
    Err(depart(path, Fault::Range { found: shown(value), range }))
}

/// The unit of a list's numbers stands in the list's schema.
fn with_unit(mut departure: Departure, item: &KeyPath, list: &Value) -> Departure {
    if let (true, Fault::Range { range, .. }) = (departure.path == *item, &mut departure.fault) {
        range.unit = unit_of(list);
    }
    departure
}

/// The unit of a schema's number; nothing where there is none, or where it depends on something else.
fn unit_of(schema: &Value) -> String {
    unit(schema).filter(|unit| !unit.contains(';')).unwrap_or_default().to_owned()
}

fn is_of_type(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "null" => value.is_null(),
        _ => true,
    }
}

fn type_phrase(name: &str) -> &str {
    match name {
        "object" => "a table",
        "array" => "a list",
        "string" => "a text",
        "boolean" => "`true` or `false`",
        "integer" => "a whole number",
        "number" => "a number",
        other => other,
    }
}

fn shown(value: &Value) -> String {
    match value {
        Value::Object(_) => "a table".into(),
        Value::Array(_) => "a list".into(),
        // As a person writes it: 5, not 5.0.
        Value::Number(number) if number.is_f64() => match number.as_f64().unwrap_or_default() {
            large if large.abs() >= 1e16 => format!("{large:e}"),
            number => number.to_string(),
        },
        other => other.to_string(),
    }
}

fn depart(path: &KeyPath, fault: Fault) -> Departure {
    Departure { path: path.clone(), fault }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Limits, ObjectDescription};
    use serde_json::json;

    fn schema_of<T: schemars::JsonSchema>() -> Value {
        schemars::schema_for!(T).to_value()
    }

    fn refusal<T: schemars::JsonSchema>(value: Value) -> String {
        check_schema(&value, &schema_of::<T>()).unwrap_err().to_string()
    }

    #[test]
    fn good_data_pass() {
        let ball = json!({"shape": {"kind": "sphere", "radius": 1}, "friction": 0.5});
        assert_eq!(check_schema(&ball, &schema_of::<ObjectDescription>()), Ok(()));
        let limits = json!({"budget": {"time_limit": 2.0}, "resolution": {"retreat": [0.1, 0.2]}});
        assert_eq!(check_schema(&limits, &schema_of::<Limits>()), Ok(()));
    }

    #[test]
    fn unknown_keys_are_placed_and_explained() {
        let text = refusal::<Limits>(json!({"budget": {"max_node": 5}}));
        assert_eq!(text, "`budget.max_node`: unknown key; did you mean `max_nodes`?");
        let ball = json!({"shape": {"kind": "sphere", "radius": 1, "radios": 2}, "friction": 0.5});
        assert!(
            refusal::<ObjectDescription>(ball).contains("`shape.radios`: unknown key; did you mean `radius`")
        );
    }

    #[test]
    fn a_struct_without_fields_has_no_keys() {
        let text = refusal::<crate::NoSettings>(json!({"edges": 3}));
        assert_eq!(text, "`edges`: unknown key; there are none here");
    }

    #[test]
    fn tags_types_and_missing_keys_are_explained() {
        let kind = |kind: &str| json!({"shape": {"kind": kind, "radius": 1}, "friction": 0.5});
        assert!(refusal::<ObjectDescription>(kind("shpere")).contains("did you mean `sphere`?"));
        let text = refusal::<ObjectDescription>(json!({"shape": {"kind": "sphere", "radius": 1}}));
        assert!(text.contains("`friction` is missing"), "{text}");
        let text =
            refusal::<ObjectDescription>(json!({"shape": {"kind": "sphere", "radius": "1"}, "friction": 1}));
        assert_eq!(text, "`shape.radius`: \"1\" is not a number");
        let text = refusal::<Limits>(json!({"resolution": {"retreat": [0.1]}}));
        assert_eq!(text, "`resolution.retreat`: a list of 1 values is not a list of 2 values");
        let text = refusal::<Limits>(json!({"budget": {"max_nodes": -1}}));
        assert_eq!(text, "`budget.max_nodes` = -1 is outside 1..=10000000");
        let text = refusal::<Limits>(json!({"resolution": {"lift": 5.0}}));
        assert_eq!(text, "`resolution.lift` = 5 is outside 0.0001..=0.2 m");
        let text = refusal::<Limits>(json!({"resolution": {"retreat": [0.1, -0.5]}}));
        assert_eq!(text, "`resolution.retreat[1]` = -0.5 is outside 0..=0.2 m");
        let text = refusal::<Limits>(json!({"budget": {"max_nodes": 1.5}}));
        assert_eq!(text, "`budget.max_nodes`: 1.5 is not a whole number");
    }

    #[test]
    fn a_word_or_a_table_is_judged_as_what_it_is() {
        let shape = json!({"kind": "sphere", "radius": 1});
        let with = |surface: Value| json!({"shape": shape, "friction": 0.5, "contact_surface": surface});
        let schema = schema_of::<ObjectDescription>();
        for good in [json!("auto"), json!("exact"), json!({"tolerance": 1e-4}), Value::Null] {
            assert_eq!(check_schema(&with(good), &schema), Ok(()));
        }
        let text = refusal::<ObjectDescription>(with(json!("exakt")));
        assert!(text.contains("did you mean `exact`?"), "{text}");
        let text = refusal::<ObjectDescription>(with(json!({"tolerance": 1})));
        assert!(text.contains("`contact_surface.tolerance` = 1 is outside"), "{text}");
        let text = refusal::<ObjectDescription>(with(json!({"tolerence": 1e-4})));
        assert!(text.contains("did you mean `tolerance`?"), "{text}");
    }

    #[test]
    fn defaults_fill_what_is_absent_and_keep_what_is_there() {
        let mut settings = Map::from_iter([("smoothing".to_owned(), json!(2))]);
        fill_defaults(&mut settings, &schema_of::<crate::Budget>());
        assert_eq!(Value::Object(settings), json!({"max_nodes": 1000, "smoothing": 2}));
    }
}
