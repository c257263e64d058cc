//! Pages of the keys of files, from their JSON schemas: a section a table, in the order in which the tables
//! are met.

use super::GENERATED;
use super::examples::Examples;
use super::markdown::{code, heading, lines, prose, table};
use crate::property::{Property, meaning};
use serde_json::Value;
use std::collections::BTreeMap;

/// A page.
pub struct Page<'a> {
    pub introduction: &'a str,
    pub chapters: &'a [Chapter<'a>],
}

/// One kind of file.
pub struct Chapter<'a> {
    pub title: &'a str,
    /// With what the anchors begin.
    pub name: &'a str,
    pub schema: Value,
    pub examples: Examples,
}

impl Page<'_> {
    pub fn text(&self) -> String {
        let mut text = format!("{GENERATED}{}\n", self.introduction);
        for (number, chapter) in self.chapters.iter().enumerate() {
            if number > 0 {
                text += &heading(2, chapter.title, &format!("{}-files", chapter.name));
                text += &format!("{}\n\n", prose(&meaning(&chapter.schema)));
            }
            // A page's first chapter has the page's title.
            text += &chapter.text(if number > 0 { 3 } else { 2 });
        }
        text
    }
}

/// A table of the file: where it stands, what its keys are.
struct Section<'a> {
    /// The paths at which it occurs, such as `start.pose` and `goal.pose`; the first is its title.
    paths: Vec<String>,
    /// How the first path is written in a file: `[start.pose]` or `[[goal]]`.
    list: bool,
    schema: &'a Value,
}

impl Chapter<'_> {
    /// The chapter with sections at this level of headings.
    fn text(&self, level: usize) -> String {
        let mut sections: Vec<Section<'_>> = Vec::new();
        let mut known = BTreeMap::new();
        gather(&self.schema, &self.schema, "", &mut sections, &mut known);
        let mut text = self.keys(&self.schema, &[String::new()], &sections);
        for section in &sections {
            text += &self.section(section, level, &sections);
        }
        text
    }

    fn section(&self, section: &Section<'_>, level: usize, all: &[Section<'_>]) -> String {
        let path = &section.paths[0];
        let title = if section.list { format!("`[[{path}]]`") } else { format!("`[{path}]`") };
        let mut text = heading(level, &title, &self.anchor(path));
        text += &format!("{}\n\n", prose(&meaning(section.schema)));
        if let [_, others @ ..] = section.paths.as_slice()
            && !others.is_empty()
        {
            let others: Vec<String> = others.iter().map(|path| code(path)).collect();
            text += &format!("The same for {}.\n\n", others.join(", "));
        }
        match section.schema.get("oneOf").and_then(Value::as_array) {
            Some(kinds) => {
                text += &kinds.iter().map(|kind| self.kind(kind, &section.paths, all)).collect::<String>()
            }
            None => text += &self.keys(section.schema, &section.paths, all),
        }
        text
    }

    /// One alternative of a table with a `kind`.
    fn kind(&self, schema: &Value, paths: &[String], all: &[Section<'_>]) -> String {
        let word = schema["properties"]["kind"]["const"].as_str().unwrap_or_default();
        let paths: Vec<String> = paths.iter().map(|path| format!("{path}({word})")).collect();
        let title = format!("**`kind = \"{word}\"`** {}\n\n", prose(&meaning(schema)));
        title + &self.keys(schema, &paths, all)
    }

    /// The table of the keys of a table that occurs at `paths`.
    fn keys(&self, schema: &Value, paths: &[String], all: &[Section<'_>]) -> String {
        let properties = schema.get("properties").and_then(Value::as_object);
        let required: Vec<&str> = schema
            .get("required")
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .collect();
        let given = |key: &str| key != "kind" || schema["properties"][key].get("const").is_none();
        let row = |(key, value): (&String, &Value)| {
            let property = Property::new(value, &self.schema);
            let needed = required.contains(&key.as_str());
            vec![
                code(key),
                lines(&[self.kind_of(property, &join(&paths[0], key), all), property.range_and_unit()]),
                if needed { "*required*".into() } else { self.default(property) },
                lines(&[prose(&property.meaning()), self.example(property, paths, key)]),
            ]
        };
        let rows: Vec<Vec<String>> =
            properties.into_iter().flatten().filter(|(key, _)| given(key)).map(row).collect();
        let mut text = table(&["key", "type, range", "default", "meaning, example"], &rows);
        if schema.get("additionalProperties") == Some(&Value::Bool(true)) {
            text += "Further keys are the plugin's settings: [plugins and settings](plugins.md) has them \
                all.\n\n";
        }
        text
    }

    /// The type; a table's is a link to its section.
    fn kind_of(&self, property: Property<'_>, path: &str, all: &[Section<'_>]) -> String {
        let path = path
            .split('(')
            .map(|part| part.split_once(')').map_or(part, |(_, rest)| rest))
            .collect::<String>();
        let kind = property.kind();
        let section = all.iter().find(|section| section.paths.contains(&path));
        match section.map(|section| self.anchor(&section.paths[0])) {
            Some(anchor) => format!("[{kind}](#{anchor})"),
            None => kind,
        }
    }

    /// A table's defaults stand with its own keys.
    fn default(&self, property: Property<'_>) -> String {
        if property.kind() == "table" { String::new() } else { code(&property.default()) }
    }

    fn example(&self, property: Property<'_>, paths: &[String], key: &str) -> String {
        let found = || paths.iter().find_map(|path| self.examples.get(&join(path, key)).cloned());
        let value = property.example().or_else(found).or_else(|| Some(property.default()));
        let plain = !property.kind().contains("table");
        let value = value.filter(|value| plain && !value.is_empty());
        value.map(|value| code(&format!("{key} = {value}"))).unwrap_or_default()
    }

    fn anchor(&self, path: &str) -> String {
        format!("{}-{}", self.name, path.replace(['.', '_'], "-"))
    }
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

/// Finds the tables below one, depth first; a definition that occurs again is given its further path only.
fn gather<'a>(
    root: &'a Value,
    schema: &'a Value,
    path: &str,
    sections: &mut Vec<Section<'a>>,
    known: &mut BTreeMap<&'a str, usize>,
) {
    let kinds = schema.get("oneOf").and_then(Value::as_array).into_iter().flatten();
    for part in kinds.chain([schema]) {
        for (key, value) in part.get("properties").and_then(Value::as_object).into_iter().flatten() {
            let property = Property::new(value, root);
            let items = property.items().filter(|items| items.definition().is_some());
            let inner = items.unwrap_or(property);
            let Some(name) = inner.definition().filter(|_| inner.words().is_empty()) else { continue };
            let path = join(path, key);
            let first = *known.entry(name).or_insert(sections.len());
            match sections.get_mut(first) {
                Some(section) => section.paths.push(path.clone()),
                None => sections.push(Section {
                    paths: vec![path.clone()],
                    list: items.is_some(),
                    schema: inner.target(),
                }),
            }
            gather(root, inner.target(), &path, sections, known);
        }
    }
}
