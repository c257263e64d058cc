//! Examples of keys, taken from files that are kept with the program: they are read by its tests, so they are
//! right.

use std::collections::BTreeMap;

/// For each key, written `object.shape(sphere).radius` or `goal.pose`, the first value that a file gives it,
/// as TOML.
pub type Examples = BTreeMap<String, String>;

/// The examples in these files.
pub fn of<'a>(files: impl IntoIterator<Item = &'a str>) -> Examples {
    let mut examples = Examples::new();
    for file in files {
        let table: toml::Table = toml::from_str(file).expect("the files are read by tests: they are TOML");
        gather(&toml::Value::Table(table), "", &mut examples);
    }
    examples
}

/// Longer values are no help in a table.
const LONGEST: usize = 60;

fn gather(value: &toml::Value, path: &str, examples: &mut Examples) {
    match value {
        toml::Value::Table(table) => {
            let kind = table.get("kind").and_then(toml::Value::as_str);
            let path = kind.map_or(path.to_owned(), |kind| format!("{path}({kind})"));
            for (key, value) in table {
                let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                note(value, &path, examples);
                gather(value, &path, examples);
            }
        }
        toml::Value::Array(items) => items.iter().for_each(|item| gather(item, path, examples)),
        _ => {}
    }
}

fn note(value: &toml::Value, path: &str, examples: &mut Examples) {
    let tables = value.as_array().is_some_and(|items| items.iter().any(toml::Value::is_table));
    let text = value.to_string();
    if !(value.is_table() || tables || text.chars().count() > LONGEST || text.contains('\n')) {
        examples.entry(path.to_owned()).or_insert(text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_value_of_each_key_is_kept() {
        let found = of([
            "[object.shape]\nkind = \"sphere\"\nradius = 0.03\n[[goal]]\nx = 1\n[[goal]]\nx = 2\ny = [1, \
                2]\n",
        ]);
        let pairs: Vec<(&str, &str)> =
            found.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
        assert_eq!(
            pairs,
            [
                ("goal.x", "1"),
                ("goal.y", "[1, 2]"),
                ("object.shape(sphere).kind", "\"sphere\""),
                ("object.shape(sphere).radius", "0.03")
            ]
        );
    }
}
