//! What a missing key could look like.

use serde_json::Value;

/// The key of a schema under which a property has an example of itself, as the lines of a TOML file.
pub const EXAMPLE_KEY: &str = "x-example";

/// A property as it could stand in a TOML file: its own example, or its first value among `examples`.
pub fn example(key: &str, property: &Value) -> Option<String> {
    let lines = property.get(EXAMPLE_KEY).and_then(Value::as_str).map(str::to_owned);
    // Numbers, texts and lists of them are written alike in JSON and TOML.
    let first = property.get("examples").and_then(|examples| examples.get(0));
    let value = first.filter(|value| !value.is_object()).map(|value| format!("{key} = {value}"));
    lines.or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn lines_come_before_values() {
        let both = json!({"x-example": "[[goal]]\npose = {}", "examples": [3]});
        assert_eq!(example("goal", &both).as_deref(), Some("[[goal]]\npose = {}"));
        assert_eq!(example("mass", &json!({"examples": [0.1, 0.2]})).as_deref(), Some("mass = 0.1"));
        assert_eq!(example("name", &json!({"examples": ["ball"]})).as_deref(), Some("name = \"ball\""));
        assert_eq!(example("pose", &json!({"examples": [{"a": 1}]})), None);
        assert_eq!(example("pose", &json!({})), None);
    }
}
