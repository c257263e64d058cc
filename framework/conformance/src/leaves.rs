//! The settings in a schema, nested ones, optional ones and items of lists included.

use serde_json::{Map, Value, json};

/// A number among the settings.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Leaf {
    /// The keys that lead to it.
    pub path: Vec<String>,
    /// Whether it is a whole number.
    pub integer: bool,
    /// Whether it may be absent, as `null`.
    pub optional: bool,
    /// The list whose first item it is, as it is by default; absent where it is no item.
    list: Option<Vec<Value>>,
}

impl Leaf {
    /// Its name in messages, such as `inner.weights`.
    pub fn name(&self) -> String {
        self.path.join(".")
    }

    /// Settings with this value, all others left to their defaults.
    pub fn with(&self, value: Value) -> Value {
        let value = match &self.list {
            Some(items) => {
                let mut items = items.clone();
                items[0] = value;
                Value::Array(items)
            }
            None => value,
        };
        nested(&self.path, value)
    }
}

/// A value behind the keys that lead to it.
pub(crate) fn nested(path: &[String], value: Value) -> Value {
    path.iter().rev().fold(value, |inner, key| json!({ key.as_str(): inner }))
}

/// All numbers of a schema.
pub(crate) fn leaves(schema: &Value) -> Vec<Leaf> {
    let mut found = Vec::new();
    walk(schema, schema, &mut Vec::new(), &mut |path, property| found.extend(leaf(schema, path, property)));
    found
}

/// The paths of all nested tables of a schema.
pub(crate) fn tables(schema: &Value) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    walk(schema, schema, &mut Vec::new(), &mut |path, property| {
        if resolved(schema, property).0["properties"].is_object() {
            found.push(path.to_vec());
        }
    });
    found
}

fn walk(root: &Value, table: &Value, path: &mut Vec<String>, look: &mut dyn FnMut(&[String], &Value)) {
    // Deeper than anybody nests settings, in case a schema refers to itself.
    if path.len() > 6 {
        return;
    }
    let properties: Map<String, Value> = table["properties"].as_object().cloned().unwrap_or_default();
    for (key, property) in &properties {
        path.push(key.clone());
        look(path, property);
        walk(root, resolved(root, property).0, path, look);
        path.pop();
    }
}

/// What a property refers to, and whether `null` is allowed.
fn resolved<'a>(root: &'a Value, property: &'a Value) -> (&'a Value, bool) {
    if let Some(name) = property["$ref"].as_str().and_then(|name| name.strip_prefix("#/$defs/")) {
        return resolved(root, &root["$defs"][name]);
    }
    let null = |choice: &&Value| choice["type"] == "null";
    match property["anyOf"].as_array() {
        Some(choices) => {
            let optional = choices.iter().any(|choice| null(&choice));
            let other = choices.iter().find(|choice| !null(choice)).unwrap_or(property);
            (resolved(root, other).0, optional)
        }
        None => (property, property["type"].as_array().is_some_and(|types| types.contains(&json!("null")))),
    }
}

fn leaf(root: &Value, path: &[String], property: &Value) -> Option<Leaf> {
    let (found, optional) = resolved(root, property);
    let (number, list) = match is(found, "array") {
        true => {
            let items = property.get("default")?.as_array().filter(|items| !items.is_empty())?.clone();
            (resolved(root, &found["items"]).0, Some(items))
        }
        false => (found, None),
    };
    let integer = is(number, "integer");
    (integer || is(number, "number")).then(|| Leaf { path: path.to_vec(), integer, optional, list })
}

/// Whether a schema allows values of a type.
fn is(schema: &Value, name: &str) -> bool {
    match &schema["type"] {
        Value::String(only) => only == name,
        Value::Array(types) => types.contains(&json!(name)),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_wherever_they_stand() {
        let schema = json!({
            "properties": {
                "plain": { "type": "number" },
                "maybe": { "type": ["integer", "null"] },
                "row": { "type": "array", "items": { "type": "number" }, "default": [1.0, 2.0] },
                "inner": { "$ref": "#/$defs/Inner" },
                "word": { "type": "string" },
            },
            "$defs": { "Inner": { "type": "object", "properties": { "deep": { "type": "number" } } } },
        });
        let found = leaves(&schema);
        let names: Vec<String> = found.iter().map(Leaf::name).collect();
        assert_eq!(names, ["inner.deep", "maybe", "plain", "row"]);
        assert_eq!(found[0].with(json!(7)), json!({ "inner": { "deep": 7 } }));
        assert!(found[1].optional && found[1].integer);
        assert_eq!(found[3].with(json!(7)), json!({ "row": [7, 2.0] }));
        assert_eq!(tables(&schema), [["inner"]]);
    }
}
