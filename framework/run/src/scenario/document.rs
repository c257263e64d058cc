//! A TOML or JSON file as plain data that remembers its lines.

use super::{Place, ScenarioError, json};
use regrasp_api::{KeyPath, Refusal, Refuse, Step, check_schema};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A parsed file.
#[derive(Clone)]
pub struct Document {
    file: String,
    text: String,
    value: Value,
    /// Where each key path begins (byte offset).
    offsets: BTreeMap<String, usize>,
}

impl Document {
    /// Parses `text`, as JSON where it begins with a brace and as TOML otherwise; refuses wrong syntax, and
    /// any number that is NaN, infinite or too large.
    pub fn parse(file: &str, text: &str) -> Result<Self, ScenarioError> {
        let mut document = Self {
            file: file.to_owned(),
            text: text.to_owned(),
            value: Value::Null,
            offsets: BTreeMap::new(),
        };
        if is_json(text) {
            document.value = serde_json::from_str(text).map_err(|error| document.json_syntax(&error))?;
            document.offsets = json::offsets(text);
            return Ok(document);
        }
        let table = DeTable::parse(text).map_err(|error| document.syntax(&error))?;
        document.value = document.convert_table(table.get_ref(), &KeyPath::default())?;
        Ok(document)
    }

    /// Gives a key of the outermost table a value where the file has none.
    pub(super) fn fill(&mut self, key: &str, value: Value) {
        if let Value::Object(table) = &mut self.value {
            table.entry(key).or_insert(value);
        }
    }

    /// Puts a mesh's file in the place of the object's shape; the scale of a mesh stays.
    pub(super) fn put_mesh(&mut self, file: &Path) {
        let Some(Value::Object(object)) = self.value.get_mut("object") else { return };
        let scale = object.get("shape").and_then(|shape| shape.get("scale")).cloned();
        let mut shape = Map::new();
        shape.insert("kind".into(), "mesh".into());
        shape.insert("file".into(), file.to_string_lossy().into());
        shape.extend(scale.map(|scale| ("scale".to_owned(), scale)));
        object.insert("shape".into(), Value::Object(shape));
    }

    /// The data as a `T`, after a comparison with its schema, which gives the better messages.
    pub fn read<T: DeserializeOwned + schemars::JsonSchema>(&self) -> Result<T, ScenarioError> {
        let schema = schemars::schema_for!(T).to_value();
        check_schema(&self.value, &schema).map_err(|departure| {
            let place = self.place(&departure.path);
            ScenarioError::Form { place, fault: departure.fault }
        })?;
        serde_json::from_value(self.value.clone())
            .map_err(|error| self.refuse(&KeyPath::default(), error.to_string()))
    }

    /// The tables of a list in turn, each compared with its schema by itself; nothing else may stand beside
    /// the list.
    pub(super) fn rows<T: DeserializeOwned + schemars::JsonSchema>(
        &self,
        key: &str,
    ) -> Result<Vec<Result<T, ScenarioError>>, ScenarioError> {
        let schema = schemars::schema_for!(T).to_value();
        let list = KeyPath::default().key(key);
        let table = self.value.as_object();
        if let Some(other) = table.and_then(|table| table.keys().find(|other| *other != key)) {
            let message = format!("`{other}` is unknown here; the file holds `{key}` tables alone");
            return Err(self.refuse(&KeyPath::default().key(other), message));
        }
        let Some(Value::Array(rows)) = self.value.get(key) else {
            return Err(self.refuse(&list, format!("give a `[[{key}]]` table for each {key}")));
        };
        let row = |(number, row): (usize, &Value)| {
            let at = list.item(number);
            check_schema(row, &schema).map_err(|departure| {
                let path = KeyPath(at.0.iter().cloned().chain(departure.path.0).collect());
                ScenarioError::Form { place: self.place(&path), fault: departure.fault }
            })?;
            serde_json::from_value(row.clone()).map_err(|error| self.refuse(&at, error.to_string()))
        };
        Ok(rows.iter().enumerate().map(row).collect())
    }

    /// The place of a key, or of the innermost table around it that the file has.
    pub fn place(&self, path: &KeyPath) -> Box<Place> {
        let known = (1..=path.0.len()).rev().map(|n| KeyPath(path.0[..n].to_vec()));
        let offset = known.into_iter().find_map(|path| self.offsets.get(&path.to_string()));
        let mut place = self.place_at(offset.copied());
        place.key = path.to_string();
        place
    }

