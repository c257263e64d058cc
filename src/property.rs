//! What a JSON schema says of a key, in words: for the terminal and for the book's reference.

use regrasp::api::unit;
use serde_json::Value;

/// A key's schema, and the schema that it belongs to.
#[derive(Clone, Copy)]
pub struct Property<'a> {
    value: &'a Value,
    root: &'a Value,
}

impl<'a> Property<'a> {
    /// The key of this schema `value` in the schema `root`, which holds the definitions.
    pub fn new(value: &'a Value, root: &'a Value) -> Self {
        Self { value, root }
    }

    /// The schema of the value itself: behind references, and without the `null` of what can be omitted.
    pub fn target(self) -> &'a Value {
        let choices = self.value.get("anyOf").and_then(Value::as_array);
        let something = choices.and_then(|all| all.iter().find(|one| one.get("$ref").is_some()));
        let value = something.unwrap_or(self.value);
        self.definition().and_then(|name| self.root.get("$defs")?.get(name)).unwrap_or(value)
    }

    /// The name of the definition that the schema refers to.
    pub fn definition(self) -> Option<&'a str> {
        let choices = self.value.get("anyOf").and_then(Value::as_array).into_iter().flatten();
        let references = choices.chain([self.value]).filter_map(|one| one.get("$ref")?.as_str());
        references.filter_map(|text| text.strip_prefix("#/$defs/")).next()
    }

    /// The schema of a list's items.
    pub fn items(self) -> Option<Self> {
        self.value.get("items").map(|value| Self { value, root: self.root })
    }

    /// The allowed words of an enumeration of plain words; empty for anything else.
    pub fn words(self) -> Vec<&'a str> {
        let target = self.target();
        let word = |one: &'a Value| one.get("const").or(Some(one)).and_then(Value::as_str);
        let list = target.get("enum").or_else(|| target.get("oneOf")).and_then(Value::as_array);
        list.into_iter().flatten().filter_map(word).collect()
    }

    /// The type in words.
    pub fn kind(self) -> String {
        let words = self.words();
        if !words.is_empty() {
            return format!("one of `{}`", words.join("`, `"));
        }
        let target = self.target();
        let names: Vec<&str> = match target.get("type") {
            Some(Value::Array(several)) => several.iter().filter_map(Value::as_str).collect(),
            Some(one) => one.as_str().into_iter().collect(),
            None => vec!["object"],
        };
        match names.into_iter().find(|&name| name != "null") {
            Some("number") => "number".into(),
            Some("integer") => "whole number".into(),
            Some("string") => "text".into(),
            Some("boolean") => "`true` or `false`".into(),
            Some("array") => self.list(),
            _ => "table".into(),
        }
    }

    fn list(self) -> String {
        let count = |word: &str| self.value.get(word).and_then(Value::as_u64);
        let kind = self.items().map_or("anything".into(), Self::kind);
        let of = match kind.as_str() {
            "number" | "whole number" | "text" | "table" => format!("{kind}s"),
            _ => kind,
        };
        match (count("minItems"), count("maxItems")) {
            (Some(low), Some(high)) if low == high => format!("{low} {of}"),
            _ => format!("list of {of}"),
        }
    }

    /// The range as the schema states it, for a list that of its items; the empty text where it states no
    /// upper end.
    pub fn range(self) -> String {
        let own = self.items().filter(|_| self.value.get("maximum").is_none()).map(Self::range);
        if let Some(range) = own.filter(|range| !range.is_empty()) {
            return range;
        }
        let end = |key: &str| self.value.get(key).map(number);
        match (end("minimum"), end("exclusiveMinimum"), end("maximum")) {
            (Some(low), _, Some(high)) => format!("{low}..={high}"),
            (None, Some(low), Some(high)) => format!("above {low}, to {high}"),
            _ => String::new(),
        }
    }

    /// The number's unit, or that of a list's numbers.
    pub fn unit(self) -> &'a str {
        unit(self.value).unwrap_or_default()
    }

    /// Range and unit.
    pub fn range_and_unit(self) -> String {
        [self.range().as_str(), self.unit()].join(" ").trim().to_owned()
    }

    /// The value that an absent key stands for, as TOML; the empty text where there is none.
    pub fn default(self) -> String {
        self.value.get("default").map(toml_text).unwrap_or_default()
    }

    /// An example that the schema gives, as TOML.
    pub fn example(self) -> Option<String> {
        self.value.get("examples")?.get(0).map(toml_text)
    }

    /// The description on one line.
    pub fn meaning(self) -> String {
        meaning(self.value)
    }
}

/// A schema's description on one line, without the brackets of links between Rust's items.
pub fn meaning(schema: &Value) -> String {
    let text = schema.get("description").and_then(Value::as_str).unwrap_or_default();
    let text = text.replace("[`", "`").replace("`]", "`");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A number as a person writes it: 5, not 5.0, and 1e-7, not 0.0000001.
fn number(value: &Value) -> String {
    match value.as_f64().filter(|_| value.is_f64()) {
        Some(x) if x != 0.0 && (x.abs() < 1e-3 || x.abs() >= 1e6) => format!("{x:e}"),
        Some(x) => x.to_string(),
        None => value.to_string(),
    }
}

/// A value as TOML writes it; `null`, which TOML has not, and what is empty become the empty text.
pub fn toml_text(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) if text.is_empty() => String::new(),
        Value::Array(items) if items.is_empty() => String::new(),
        Value::Number(x)
            if x.is_f64() && x.as_f64() != Some(0.0) && x.as_f64().is_some_and(|x| x.abs() < 1e-3) =>
        {
            number(value)
        }
        Value::Object(_) => toml::Value::try_from(value).map(|value| value.to_string()).unwrap_or_default(),
        other => toml::Value::try_from(other).map(|value| value.to_string()).unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn numbers_lists_and_words_are_told_apart() {
        let root = json!({"$defs": {"Word": {"oneOf": [{"const": "a"}, {"const": "b"}]}}});
        let length = json!({"type": ["number", "null"], "minimum": 1e-7, "maximum": 5.0, "default": null, "x-unit": "m"});
        let length = Property::new(&length, &root);
        assert_eq!((length.kind().as_str(), length.range_and_unit().as_str()), ("number", "1e-7..=5 m"));
        assert_eq!(length.default(), "");
        let corner = json!({"type": "array", "minItems": 3, "maxItems": 3, "items": {"type": "number", "minimum": 0, "maximum": 1}});
        let corner = Property::new(&corner, &root);
        assert_eq!((corner.kind().as_str(), corner.range().as_str()), ("3 numbers", "0..=1"));
        let word = json!({"anyOf": [{"$ref": "#/$defs/Word"}, {"type": "null"}], "default": "a"});
        let word = Property::new(&word, &root);
        assert_eq!((word.kind().as_str(), word.default().as_str()), ("one of `a`, `b`", "\"a\""));
    }
}