    /// Whether the file has this key.
    pub fn has(&self, path: &KeyPath) -> bool {
        self.offsets.contains_key(&path.to_string())
    }

    /// A refusal of the value at `path`.
    pub fn refuse(&self, path: &KeyPath, message: String) -> ScenarioError {
        self.refused(&Refusal::new("value", &message).key(path))
    }

    /// A refusal with the place of its key.
    pub fn refused(&self, error: &impl Refuse) -> ScenarioError {
        let refusal = error.refusal();
        let place = self.place(&key_path(refusal.key.as_deref().unwrap_or_default()));
        ScenarioError::Value { place, refusal: Box::new(refusal) }
    }

    fn place_at(&self, offset: Option<usize>) -> Box<Place> {
        let Some(offset) = offset else { return Place::file(&self.file) };
        let line = self.text[..offset.min(self.text.len())].matches('\n').count();
        let excerpt = self.text.lines().nth(line).unwrap_or_default().trim_end();
        // A line of thousands of characters, as of a mesh, would bury the message.
        let excerpt = excerpt.chars().take(120).collect();
        Box::new(Place { file: self.file.clone(), key: String::new(), line: Some(line + 1), excerpt })
    }

    fn syntax(&self, error: &toml::de::Error) -> ScenarioError {
        let place = self.place_at(error.span().map(|span| span.start));
        ScenarioError::Syntax { language: "TOML", place, message: error.message().to_owned() }
    }

    fn json_syntax(&self, error: &serde_json::Error) -> ScenarioError {
        let before = self.text.split_inclusive('\n').take(error.line().saturating_sub(1));
        let place = self.place_at(Some(before.map(str::len).sum()));
        // The parser's own words end with line and column, which the place has.
        let message = error.to_string();
        let words = message.split(" at line ").next().unwrap_or(&message);
        ScenarioError::Syntax { language: "JSON", place, message: words.to_owned() }
    }

    fn convert_table(&mut self, table: &DeTable<'_>, path: &KeyPath) -> Result<Value, ScenarioError> {
        let mut object = Map::new();
        for (key, value) in table {
            let path = path.key(key.get_ref());
            self.offsets.insert(path.to_string(), key.span().start);
            object.insert(key.get_ref().to_string(), self.convert(value, &path)?);
        }
        Ok(Value::Object(object))
    }

    fn convert(&mut self, value: &Spanned<DeValue<'_>>, path: &KeyPath) -> Result<Value, ScenarioError> {
        match value.get_ref() {
            DeValue::String(text) => Ok(Value::from(text.as_ref())),
            DeValue::Boolean(yes) => Ok(Value::from(*yes)),
            DeValue::Datetime(date) => Ok(Value::from(date.to_string())),
            DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
                Ok(number) => Ok(Value::from(number)),
                Err(_) => Err(self.out_of_range(path, number.as_str(), "what 64 bits hold")),
            },
            DeValue::Float(number) => match number.as_str().parse::<f64>() {
                Ok(finite) if finite.is_finite() => Ok(Value::from(finite)),
                _ => Err(self.out_of_range(path, number.as_str(), "the finite numbers")),
            },
            DeValue::Table(table) => self.convert_table(table, path),
            DeValue::Array(items) => {
                let convert = |(i, item): (usize, &Spanned<DeValue<'_>>)| {
                    let path = path.item(i);
                    self.offsets.insert(path.to_string(), item.span().start);
                    self.convert(item, &path)
                };
                items.iter().enumerate().map(convert).collect()
            }
        }
    }

    fn out_of_range(&self, path: &KeyPath, value: &str, range: &str) -> ScenarioError {
        ScenarioError::Range { place: self.place(path), value: value.to_owned(), range: range.to_owned() }
    }
}

/// Whether a file is JSON; no TOML file begins with a brace.
pub fn is_json(text: &str) -> bool {
    text.trim_start().starts_with('{')
}

/// Reads a path as it is written in messages: `goal[1].pose`.
pub fn key_path(text: &str) -> KeyPath {
    let mut steps = Vec::new();
    for part in text.split('.') {
        let mut pieces = part.split(['[', ']']).filter(|piece| !piece.is_empty());
        steps.extend(pieces.next().map(|key| Step::Key(key.to_owned())));
        steps.extend(pieces.filter_map(|item| item.parse().ok()).map(Step::Item));
    }
    KeyPath(steps)
}
